"""The interop client on grpcio.

usage: client ROW TARGET | client --version
"""

import platform
import sys

import google.protobuf
import grpc

from calls import Calls, Failure
from rows import CHANNEL_OPTIONS, ROWS


def version():
    return f"grpcio {grpc.__version__} (protobuf {google.protobuf.__version__}, Python {platform.python_version()})"


def main(arguments):
    if arguments == ["--version"]:
        print(version())
        return 0
    if len(arguments) != 2 or arguments[0] not in ROWS:
        print(f"{__doc__.strip()}\nrows: {' '.join(ROWS)}", file=sys.stderr)
        return 2
    row, target = arguments
    calls = Calls(target, **CHANNEL_OPTIONS.get(row, {}))
    code = 0
    with calls.channel:
        try:
            ROWS[row](calls)
        except Failure as failure:
            print(f"{row}: {failure}", file=sys.stderr)
            code = 1
        print(f"calls {calls.count}", flush=True)
    return code


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
