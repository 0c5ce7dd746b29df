"""Mills behind pseudo-terminals, each an rml1-sim of its own, and what their records say."""

import json
import re
import time

from mill_jobs_test import quick_profile
from programs import BIN, LIMIT_S, Lines
from rml1_sim_test import Person

CONFIG = """
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "{socket}"

[[device]]
name = "stage"
connection = "simulated"
"""

# Flow control as rml1-sim calls it, and as the configuration does.
FLOWS = {"none": "none", "xon": "xonxoff"}


def profile_text(**changes):
    """That of mill_jobs_test.py, with other values."""
    text = quick_profile()
    for key, value in changes.items():
        text, count = re.subn(rf"(?m)^{key} = \S+", f"{key} = {value}", text)
        if count != 1:
            raise AssertionError(f"the profile has {key} {count} times")
    return text


class PtyMill:
    """`arguments` go to rml1-sim, `settings` are lines of the device's table."""

    def __init__(self, folder, name, profile, flow, *arguments, settings=""):
        self.name = name
        self.profile = folder / f"{name}.toml"
        self.profile.write_text(profile, encoding="utf-8")
        self.tty, self.control = folder / f"{name}.tty", folder / f"{name}.control"
        self._record = open(folder / f"{name}.record", "w+", encoding="ascii")
        self._unread, self.entries = "", []
        self._program = Lines([BIN / "rml1-sim", "--pty", self.tty, "--profile", self.profile, "--flow", flow, "--record",
                               self._record.name, "--control", self.control, *map(str, arguments)])
        self._program.until("simulator on")
        self.person = Person(self.control)
        self.table = f"""
[[device]]
name = "{name}"
kind = "rml1"
profile = "{self.profile}"
connection = "serial"
path = "{self.tty}"
flow_control = "{FLOWS[flow]}"
{settings}
"""

    def end(self):
        self.person.close()
        self._program.kill()
        self._record.close()

    def say(self, command):
        reply = self.person.say(command)
        if not reply.startswith("ok"):
            raise AssertionError(f"{command}: {reply}")

    def read(self):
        """All lines of the record so far."""
        *lines, self._unread = (self._unread + self._record.read()).split("\n")
        self.entries += map(json.loads, lines)
        return self.entries

    def await_true(self, condition, what, limit_s=LIMIT_S):
        """`condition` gets the record."""
        deadline = time.monotonic() + limit_s
        while not condition(self.read()):
            if time.monotonic() > deadline:
                raise AssertionError(f"{what}; {self.person.state()}; the record ends with {self.entries[-5:]}")
            time.sleep(0.01)  # between two looks; the deadline above decides

    def began_at(self):
        """time.time() at 0 of the record, at the earliest. Presses VIEW twice; only with --speed 1."""
        now = time.time()
        self.say("view")
        self.await_true(lambda entries: any("panel" in entry for entry in entries), "VIEW is not recorded")
        self.say("view")
        return now - next(entry["t"] for entry in self.entries if "panel" in entry)


def commands(entries):
    return [entry for entry in entries if "command" in entry]


def send_accepting(run, *words, stdin=""):
    """What `mill send` prints; the warnings for which it refuses the job are accepted, as a person would."""
    answer = run("mill", "send", *words, stdin=stdin)
    wanted = re.search(r"--accept ([a-z,-]+)", answer.stderr)
    if answer.returncode != 0 and wanted:
        answer = run("mill", "send", *words, "--accept", wanted[1], stdin=stdin)
    if answer.returncode != 0:
        raise AssertionError(f"mill send {' '.join(words)}: {answer.stderr}")
    return answer.stdout


class Gateway:
    """What a person does with one mill of a daemon."""

    def __init__(self, daemon, mill):
        self._daemon = daemon
        self.mill = mill

    def run(self, *words, stdin=""):
        return self._daemon.run("--device", self.mill.name, *words, stdin=stdin)

    def axisctl(self, *words, stdin=""):
        answer = self.run(*words, stdin=stdin)
        if answer.returncode != 0:
            raise AssertionError(f"axisctl {' '.join(words)}: {answer.stdout}{answer.stderr}")
        return answer.stdout

    def start(self, job, *options):
        """The number of the job, whose warnings are accepted."""
        sent = send_accepting(self.run, "-", "--title", "job", *options, stdin=job)
        self.axisctl("mill", "confirm", "--yes", "--start")
        return re.match(r"job (\d+) ", sent)[1]

    def abort(self):
        """The answer."""
        return json.loads(self.axisctl("--json", "mill", "abort"))
