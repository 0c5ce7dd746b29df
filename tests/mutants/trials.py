"""Runs a test program until its first test fails, and tells which."""

import contextlib
import dataclasses
import os
import pathlib
import re
import resource
import signal
import subprocess
import tempfile
import time

SHARDS = 2
SEEDS = "60"  # of the thousand of an ordinary run
_OPTIONS = ("--gtest_fail_fast", "--gtest_color=no")
# A mutant may want all the memory there is, or print without end.
_MEMORY_MAX, _OUTPUT_MAX = 4 << 30, 256 << 20
# Starts itself for each guard, with an environment that must not tell those to leave tests out.
_STARTS_ITSELF = {"guards_tests": "Guard*"}

_FAILED = re.compile(r"^\[  FAILED  \] ([^\s,]+)", re.MULTILINE)
_BEGUN = re.compile(r"^\[ RUN      \] (\S+)", re.MULTILINE)


@dataclasses.dataclass(frozen=True)
class Failure:
    test: str
    how: str  # "failed", "crashed" or "time limit"


def _limits(seconds):
    """For a process that is about to begin; that of its time on a processor is for when nobody is left to stop it."""
    processor_seconds = 60 + 2 * int(seconds)

    def limit():
        for what, most in ((resource.RLIMIT_CORE, 0), (resource.RLIMIT_AS, _MEMORY_MAX),
                           (resource.RLIMIT_FSIZE, _OUTPUT_MAX), (resource.RLIMIT_CPU, processor_seconds)):
            resource.setrlimit(what, (most, most))

    return limit


class _Process:
    """One process of a test program, and what it prints."""

    def __init__(self, program, options, environment, folder, limit):
        self.output = tempfile.TemporaryFile(dir=folder)
        self.process = subprocess.Popen(
            [str(program), *_OPTIONS, *options], stdin=subprocess.DEVNULL, stdout=self.output, stderr=self.output,
            env={"AXISGATE_SEEDS": SEEDS, **os.environ, "TMPDIR": folder, **environment}, cwd=folder,
            preexec_fn=_limits(limit), start_new_session=True)

    def stop(self):
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait()
        self.output.close()

    def text(self):
        self.output.seek(0)
        return self.output.read().decode(errors="replace")

    def failure(self):
        """Of a process that has ended; None if all is well."""
        text = self.text()
        if failed := _FAILED.findall(text):
            # Its last line names the test; lines before may come from a process that the test started.
            return Failure(failed[-1], "failed")
        if self.process.returncode == 0 and "[  PASSED  ]" in text:
            return None
        return Failure(_last_begun(text), "crashed")


def _last_begun(text):
    begun = _BEGUN.findall(text)
    return begun[-1] if begun else "(before any test)"


def _shares(program, test):
    """Options and environment of each process that runs a part of the tests."""
    if test:
        return [([f"--gtest_filter={test}"], {})]
    pattern = _STARTS_ITSELF.get(pathlib.Path(program).name)
    if not pattern:
        return [([], {"GTEST_TOTAL_SHARDS": str(SHARDS), "GTEST_SHARD_INDEX": str(i)}) for i in range(SHARDS)]
    tests = _listed(program, pattern)
    parts = [tests[i::SHARDS] for i in range(SHARDS)] if len(tests) >= SHARDS else [[pattern]]
    return [([f"--gtest_filter={':'.join(part)}"], {}) for part in parts]


def _listed(program, pattern):
    """The names of a program's tests; none if a mutant cannot even tell them."""
    command = [str(program), "--gtest_list_tests", f"--gtest_filter={pattern}"]
    try:
        run = subprocess.run(command, capture_output=True, text=True, check=True, timeout=60,
                             preexec_fn=_limits(60))
    except subprocess.SubprocessError:
        return []
    return names_in(run.stdout)


def names_in(listing):
    """The full names in what --gtest_list_tests prints."""
    names, suite = [], ""
    for line in listing.splitlines():
        word = line.split("#")[0].strip()
        if line.startswith(" "):
            names.append(suite + word)
        elif word.endswith("."):
            suite = word
    return names


def _watch(processes, limit):
    """The first failure of any; what still runs at the time limit has failed."""
    deadline = time.monotonic() + limit
    running = list(processes)
    while running:
        for one in [one for one in running if one.process.poll() is not None]:
            running.remove(one)
            if failure := one.failure():
                return failure
        if running and time.monotonic() > deadline:
            return Failure(_last_begun(running[0].text()), "time limit")
        time.sleep(0.02)
    return None


def run(program, limit, test=None):
    """The first failure of the program's tests, or of one of them alone; None if all pass."""
    with tempfile.TemporaryDirectory(prefix="mutant-") as folder, contextlib.ExitStack() as stack:
        processes = []
        for options, environment in _shares(program, test):
            processes.append(_Process(program, options, environment, folder, limit))
            stack.callback(processes[-1].stop)
        return _watch(processes, limit)


def judge(program, limit):
    """As run(), but what fails only once, on a busy machine, does not count."""
    failure = run(program, limit)
    if failure is None or failure.how == "time limit" or run(program, limit, failure.test):
        return failure
    return run(program, limit)
