#!/usr/bin/python3
"""Runs a program against a daemon with a simulated stage, as its user would.

usage: example.py COMMAND [ARGUMENT]...

Prints the output of the program, the seconds that it took, and the number of motions that the controller was sent.
Exits with the exit code of the program, or with 1 if it moved nothing.
"""

import os
import subprocess
import sys
import time

sys.dont_write_bytecode = True

from world import World  # noqa: E402

LIMIT_S = 120


def main(command):
    world = World("unix")
    try:
        begun = time.monotonic()
        code = subprocess.run(command, env=dict(os.environ, AXISGATE_TARGET=world.way_in()["target"]), check=False,
                              timeout=LIMIT_S).returncode
        took_s, starts = time.monotonic() - begun, world.starts()
    finally:
        world.end()
    print(f"{os.path.basename(command[0])}: exit code {code} after {took_s:.1f} s, {starts} starts of motion")
    return code or (0 if starts else 1)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1:]))
