#!/usr/bin/env python3
"""What a controller is set to, by axisctl, and what its simulator then says of it."""

import json
import re
import subprocess
import tempfile
import time
import unittest

from programs import BIN, LIMIT_S, Daemon, Lines

CONFIG = """
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "{socket}"

[[device]]
name = "stage"
connection = "simulated"

[[device.axis]]
number = 1
name = "x"
unit = "mm"
maximum_speed = "5mm/s"

[[device.axis]]
number = 2
name = "y"
unit = "um"
"""


class OnAStage(unittest.TestCase):
    """Every test gets a daemon of its own, whose simulator has just been switched on."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisctl-settings-")
        self.addCleanup(folder.cleanup)
        self.daemon = Daemon(folder.name, CONFIG)
        self.addCleanup(lambda: self.daemon.stop())

    def ok(self, *arguments):
        answer = self.daemon.run(*arguments)
        self.assertEqual((answer.returncode, answer.stderr), (0, ""), arguments)
        return answer.stdout

    def done(self, *arguments):
        self.assertEqual(self.ok(*arguments), "OK\n", arguments)

    def refused(self, code, reason, *arguments):
        answer = self.daemon.run(*arguments)
        self.assertRegex(answer.stderr, rf"\Aaxisctl: ({reason}): [^\n]+\n\Z", arguments)
        self.assertEqual(answer.returncode, code, answer.stderr)
        return answer

    def controller(self, question):
        return self.ok("exec", question).strip()

    def until(self, condition, what):
        deadline = time.monotonic() + LIMIT_S
        while not condition():
            self.assertLess(time.monotonic(), deadline, what)
            time.sleep(0.05)  # between two looks; the deadline above decides

    def until_controller_says(self, question, answer):
        self.until(lambda: self.daemon.run("exec", question).stdout.strip() == answer, f"{question} is not {answer}")

    def stranger(self, *arguments):
        """Over TCP, where nobody is known by name."""
        return [BIN / "axisctl", "--target", self.daemon.address(), *arguments]

    def refused_to_a_stranger(self, *arguments):
        answer = subprocess.run(self.stranger(*arguments), capture_output=True, text=True, timeout=LIMIT_S, check=False)
        self.assertRegex(answer.stderr, r"\Aaxisctl: NOT_ALLOWED: ", arguments)
        self.assertEqual(answer.returncode, 3)


class Shown(OnAStage):
    def test_everything_one_item_a_line(self):
        shown = self.ok("settings")
        for line in ("axis x  motor  on", "axis 3  loop  open",
                     "axis y  speed  minimum 1000 pulse/s, maximum 50000 pulse/s, acceleration 100 ms",
                     "axis x  divisions  200", "settling  0.0 s", "sleep  off", "display  on", "beep  on",
                     "outputs  none", "inputs  none", "trigger  none", "mode  HOST", "dialect  SHOT.FC"):
            self.assertRegex(shown, rf"(?m)^{line}$")
        for item in ("speed of the origin return", "name on the device", "scale resolution"):
            self.assertRegex(shown, rf"(?m)^axis x  {item}  [^?\n]+$")

    def test_as_json(self):
        settings = json.loads(self.ok("--json", "settings"))
        self.assertEqual([axis["axis"] for axis in settings["axes"]], ["1", "2", "3"])
        self.assertIs(settings["axes"][0]["excited"], True)
        self.assertIs(settings["sleeping"], False)
        self.assertEqual(settings["outputs"], {"on": []})
        self.assertEqual(json.loads(self.ok("--json", "outputs"))["outputs"], {"on": []})
        self.assertEqual(json.loads(self.ok("--json", "inputs"))["inputs"], {"on": []})
        self.assertEqual(json.loads(self.ok("--json", "speed", "x"))["axis"], "1")
        self.assertEqual(json.loads(self.ok("--json", "beep", "off")), {})

    def test_inputs(self):
        self.assertEqual(self.ok("inputs"), "none\n")


class OfAxes(OnAStage):
    def test_speeds(self):
        self.done("speed", "1", "--minimum", "10um", "--maximum", "2mm", "--acceleration", "50")
        self.assertEqual(self.controller("?:D").split(",")[0], "S1000F200000R50")
        self.assertEqual(self.ok("speed", "1"),
                         "axis x  minimum 1000 pulse/s, maximum 200000 pulse/s, acceleration 50 ms\n")

    def test_a_bare_speed_is_in_the_axis_own_unit_and_what_is_not_given_stays(self):
        self.done("speed", "y", "--maximum", "300")
        self.assertEqual(self.controller("?:D").split(","), ["S1000F50000R100", "S1000F30000R100", "S1000F50000R100"])

    def test_speeds_of_the_origin_return(self):
        before = self.controller("?:B").split(",")
        self.done("speed", "1,2", "--maximum", "0.4mm/s", "--origin-return")
        after = [re.sub(r"F\d+", "F40000", speeds) for speeds in before[:2]] + before[2:]
        self.assertEqual(self.controller("?:B").split(","), after)
        self.assertEqual(self.controller("?:D").split(",")[0], "S1000F50000R100")
        self.assertEqual(self.ok("speed", "1,2", "--origin-return").count("maximum 40000 pulse/s"), 2)

    def test_speeds_that_cannot_be(self):
        self.refused(3, "TOO_FAST", "speed", "x", "--maximum", "6mm/s")
        self.refused(3, "NOT_REPRESENTABLE", "speed", "x", "--maximum", "15nm")
        self.refused(3, "UNKNOWN_UNIT", "speed", "x", "--maximum", "1deg")
        self.refused(3, "OUT_OF_RANGE|INVALID_REQUEST", "speed", "x", "--minimum", "3mm", "--maximum", "2mm")
        self.refused(2, "UNKNOWN_UNIT", "speed", "x", "--maximum", "1inch")
        self.refused(2, "UNKNOWN_AXIS", "speed", "w", "--maximum", "1mm")
        self.refused(2, "INVALID_REQUEST", "speed", "x", "--acceleration", "0")
        self.assertEqual(self.controller("?:D").split(",")[0], "S1000F50000R100")

    def test_motors(self):
        self.done("motor", "y,3", "off")
        self.assertEqual(self.controller("?:C"), "1,0,0")
        self.refused(3, "NOT_EXCITED", "zero", "3")
        self.done("motor", "3", "on")
        self.assertEqual(self.controller("?:C"), "1,0,1")
        self.refused(2, "INVALID_REQUEST", "motor", "3", "blink")
        self.refused(2, "INVALID_REQUEST", "motor", "3")

    def test_loops(self):
        self.done("loop", "1,2", "closed")
        self.assertEqual(self.controller("?:F"), "0,0,1")
        self.done("loop", "1,2", "open")
        self.assertEqual(self.controller("?:F"), "1,1,1")

    def test_divisions_change_what_a_pulse_is(self):
        self.done("divisions", "3", "100")
        self.assertEqual(self.controller("?:S"), "200,200,100")
        self.refused(3, "NOT_REPRESENTABLE", "move", "3=10nm")
        self.ok("move", "3=20nm")
        self.refused(3, "OUT_OF_RANGE|INVALID_REQUEST", "divisions", "3", "7")
        self.refused(2, "INVALID_REQUEST", "divisions", "3", "many")
        self.refused(2, "UNKNOWN_AXIS", "divisions", "1,2", "100")

    def test_coordinates(self):
        self.ok("move", "x=0.1mm")
        epoch = self.frame_epoch()
        self.done("zero", "x")
        self.assertEqual(self.ok("position"), "axis x  0 mm\naxis y  0 um\naxis 3  0 um\n")
        self.assertGreater(self.frame_epoch(), epoch)
        self.done("unzero", "x")
        self.assertEqual(self.ok("position"), "axis x  0.1 mm\naxis y  0 um\naxis 3  0 um\n")
        self.done("preset", "1=0.5", "2=-20um")
        self.assertEqual(self.ok("position"), "axis x  0.5 mm\naxis y  -20 um\naxis 3  0 um\n")
        self.done("zero")
        self.assertEqual(self.ok("position"), "axis x  0 mm\naxis y  0 um\naxis 3  0 um\n")

    def frame_epoch(self):
        return int(json.loads(self.ok("--json", "status"))["frame_epoch"])

    def test_coordinates_that_cannot_be(self):
        self.refused(3, "NOT_REPRESENTABLE", "preset", "x=15nm")
        self.refused(3, "INVALID_REQUEST", "preset", "x=1mm", "1=2mm")
        self.refused(3, "UNKNOWN_UNIT", "preset", "x=1deg")
        self.refused(2, "UNKNOWN_UNIT", "preset", "x=1inch")
        self.refused(2, "INVALID_REQUEST", "preset", "x")
        self.refused(2, "UNKNOWN_AXIS", "zero", "w")
        self.assertEqual(self.ok("position"), "axis x  0 mm\naxis y  0 um\naxis 3  0 um\n")


class OfTheController(OnAStage):
    def test_settling(self):
        for seconds, told in (("0.1", "1"), ("25.50", "255"), ("255", "2550"), ("0", "0")):
            self.done("settle", seconds)
            self.assertEqual(self.controller("?:W"), told)
        for seconds in ("0.15", "255.1", "1e", "some", "99999999999999999999"):
            self.assertIn("axisctl settle 0.1", self.refused(2, "INVALID_REQUEST", "settle", seconds).stderr)

    def test_sleep_and_wake(self):
        self.done("sleep")
        self.assertEqual(self.controller("?:SLEEP"), "1")
        self.assertIn("sleep  on\n", self.ok("settings"))
        self.assertEqual(self.daemon.run("move", "x=0.1mm").returncode, 3)
        self.done("wake")
        self.assertEqual(self.controller("?:SLEEP"), "0")
        self.ok("move", "x=0.1mm")

    def test_panel(self):
        self.done("display", "off")
        self.assertEqual(self.controller("?:BO"), "0")
        self.done("beep", "off")
        self.assertEqual(self.controller("?:BEEP"), "0")
        self.done("beep", "on")
        self.assertEqual(self.controller("?:BEEP"), "1")

    def test_mode(self):
        self.refused(2, "INVALID_REQUEST", "mode", "fly")
        self.refused_to_a_stranger("mode", "MANUAL")
        self.done("mode", "HOST")
        self.done("mode", "manual")
        self.until(lambda: "the controller is in MANUAL mode" in self.ok("devices"), "the mode is not noticed")

    def test_dialect(self):
        self.refused_to_a_stranger("dialect", "HIT")
        self.done("dialect", "SHOT_FC")
        self.done("dialect", "HIT")
        self.until(lambda: "  UP" not in self.ok("devices"), "the dialect is not noticed")

    def test_reset(self):
        self.refused_to_a_stranger("reset")
        self.ok("move", "x=0.1mm")
        self.done("speed", "1", "--maximum", "1mm")
        self.done("reset")
        self.until_controller_says("?:D", "S1000F50000R100,S1000F50000R100,S1000F50000R100")
        self.until(lambda: self.daemon.run("position").stdout == "axis x  0 mm\naxis y  0 um\naxis 3  0 um\n", "not at 0")


class Signals(OnAStage):
    def test_outputs(self):
        self.assertEqual(self.ok("outputs"), "none\n")
        self.done("outputs", "on", "1", "3")
        self.assertEqual(self.controller("?:O"), "5")
        self.assertEqual(self.ok("outputs"), "OUT1 OUT3\n")
        self.done("outputs", "off", "1")
        self.assertEqual(self.controller("?:O"), "4")
        self.done("outputs", "on", "6,1")
        self.assertEqual(self.controller("?:O"), "37")
        self.assertIn("outputs OUT1 OUT3 OUT6", self.ok("status"))
        self.done("outputs", "none")
        self.assertEqual(self.controller("?:O"), "0")

    def test_outputs_that_are_none(self):
        for arguments in (["on"], ["off"], ["none", "1"], ["on", "7"], ["on", "0"], ["blink", "1"]):
            self.refused(2, "INVALID_REQUEST", "outputs", *arguments)
        self.assertEqual(self.controller("?:O"), "0")

    def test_trigger(self):
        for arguments, told, shown in (
                (["1000", "--axis", "x"], "0,1,1000", "every 1000 drive pulses of axis 1"),
                (["500", "--axis", "2", "--scale", "+"], "2,2,500", "every 500 scale pulses of axis 2 in direction +"),
                (["500", "--axis", "2", "--scale", "-"], "3,2,-500", "every 500 scale pulses of axis 2 in direction -"),
                (["0.2s"], "1,20", "every 0.20 s")):
            with self.subTest(arguments):
                self.done("trigger", "every", *arguments)
                self.assertEqual(self.controller("?:T"), told)
                self.assertIn(f"trigger  {shown}\n", self.ok("settings"))
        self.done("trigger", "fire")
        self.assertEqual(self.controller("?:T"), "1,20")
        self.done("trigger", "off")
        self.assertEqual(self.controller("?:T"), "NS")

    def test_triggers_that_are_none(self):
        for arguments in (["1000"], ["0.2s", "--axis", "1"], ["1", "--axis", "1"], ["30001", "--axis", "1"],
                          ["0.005s"], ["0s"], ["100.01s"], ["1mm", "--axis", "1"], ["1.5", "--axis", "1"],
                          ["1000", "--scale", "+"], ["s"]):
            self.refused(2, "INVALID_REQUEST", "trigger", "every", *arguments)
        self.refused(2, "UNKNOWN_AXIS", "trigger", "every", "1000", "--axis", "w")
        self.refused(2, "INVALID_REQUEST", "trigger")
        self.assertEqual(self.controller("?:T"), "NS")


class UnderALease(OnAStage):
    def script(self, *verbs):
        return " && ".join(f"{BIN}/axisctl --target {self.daemon.socket} {verb}" for verb in verbs)

    def hold(self, *arguments):
        """The stranger holds a lease, as long as the command sleeps."""
        holder = Lines(self.stranger("lease", "run", *arguments, "--", "sh", "-c", "echo held; exec sleep 60"))
        self.addCleanup(self.let_go, holder)
        holder.until("held")
        return holder

    def let_go(self, holder):
        holder.process.terminate()  # passed on to its command
        holder.end()

    def test_outputs_trigger_and_speeds_end_with_it(self):
        self.done("outputs", "on", "1")
        origin = self.controller("?:B")
        shown = self.ok("lease", "run", "--", "sh", "-c",
                        self.script("outputs on 2", "trigger every 500 --axis 2", "speed 1 --maximum 1mm",
                                    "speed 1 --maximum 1mm --origin-return", "exec '?:O' '?:T'"))
        self.assertEqual(shown, "OK\nOK\nOK\nOK\n3\n0,2,500\n")
        self.until_controller_says("?:O", "1")
        self.until_controller_says("?:T", "NS")
        self.until_controller_says("?:D", "S1000F50000R100,S1000F50000R100,S1000F50000R100")
        self.until_controller_says("?:B", origin)

    def test_everything_else_stays(self):
        self.ok("lease", "run", "--", "sh", "-c", self.script("beep off", "motor 3 off", "settle 0.2"))
        self.assertEqual(self.controller("?:BEEP"), "0")
        self.assertEqual(self.controller("?:C"), "1,1,0")
        self.assertEqual(self.controller("?:W"), "2")

    def test_another_holds_what_would_change(self):
        self.hold("--axes", "1")
        for arguments in (["speed", "1", "--maximum", "1mm"], ["motor", "1", "off"], ["loop", "1", "closed"],
                          ["divisions", "1", "100"], ["zero", "1"], ["preset", "1=1mm"], ["outputs", "on", "1"],
                          ["trigger", "every", "0.2s"], ["trigger", "fire"], ["sleep"], ["settle", "1"], ["reset"]):
            self.refused(3, "LEASE_HELD", *arguments)
        self.done("speed", "2", "--maximum", "1mm")
        self.ok("settings")

    def test_waiting_for_it(self):
        holder = self.hold("--axes", "1")
        waiting = self.daemon.start("motor", "1", "off", "--wait", "60")
        self.until(lambda: "waits" in self.ok("lease", "list"), "nobody waits")
        holder.process.terminate()  # passed on to its command
        waiting.until("OK")
        self.assertEqual(waiting.end(), 0)
        self.assertEqual(self.controller("?:C"), "0,1,1")


class InParts(OnAStage):
    """What is not named stays, whoever moves at speeds of his own meanwhile."""

    def test_a_running_motion_keeps_its_speeds_to_itself(self):
        before = self.controller("?:D1")
        self.ok("move", "1=2mm", "--speed", "1mm/s", "--no-wait")
        self.done("speed", "1", "--minimum", "20um")
        self.assertEqual(self.controller("?:D1"), re.sub(r"S\d+", "S2000", before))

    def test_one_right_after_another(self):
        self.done("speed", "2", "--maximum", "400um")
        self.done("speed", "2", "--acceleration", "91")
        self.done("speed", "2", "--maximum", "500um", "--origin-return")
        self.done("speed", "2", "--acceleration", "33", "--origin-return")
        self.assertRegex(self.controller("?:D2"), r"F40000R91\Z")
        self.assertRegex(self.controller("?:B2"), r"F50000R33\Z")

    def test_a_lower_maximum_takes_the_minimum_along(self):
        self.done("speed", "2", "--maximum", "5um")
        self.assertRegex(self.controller("?:D2"), r"\AS500F500R")

    def test_off_host_nothing_is_told_wrongly(self):
        self.done("outputs", "on", "1", "3")
        self.done("sim", "mode", "MANUAL")
        answer = self.daemon.run("settings")
        self.assertNotEqual(answer.returncode, 0, answer.stdout)


class AtTheDevice(OnAStage):
    """What a person does at the simulated device, and what becomes of it here."""

    def test_help_lists_what_he_can_do(self):
        told = self.ok("sim", "help")
        for command in ("mode", "emergency", "limit", "inputs", "unplug"):
            self.assertRegex(told, rf"(^|; ){command}\b")

    def test_inputs(self):
        self.done("sim", "inputs", "5")
        self.assertEqual(self.controller("I:"), "5")

    def test_a_motor_that_is_switched_off(self):
        self.done("sim", "excitation", "1", "off")
        refused = self.refused(3, "NOT_EXCITED", "exec", "R:1")
        self.assertIn("axisctl motor 1 on", refused.stderr)

    def test_the_emergency_button(self):
        self.done("sim", "emergency")
        self.refused(3, "EMERGENCY_STOPPED", "move", "1=1mm")
        self.ok("clear")
        self.done("motor", "1,2,3", "on")
        self.ok("move", "1=1mm")

    def test_what_is_no_command(self):
        refused = self.refused(3, "INVALID_REQUEST", "sim", "emergancy")
        self.assertIn("help", refused.stderr)
        self.refused(3, "INVALID_REQUEST", "sim", "inputs", "64")
        self.assertEqual(self.controller("I:"), "0")


if __name__ == "__main__":
    unittest.main(verbosity=2)
