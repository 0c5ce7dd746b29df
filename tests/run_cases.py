#!/usr/bin/env python3
"""Runs every GoogleTest program of a build, in parts spread over the cores, and counts cases.

usage: tests/run_cases.py BUILD [--filter FILTER] [PROGRAM ...]

Prints what a part said only if it failed, the seconds of each program, and at the end "N passed, M failed". A part that
dies counts as one failure more than the cases that it was running.
"""

import argparse
import concurrent.futures
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

# Parts of a program: many, where cases take long, so that the last one is not waited for alone.
PARTS = {"simulation": 24, "guards": 24, "integration": 12, "refusals": 4, "interleavings": 6, "unit": 6, "stress": 2, "rml1": 6}
ARGUMENTS = {"guards": ["--gtest_filter=Guard*"]}
PART_SECONDS_MAX = 1200


class Part:
    """One process: some of the cases of one program."""

    def __init__(self, program, index, count, case_filter):
        self.program, self.index, self.count, self.filter = program, index, count, case_filter
        self.name = program.name.removesuffix("_tests")
        self.seconds, self.passed, self.failed, self.skipped, self.output = 0.0, 0, 0, 0, ""

    def run(self):
        begun = time.monotonic()
        with tempfile.TemporaryDirectory(prefix="axisgate-cases-") as folder:
            report = pathlib.Path(folder, "report.json")
            self._run(report)
            self._count(report)
        self.seconds = time.monotonic() - begun
        return self

    def _run(self, report):
        # GoogleTest's own variables would reach the processes that a test starts; options do not.
        environment = dict(os.environ)
        if self.count > 1:
            environment |= {"GTEST_TOTAL_SHARDS": str(self.count), "GTEST_SHARD_INDEX": str(self.index)}
        arguments = [f"--gtest_filter={self.filter}"] if self.filter else ARGUMENTS.get(self.name, [])
        command = [str(self.program), "--gtest_color=no", "--gtest_brief=1", f"--gtest_output=json:{report}", *arguments]
        try:
            ended = subprocess.run(command, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, timeout=PART_SECONDS_MAX)
            self.code, output = ended.returncode, ended.stdout
        except subprocess.TimeoutExpired as error:
            self.code, output = -1, (error.stdout or b"") + b"\nrun_cases: its time has run out\n"
        self.output = output.decode(errors="replace")

    def _count(self, report):
        try:
            cases = [case for suite in json.loads(report.read_text())["testsuites"] for case in suite["testsuite"]]
        except (OSError, ValueError, KeyError):
            cases = []
        ran = [case for case in cases if case["status"] == "RUN" and case["result"] == "COMPLETED"]
        self.failed = sum(1 for case in ran if "failures" in case)
        self.skipped = sum(1 for case in cases if case["result"] == "SKIPPED")
        self.passed = len(ran) - self.failed
        if self.code != 0 and self.failed == 0:
            self.failed = 1


def parts_of(build, names, case_filter):
    programs = sorted(pathlib.Path(build, "bin").glob("*_tests"))
    if names:
        programs = [program for program in programs if program.name.removesuffix("_tests") in names]
    parts = []
    for program in programs:
        count = PARTS.get(program.name.removesuffix("_tests"), 1)
        parts += [Part(program, index, count, case_filter) for index in range(count)]
    # The long ones first.
    return sorted(parts, key=lambda part: -part.count)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build")
    parser.add_argument("programs", nargs="*", metavar="PROGRAM", help="unit, simulation, ...; without one, all")
    parser.add_argument("--filter", help="GoogleTest's filter, instead of each program's own")
    arguments = parser.parse_args()
    parts = parts_of(arguments.build, arguments.programs, arguments.filter)
    seconds, passed, failed, skipped = {}, 0, 0, 0
    # The cases of integration mostly wait for the programs that they have started.
    with concurrent.futures.ThreadPoolExecutor(max_workers=os.cpu_count() + 1) as pool:
        for part in concurrent.futures.as_completed([pool.submit(part.run) for part in parts]):
            done = part.result()
            seconds[done.name] = seconds.get(done.name, 0) + done.seconds
            passed, failed, skipped = passed + done.passed, failed + done.failed, skipped + done.skipped
            if done.failed:
                print(f"== {done.name}, part {done.index} of {done.count}, ended with {done.code}\n{done.output}",
                      flush=True)
    for name, took in sorted(seconds.items(), key=lambda item: -item[1]):
        print(f"{name}: {took:.0f} s")
    if skipped:
        print(f"{skipped} skipped")
    print(f"{passed} passed, {failed} failed")
    return 0 if passed and not failed else 1


if __name__ == "__main__":
    sys.exit(main())
