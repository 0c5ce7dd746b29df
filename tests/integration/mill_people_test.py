#!/usr/bin/env python3
"""Two people, three jobs, one mill behind a pseudo-terminal. Bert stands at the mill; anna is elsewhere on the network.
AXISGATE_TRANSCRIPT=1 prints what they type and read. With AXISGATE_EXPIRE=1 a confirmation expires, too, which takes a minute."""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time
import unittest

from mill_pty import CONFIG, PtyMill, profile_text
from programs import BIN, LIMIT_S, Daemon, Lines

TRANSCRIPT, EXPIRE = (os.environ.get(name) == "1" for name in ("AXISGATE_TRANSCRIPT", "AXISGATE_EXPIRE"))

LONG = "^IN;!MC0;!PZ-50,200;" + "PU4000,0;PU0,0;" * 2000 + "H;\n"
SMALL = "^IN;!PZ-50,200;PU100,100;PU;H;\n"


class TwoPeople(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-workshop-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        settings = 'tools = ["T1", "T2"]\nstation = ["unix"]\nconfirmation_minutes = 1\n'
        self.mill = PtyMill(self.folder, "mill", profile_text(), "none", settings=settings)
        self.addCleanup(self.mill.end)
        access = '[access]\nlocal = "admin"\n\n[[device]]'
        self.daemon = Daemon(folder.name, CONFIG.replace("[[device]]", access, 1) + self.mill.table)
        self.addCleanup(self.daemon.stop)
        self.token = self.daemon.run("token", "create", "anna").stdout.strip()
        for name, job in (("lid", LONG), ("outline", SMALL), ("holes", SMALL), ("base", LONG)):
            (self.folder / f"{name}.rml").write_text(job, encoding="ascii")

    def env(self, who):
        return dict(os.environ, AXISGATE_TOKEN=self.token) if who == "anna" else dict(os.environ)

    def command(self, who, *words):
        target = self.daemon.address() if who == "anna" else self.daemon.socket
        return [BIN / "axisctl", "--target", target, *words]

    def show(self, text):
        if TRANSCRIPT:
            print(text, file=sys.stderr)

    def type(self, who, line):
        """The exit code, and all that was said."""
        self.show(f"{who}$ axisctl {line}")
        done = subprocess.run(self.command(who, *line.split()), cwd=self.folder, env=self.env(who), capture_output=True,
                              text=True, timeout=LIMIT_S, check=False)
        said = done.stdout + done.stderr
        self.show("".join(f"    {one}\n" for one in said.splitlines()).rstrip())
        return done.returncode, said

    def well(self, who, line, pattern=""):
        code, said = self.type(who, line)
        self.assertEqual(code, 0, said)
        if pattern:
            self.assertRegex(said, pattern)

    def refused(self, who, line, pattern):
        code, said = self.type(who, line)
        self.assertEqual(code, 3, said)
        self.assertRegex(said, pattern)

    def until(self, pattern, limit_s=LIMIT_S):
        deadline = time.monotonic() + limit_s
        while True:
            said = subprocess.run(self.command("bert", "mill", "queue"), capture_output=True, text=True, timeout=LIMIT_S,
                                  check=False).stdout
            if re.search(pattern, said):
                return
            self.assertLess(time.monotonic(), deadline, said)
            time.sleep(0.05)  # between two looks; the deadline above decides

    def test_an_afternoon(self):
        self.until("line open")
        self.well("anna", "mill send lid.rml", "job 1 .* QUEUED")
        self.well("bert", "mill send outline.rml holes.rml --tool T1,T2 --title plate", "job 2 .* QUEUED")
        self.well("anna", "mill send base.rml", "job 3 .* QUEUED")
        self.only_who_stands_there_confirms()
        self.a_pause_and_an_abort()
        self.a_tool_change()
        self.a_take_over()
        self.well("bert", "history", "job 2 is DONE")

    def only_who_stands_there_confirms(self):
        self.refused("anna", "mill start 1", "NOT_CONFIRMED: job 1 .* is not confirmed")
        self.refused("anna", "mill confirm 1 --yes", "NOT_ALLOWED: token anna is not at the station of mill")
        self.refused("bert", "mill confirm 2 --yes", "WRONG_JOB_STATE: job 1 .* is before job 2")
        self.well("bert", "mill confirm 1 --yes", "job 1 .* is confirmed by unix")
        self.refused("bert", "mill start 2", "NOT_CONFIRMED: job 2 .* is not confirmed")
        self.well("bert", "mill jog x=1", "the step, unchecked")
        self.refused("anna", "mill start 1", "NOT_CONFIRMED: job 1 .* is no longer confirmed at the mill, since ")
        if EXPIRE:
            self.well("bert", "mill confirm 1 --yes")
            self.show("    (a minute later)")
            self.until(r"(?m)^1 .* QUEUED ", 60 + LIMIT_S)  # `confirmation_minutes` counts real time
            self.refused("anna", "mill start 1", "NOT_CONFIRMED: job 1 .* is no longer confirmed at the mill, since ")

    def a_pause_and_an_abort(self):
        self.well("bert", "mill confirm 1 --yes")
        deadline = time.monotonic() + LIMIT_S
        while "AXIS_BUSY: the mill may still do what it was sent by hand" in (said := self.type("anna", "mill start 1")[1]):
            self.assertLess(time.monotonic(), deadline)
        self.assertRegex(said, r"job 1 .* RUNNING; .* after an abort at most 64 bytes, up to .* s and \d+ mm, run on")
        self.refused("bert", "mill confirm 2 --yes", "WRONG_JOB_STATE: job 1 runs")
        self.refused("bert", "mill jog z=1", "WRONG_JOB_STATE: job 1 runs")
        self.well("bert", "mill pause", "job 1 is paused: .* still run.*the cutter keeps turning in the cut")
        self.well("anna", "mill resume", "job 1 is resumed")
        self.well("bert", "mill abort",
                  r"the abort was sent: at most 64 bytes of job 1, up to .* s and \d+ mm, may run on.*look at the mill")
        self.until("no job runs")

    def a_tool_change(self):
        self.well("bert", "mill confirm 2 --yes", "tool +T1")
        self.well("bert", "mill start 2 --follow", "TOOL_CHANGE")
        self.refused("bert", "mill start 2", "NOT_CONFIRMED: job 2 .* is not confirmed")
        self.refused("bert", "mill confirm 3 --yes", "WRONG_JOB_STATE: job 2 .* is not finished: its next tool is T2")
        self.well("bert", "mill confirm 2 --yes", "tool +T2")
        self.well("bert", "mill start 2 --follow", "FED")
        self.refused("bert", "mill confirm 3 --yes", "WRONG_JOB_STATE: job 2 .* is FED")
        self.well("bert", "mill done 2", "job 2 is DONE")

    def a_take_over(self):
        self.well("bert", "mill confirm 3 --yes")
        self.refused("anna", "mill start 3", "STOPPED_BY: unix .* stopped")
        self.well("anna", "--device mill rearm", "released: the stop")
        self.show("anna$ axisctl --device mill lease run -- axisctl mill start 3 --follow")
        words = ["env", f"AXISGATE_TOKEN={self.token}", *self.command("anna", "--device", "mill", "lease", "run", "--")]
        held = Lines(words + self.command("anna", "--device", "mill", "mill", "start", "3", "--follow"))
        self.addCleanup(held.kill)
        self.until("SENDING")
        self.refused("bert", "mill cancel 3", "WRONG_JOB_STATE: job 3 .* is RUNNING")
        self.well("bert", "--device mill lease run --take-over -- true")
        self.until("no job runs")
        held.end()
        self.show("".join(f"    {one}\n" for one in held.errors.splitlines()).rstrip())
        self.assertRegex(held.errors, "ABORTED")


if __name__ == "__main__":
    unittest.main()
