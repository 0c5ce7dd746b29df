#!/usr/bin/env python3
"""Stage profiles: what a stage is by its file, and what the controller tells of it, on the simulated stage."""

import json
import pathlib
import subprocess
import tempfile
import time
import unittest

from programs import BIN, LIMIT_S, ROOT, Daemon

CONFIG = """
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "{socket}"

[[device]]
name = "stage"
connection = "simulated"
speed = 10

[[device.axis]]
number = 1
name = "x"
stage = "stages/slides.toml"
travel_maximum = "4mm"

[[device.axis]]
number = 2
name = "turn"
stage = "stages/turns.toml"

[[device.axis]]
number = 3
name = "z"
stage = "stages/other.toml"
"""

# The simulated pulse is 10 nm, or a hundred-thousandth of a degree, at 200 divisions.
STAGES = {
    "slides": 'name = "Slider"\nkind = "linear"\npulse = "10nm"\nunit = "mm"\ntravel_minimum = "-5mm"\n'
              'travel_maximum = "5mm"\nmaximum_speed = "5mm/s"\n',
    "turns": 'name = "Turner"\nkind = "rotary"\npulse = "0.00001deg"\nmodulo = "5deg"\n',
    "other": 'name = "Other"\nkind = "linear"\npulse = "20nm"\n',
}


