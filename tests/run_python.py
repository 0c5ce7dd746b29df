#!/usr/bin/env python3
"""Runs the unittest files of a folder, each in a process of its own, several at once, and counts cases.

usage: AXISGATE_BIN=BUILD/bin tests/run_python.py FOLDER [FILE ...]

Prints what a file said only if it failed, the seconds of the longest files, and at the end "N passed, M failed".
"""

import concurrent.futures
import os
import pathlib
import re
import subprocess
import sys
import time

# They mostly wait for what they have started.
AT_ONCE = os.cpu_count() + 1
FILE_SECONDS_MAX = 900
SHOWN = 5
# These judge times as a person would notice them: nothing else runs meanwhile.
ALONE = {"paced_path_test.py", "attack_test.py"}


def number(text, kind):
    match = re.search(rf"\b{kind}=(\d+)", text)
    return int(match[1]) if match else 0


def run(path):
    """(path, seconds, passed, failed, output) of one file."""
    begun = time.monotonic()
    environment = dict(os.environ, PYTHONDONTWRITEBYTECODE="1")
    try:
        ended = subprocess.run([sys.executable, "-m", "unittest", "-v", path.name], cwd=path.parent, env=environment,
                               stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                               errors="replace", timeout=FILE_SECONDS_MAX)
        code, output = ended.returncode, ended.stdout
    except subprocess.TimeoutExpired as error:
        code, output = -1, f"{error.stdout or ''}\nrun_python: its time has run out\n"
    seconds = time.monotonic() - begun
    ran = re.search(r"^Ran (\d+) tests? in ", output, re.MULTILINE)
    last = re.findall(r"^(?:OK|FAILED)(?: \(.*\))?$", output, re.MULTILINE)[-1:] or [""]
    failed = sum(number(last[0], kind) for kind in ("failures", "errors", "unexpected successes"))
    count = int(ran[1]) if ran else 0
    # A file that cannot be loaded, or in which nothing ran, has failed, too.
    if (code != 0 and failed == 0) or count == 0:
        failed = max(failed, 1)
    return path, seconds, max(0, count - failed - number(last[0], "skipped")), failed, output


def main(arguments):
    if not arguments:
        print(__doc__.strip(), file=sys.stderr)
        return 2
    folder = pathlib.Path(arguments[0]).resolve()
    files = [folder / name for name in arguments[1:]] or sorted(folder.glob("*_test.py"))
    results = []
    with concurrent.futures.ThreadPoolExecutor(max_workers=AT_ONCE) as pool:
        together = [pool.submit(run, path) for path in files if path.name not in ALONE]
        for done in concurrent.futures.as_completed(together):
            results.append(done.result())
            show(results[-1])
    for path in files:
        if path.name in ALONE:
            results.append(run(path))
            show(results[-1])
    for path, seconds, *_ in sorted(results, key=lambda result: -result[1])[:SHOWN]:
        print(f"{path.name}: {seconds:.0f} s")
    passed, failed = sum(result[2] for result in results), sum(result[3] for result in results)
    print(f"{passed} passed, {failed} failed")
    return 0 if passed and not failed else 1


def show(result):
    path, _, _, failed, output = result
    if failed:
        print(f"== {path.name}\n{output}", flush=True)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
