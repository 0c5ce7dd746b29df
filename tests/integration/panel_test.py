#!/usr/bin/env python3
"""What somebody does at the stage during the night, and what the night's summary, the status and the metrics say of it."""

import json
import os
import re
import tempfile
import unittest

from programs import BIN, Daemon, Lines
from sim_control_test import Person

CONFIG = """
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "{socket}"

[[device]]
name = "stage"
connection = "serial"
path = "TTY"
idle_poll_ms = 200
"""
CLOCK = r"(?:\d\d-\d\d )?\d\d:\d\d"  # after 18:00 the night has two dates
DATE = r"\d{4}-\d\d-\d\d \d\d:\d\d:\d\d[+-]\d\d:\d\d"
BETWEEN = rf"(between {DATE} and {DATE}|at {DATE})"


class Panel(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-panel-")
        self.addCleanup(folder.cleanup)
        tty, control = os.path.join(folder.name, "tty"), os.path.join(folder.name, "control")
        simulator = Lines([BIN / "shrc203-sim", "--pty", tty, "--control", control])
        self.addCleanup(simulator.kill)
        simulator.until("simulator on")
        self.person = Person(control)
        self.addCleanup(self.person.close)
        self.config = CONFIG.replace("TTY", tty)
        self.daemon = Daemon(folder.name, self.config)
        self.addCleanup(lambda: self.daemon.stop())
        self.watch = self.daemon.start("watch", "--from", "0")
        self.addCleanup(self.watch.kill)

    def run_well(self, *words):
        done = self.daemon.run(*words)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout

    def do(self, command, *events):
        """Does something at the stage, and awaits what is told of it, in any order."""
        self.assertEqual(self.person.say(command), "ok")
        missing = set(events)
        while missing:
            line = self.watch.next()
            missing -= {event for event in missing
                        if re.search(rf" stage {event}, (between \S+Z and \S+Z|at \S+Z)$", line)}

    def test_a_night_at_the_panel(self):
        self.assertRegex(self.run_well("status"), r"(?m)^axis 2 .*  status normal  speed ")
        self.do("emergency", "axes 1, 2 and 3: emergency stop", "axes 1, 2 and 3: motor off")
        status = self.run_well("status")
        self.assertRegex(status, r"(?m)^axis 2 .*  excited no .*  status emergency stop  speed ")
        self.assertNotRegex(status, "0x")
        self.run_well("clear", "1")
        self.watch.until("axis 1: emergency stop ended, ")
        self.run_well("clear")
        self.watch.until("axes 2 and 3: emergency stop ended, ")
        for axis in (1, 2, 3):
            self.do(f"excitation {axis} on", f"axis {axis}: motor on")
        self.do("limit 1 cw on", "axis 1: CW limit sensor on")
        self.assertRegex(self.run_well("status"), r"(?m)^axis 1 .*  status .*CW limit sensor on  speed ")
        self.do("mode MANUAL", "controller in MANUAL mode")
        self.do("mode HOST", "controller in HOST mode again")

        night = self.run_well("history", "--night")
        for line in (rf"stage axes 1, 2 and 3: emergency stop at {CLOCK}, ended at {CLOCK}",
                     rf"stage axis 1: CW limit sensor on at {CLOCK}",
                     rf"stage controller in MANUAL mode at {CLOCK}, ended at {CLOCK}"):
            self.assertRegex(night, f"(?m)^{line}$")
        self.assertEqual(len(re.findall("emergency stop", night)), 1, night)

        history = self.run_well("history")
        for text in ("axes 1, 2 and 3: emergency stop", "axes 2 and 3: emergency stop ended", "axis 2: motor on",
                     "axis 1: CW limit sensor on", "controller in MANUAL mode", "controller in HOST mode again"):
            self.assertRegex(history, rf"(?m)^{DATE}  stage  {text}, {BETWEEN}$")

        entries = [json.loads(line) for line in self.run_well("--json", "history", "--text", "cw_limit").splitlines()]
        details = json.loads(entries[0]["details"])
        self.assertEqual(entries[0]["kind"], "HISTORY_KIND_CONDITION_CHANGED")
        self.assertEqual(details["axes"], [1])
        self.assertLess(details["before_us"], details["seen_us"])
        page = self.daemon.metrics_page()
        for condition, count in (("emergency_stop", 1), ("cw_limit", 1), ("motor_off", 1), ("mode", 1), ("format", 0)):
            self.assertIn(f'axisgate_conditions_total{{condition="{condition}",device="stage"}} {count}\n', page)

    def test_what_a_new_daemon_finds(self):
        self.daemon.stop()
        self.assertEqual(self.person.say("excitation 3 off"), "ok")
        self.daemon = Daemon(os.path.dirname(self.daemon.socket), self.config)
        watch = self.daemon.start("watch", "--from", "0")
        self.addCleanup(watch.kill)
        watch.until(r" stage axis 3: motor off, found at \S+Z, by the first reading$")


if __name__ == "__main__":
    unittest.main()
