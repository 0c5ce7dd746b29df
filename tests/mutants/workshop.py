"""A clone of the tree in which sources are mutated, built and tried."""

import contextlib
import fcntl
import os
import signal
import subprocess
import time

import trials
from drawing import CannotRun, git

# The fast ones first. A folder's tests are in the programs that link it.
_PROGRAMS = (
    ("device/rml1/", ("rml1_tests",)),
    ("device/jobs/", ("rml1_tests",)),
    ("server/access/", ("unit_tests", "simulation_tests", "guards_tests")),
    ("device/", ("unit_tests", "conformance_tests", "refusals_tests", "interleavings_tests", "simulation_tests",
                 "guards_tests")),
)
_BUILD_SECONDS_MAX = 3600
_UNMUTATED_SECONDS_MAX = 3600


def programs_of(path):
    return next(programs for folder, programs in _PROGRAMS if path.startswith(folder))


def _end(process):
    """Ends a build that still runs, compilers included, so that no half of an object stays."""
    if process.poll() is not None:
        return
    os.killpg(process.pid, signal.SIGTERM)
    with contextlib.suppress(subprocess.TimeoutExpired):
        process.wait(10)
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()


class Workshop:
    """`folder` holds the clone, the log of the last build, and a lock."""

    def __init__(self, root, commit, folder, limit=None):
        self.folder = folder
        self.source = folder / "source"
        self.bin = self.source / "build" / "bin"
        self.limit = limit
        self.seconds = {}  # that each program takes without a mutation
        folder.mkdir(parents=True, exist_ok=True)
        self._lock()
        if not (self.source / ".git").exists():
            git(folder, "clone", "--quiet", "--no-checkout", str(root), str(self.source))
        git(self.source, "fetch", "--quiet", str(root), "HEAD")
        # Takes back what an interrupted run left mutated, too.
        git(self.source, "checkout", "--quiet", "--force", "--detach", commit)

    def _lock(self):
        self.lock = (self.folder / "lock").open("w")
        try:
            fcntl.flock(self.lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            raise CannotRun(f"another run works in {self.folder}") from error

    def _run(self, *command):
        """Whether the command succeeds; the log tells what it printed."""
        # What was compiled in another clone serves this one.
        environment = {"CCACHE_BASEDIR": str(self.source), "CCACHE_NOHASHDIR": "1", **os.environ}
        with (self.folder / "build.log").open("w") as log:
            try:
                process = subprocess.Popen(command, cwd=self.source, stdin=subprocess.DEVNULL, stdout=log, stderr=log,
                                           env=environment, start_new_session=True)
            except FileNotFoundError as error:
                raise CannotRun(f"{command[0]} is not installed") from error
            try:
                return process.wait(_BUILD_SECONDS_MAX) == 0
            except subprocess.TimeoutExpired:
                return False
            finally:
                _end(process)

    def _build(self, program):
        return self._run("cmake", "--build", "--preset", "dev", "--target", program)

    def _require(self, well, what):
        if not well:
            log = (self.folder / "build.log").read_text(errors="replace")
            raise CannotRun(f"{what} without any mutation:\n{log[-4000:]}")

    def prepare(self, programs, say):
        """Builds the programs and runs them as they are, once: none may fail, and how long they take is a measure."""
        if not (self.source / "build" / "build.ninja").exists():
            self._require(self._run("cmake", "--preset", "dev"), "cmake --preset dev fails")
        for program in programs:
            if program in self.seconds:
                continue
            self._require(self._build(program), f"{program} cannot be built")
            begun = time.monotonic()
            failure = trials.judge(self.bin / program, _UNMUTATED_SECONDS_MAX)
            if failure:
                raise CannotRun(f"{program} fails without any mutation: {failure.test} ({failure.how})")
            self.seconds[program] = time.monotonic() - begun
            say(f"{program} passes without a mutation in {self.seconds[program]:.0f} s")

    def limit_of(self, program):
        """Enough for a mutant that is slower than what it was made of, and for a machine that is busy."""
        return self.limit or 30 + 4 * self.seconds[program]

    def attempt(self, mutation):
        """What became of the mutation, as it stands in the results."""
        file = self.source / mutation.path
        original = file.read_bytes()
        file.write_bytes(mutation.applied(original.decode()).encode())
        try:
            return self._tried(mutation)
        finally:
            file.write_bytes(original)  # anew, so that what was built of the mutation is older

    def _tried(self, mutation):
        for program in programs_of(mutation.path):
            if not self._build(program):
                return {"verdict": "not compiled"}
            failure = trials.judge(self.bin / program, self.limit_of(program))
            if failure:
                return {"verdict": "killed", "by": program, "test": failure.test, "how": failure.how}
        return {"verdict": "survived"}
