#!/usr/bin/env python3
"""The log of a daemon says who changed or moved what: with targets, values and lines as they were sent."""

import re
import tempfile
import unittest

from programs import Daemon

CONFIG = """
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "{socket}"

[[device]]
name = "stage"
connection = "simulated"
"""


class Audit(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-audit-")
        cls.addClassCleanup(folder.cleanup)
        cls.daemon = Daemon(folder.name, CONFIG)
        cls.addClassCleanup(cls.daemon.stop)

    def ask(self, *arguments):
        """What the log then says was requested, in order."""
        before = len(self.daemon.log())
        answer = self.daemon.run(*arguments)
        self.assertEqual((answer.returncode, answer.stderr), (0, ""), arguments)
        self.daemon.run("status")
        # Lines that do not warn are written within a second.
        self.daemon.wait_for_log(r"(?s).{%d}.*requests: " % before)
        return re.findall(r"(?m)info stage: unix \S+ requests: (.*)$", self.daemon.log()[before:])

    def test_moves(self):
        self.assertEqual(self.ask("move", "1=1.5mm", "2=200um"), ["move axis 1 to 1.5 mm, axis 2 to 200 um"])
        self.assertEqual(self.ask("move", "1=-20um", "--relative"), ["move axis 1 by -20 um"])
        self.assertEqual(self.ask("home"), ["home all axes"])

    def test_a_setting_has_the_lines_that_were_sent(self):
        self.assertEqual(self.ask("speed", "1", "--minimum", "10um", "--maximum", "2mm", "--acceleration", "50"),
                         ["change settings: DS:1F1000 | DF:1F200000 | DR:1 50"])
        self.assertEqual(self.ask("beep", "off"), ["change settings: BEEP:0"])
        self.assertNotIn("of no axis", self.daemon.log())

    def test_a_jog_has_its_direction_and_speed(self):
        self.assertEqual(self.ask("jog", "1=+", "--speed", "1mm/s", "--seconds", "1"), ["jog axis 1 plus at 1 mm/s"])

    def test_an_execute_has_its_lines(self):
        self.assertEqual(self.ask("exec", "?:P1", "?:P2"), ["execute: ?:P1 | ?:P2"])


if __name__ == "__main__":
    unittest.main(verbosity=2)