class Stages(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-stage-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "stages").mkdir()
        for name, text in STAGES.items():
            self.write(name, text)

    def write(self, name, text):
        (self.folder / "stages" / f"{name}.toml").write_text(text, encoding="utf-8")

    def serve(self):
        self.daemon = Daemon(self.folder, CONFIG)
        self.addCleanup(self.daemon.stop)

    def ok(self, *arguments):
        answer = self.daemon.run(*arguments)
        self.assertEqual((answer.returncode, answer.stderr), (0, ""), arguments)
        return answer.stdout

    def refused(self, reason, *arguments):
        answer = self.daemon.run(*arguments)
        self.assertRegex(answer.stderr, rf"\Aaxisctl: {reason}: [^\n]+\n\Z", arguments)
        self.assertEqual(answer.returncode, 3, answer.stderr)
        return answer.stderr

    def axis(self, number):
        return next(axis for axis in map(json.loads, self.ok("--json", "position").splitlines())
                    if axis["number"] == number)

    def divide(self, number, divisions, fits):
        """And waits until the gateway has asked what a pulse is now."""
        self.ok("divisions", str(number), divisions)
        deadline = time.monotonic() + LIMIT_S
        while (self.axis(number)["stage_problem"] == "") != fits:
            self.assertLess(time.monotonic(), deadline, "the pulse was not asked for")
            time.sleep(0.02)  # between two looks; the deadline above decides

    def test_the_stage_that_is_there_moves_within_its_stroke(self):
        self.serve()
        self.assertRegex(self.ok("move", "x=-5"), r"done: axis x at -5 mm")
        self.assertIn("beyond its travel minimum of -5mm", self.refused("OUTSIDE_TRAVEL", "move", "x=-5.00001mm"))
        self.assertIn("beyond its travel maximum of 4mm", self.refused("OUTSIDE_TRAVEL", "move", "x=4.00001mm"))
        self.assertIn("5mm/s at most", self.refused("TOO_FAST", "move", "x=0", "--speed", "6mm/s"))
        self.assertRegex(self.ok("status"), r"(?m)^axis 1  x  -5 mm .* stage Slider$")
        self.assertEqual(self.axis(1)["position_in_turn"], "")

    def test_another_stage_is_not_moved(self):
        self.serve()
        refusal = self.refused("IDENTITY_MISMATCH", "move", "z=1um")
        self.assertIn("a pulse of axis 3 (z) is 10 nm by the controller and 20 nm by the profile of its stage, "
                      "Other: another stage is plugged in", refusal)
        self.assertIn("axisctl divisions", refusal)
        for arguments in (["move", "x=0", "z=1um", "--relative"], ["home", "z"], ["home"], ["jog", "z=+"],
                          ["exec", "M:3+P100", "G:3"], ["speed", "z", "--maximum", "1mm"]):
            self.refused("IDENTITY_MISMATCH", *arguments)
        self.assertIn("\nWRONG STAGE: a pulse of axis 3 (z) is 10 nm by the controller", self.ok("status"))
        self.assertIn("20 nm by the profile", self.axis(3)["stage_problem"])
        self.assertEqual(self.axis(1)["stage_problem"], "")
        self.assertEqual(self.ok("exec", "?:P3"), "10\n")
        self.ok("stop")
        self.ok("move", "x=1")

    def test_divisions_decide_at_any_time(self):
        self.serve()
        self.divide(3, "100", fits=True)
        self.ok("move", "z=1um")
        self.assertNotIn("WRONG STAGE", self.ok("status"))
        self.divide(1, "100", fits=False)
        self.assertIn("is 20 nm by the controller and 10 nm by the profile of its stage, Slider",
                      self.refused("IDENTITY_MISMATCH", "move", "x=1"))
        self.divide(1, "200", fits=True)
        self.ok("move", "x=1")

    def test_a_turn_is_shown_and_nothing_is_wrapped(self):
        self.serve()
        self.assertRegex(self.ok("move", "turn=12.5deg"), r"done: axis turn at 12\.5 deg\n\Z")
        self.assertIn("axis turn  12.5 deg (2.5 deg in the turn)\n", self.ok("position"))
        turn = self.axis(2)
        self.assertEqual((turn["position"], turn["position_in_turn"]), ("12.5", "2.5"))
        self.assertEqual(turn["position_pulses"], "1250000")
        self.ok("move", "turn=-0.5")
        self.assertIn("axis turn  -0.5 deg (4.5 deg in the turn)\n", self.ok("position"))
        self.ok("move", "turn=2")
        self.assertIn("axis turn  2 deg\n", self.ok("position"))
        self.assertRegex(self.refused("NOT_REPRESENTABLE", "move", "turn=0.000015deg"),
                         r"the nearest are 0\.00001deg and 0\.00002deg")
        self.assertRegex(self.refused("NOT_REPRESENTABLE", "speed", "turn", "--maximum", "0.000015deg"),
                         r"the nearest are 0\.00001deg/s and 0\.00002deg/s")

    def test_the_support_report_holds_the_profile(self):
        self.serve()
        report = self.folder / "report"
        self.ok("support", "--output", str(report))
        self.assertIn('[device.axis.stage]\nname = "Turner"\nkind = "rotary"\npulse = "0.00001deg"\nmodulo = "5deg"\n',
                      report.read_text(encoding="utf-8"))

    def test_a_wrong_profile_keeps_the_daemon_from_starting(self):
        self.write("turns", 'name = "Turner"\nkind = "rotary"\npulse = "1um"\n')
        config = self.folder / "axisgate.toml"
        config.write_text(CONFIG.format(socket=self.folder / "socket"), encoding="utf-8")
        check = subprocess.run([BIN / "axisgated", "--check-config", "--config", config], capture_output=True, text=True,
                               timeout=LIMIT_S, check=False)
        self.assertEqual(check.returncode, 2)
        self.assertEqual(check.stderr, f"{self.folder}/stages/turns.toml:3: pulse: is in um, and the stage turns; use the displacement "
                                       "of one pulse as a text in quotes, \"0.0025deg\"\n")

    def test_the_example_of_the_configuration_names_a_profile_that_is_there(self):
        example = (ROOT / "deploy" / "axisgate.toml").read_text(encoding="utf-8")
        named = [line.split('"')[1] for line in example.splitlines() if line.startswith('# stage = "')]
        self.assertEqual(len(named), 1)
        self.assertTrue((ROOT / "deploy" / named[0]).is_file())


if __name__ == "__main__":
    unittest.main(verbosity=2)
