#!/usr/bin/env python3
"""axisctl against a daemon with its built-in simulator, as a person uses it."""

import json
import os
import re
import subprocess
import tempfile
import unittest

from programs import BIN, LIMIT_S, Daemon

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
travel_minimum = "-9mm"
travel_maximum = "9mm"
maximum_speed = "5mm/s"

[[device.axis]]
number = 2
name = "y"
unit = "um"
"""

SECOND_DEVICE = """
[[device]]
name = "other"
connection = "simulated"
"""


class WithoutDaemon(unittest.TestCase):
    def run_axisctl(self, *arguments):
        return subprocess.run([BIN / "axisctl", *arguments], capture_output=True, text=True, errors="surrogateescape",
                              timeout=LIMIT_S, check=False)

    def test_help_lists_every_verb(self):
        answer = self.run_axisctl("help")
        self.assertEqual(answer.returncode, 0)
        for verb in ("devices status position home move path line arc scan jog stop estop clear exec watch commands "
                     "record replay support lease rearm whoami token").split():
            self.assertRegex(answer.stdout, rf"(?m)^  {verb} +\w")
        self.assertIn("Exit codes", answer.stdout)

    def test_no_daemon_says_how_to_start_one(self):
        for arguments in (["devices"], ["watch"], ["stop"], ["move", "1=1mm"]):
            with self.subTest(arguments):
                answer = self.run_axisctl("--target", "/nonexistent/axisgate.sock", *arguments)
                self.assertEqual(answer.returncode, 4)
                self.assertRegex(answer.stderr, r"\Aaxisctl: UNAVAILABLE: .*axisgated[^\n]*\n\Z")

    def test_socket_from_the_environment(self):
        environment = dict(os.environ, AXISGATE_SOCKET="/nonexistent/chosen.sock")
        answer = subprocess.run([BIN / "axisctl", "devices"], env=environment, capture_output=True, text=True,
                                timeout=LIMIT_S, check=False)
        self.assertIn("/nonexistent/chosen.sock", answer.stderr)

    def test_wrong_usage(self):
        for arguments in ([], ["fly"], ["move"], ["move", "1=1", "--fast"], ["help", "fly"]):
            with self.subTest(arguments):
                answer = self.run_axisctl(*arguments)
                self.assertEqual(answer.returncode, 2)
                self.assertRegex(answer.stderr, r"\Aaxisctl: [A-Z_]+: [^\n]+\n\Z")

    def test_bytes_that_are_not_utf8(self):
        """Refused before anything is sent: no daemon is there."""
        for option, arguments in [
            ("--device", ["--device", b"x\xb2", "position"]),
            ("--request-id", ["--request-id", b"\xb2", "move", "1=1mm"]),
            ("--target", ["--target", b"x\xb2.sock", "devices"]),
            ("NAME", ["save", b"lat\xb2in"]),
            ("NAME", ["token", "create", b"\xff"]),
            ("--purpose", ["lease", "run", "--purpose", b"\xc3", "--", "true"]),
            ("--text", ["history", "--text", b"a\x80"]),
            ("LINE", ["exec", "?:P1", b"?:P\xb2"]),
            ("AXES", ["home", b"x,\xb2"]),
            ("AXIS=AMOUNT", ["move", b"\xb2=1mm"]),
            ("--title", ["mill", "send", "a.rml", "--title", b"\xed\xa0\x80"]),
            ("TOPIC", ["help", b"\xb2"]),
        ]:
            with self.subTest(option, arguments=arguments):
                answer = self.run_axisctl(*arguments)
                self.assertEqual(answer.returncode, 2)
                self.assertRegex(answer.stderr, rf"\Aaxisctl: INVALID_REQUEST: {option} is not UTF-8: \S+ \([^\n]+\)\n\Z")

    def test_a_file_may_have_any_name(self):
        with tempfile.TemporaryDirectory() as folder:
            job = os.path.join(os.fsencode(folder), b"lat\xb2in.rml")
            with open(job, "w", encoding="ascii") as file:
                file.write("^IN;PU100,100;H;")
            answer = self.run_axisctl("mill", "check", job, "--profile", "mdx-20")
            self.assertEqual(answer.returncode, 0, answer.stderr)
            picture = os.path.join(os.fsencode(folder), b"lat\xb2in.svg")
            answer = self.run_axisctl("mill", "preview", job, "--profile", "mdx-20", "-o", picture)
            self.assertEqual(answer.returncode, 0, answer.stderr)


class WithDaemon(unittest.TestCase):
    """Every test gets a daemon of its own, whose simulator has just been switched on: all axes at 0."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisctl-test-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.daemon = Daemon(self.folder, CONFIG)
        self.addCleanup(lambda: self.daemon.stop())

    def ok(self, *arguments, stdin=""):
        answer = self.daemon.run(*arguments, stdin=stdin)
        self.assertEqual((answer.returncode, answer.stderr), (0, ""), arguments)
        return answer.stdout

    def refused(self, code, reason, *arguments, stdin=""):
        answer = self.daemon.run(*arguments, stdin=stdin)
        self.assertRegex(answer.stderr, rf"\Aaxisctl: {reason}: [^\n]+\n\Z", arguments)
        self.assertEqual(answer.returncode, code, answer.stderr)
        return answer

    def test_targets(self):
        """Also a path that does not begin with a slash, and the forms of an address."""
        port = self.daemon.address().rsplit(":", 1)[1]
        folder, socket = os.path.split(self.daemon.socket)
        for target in (socket, f"./{socket}", f"unix:{socket}", f"{os.path.basename(folder)}/{socket}",
                       f"localhost:{port}", f"127.0.0.1:{port}"):
            where = os.path.dirname(folder) if target.startswith(os.path.basename(folder)) else folder
            with self.subTest(target):
                answer = subprocess.run([BIN / "axisctl", "--target", target, "devices"], cwd=where, text=True,
                                        capture_output=True, timeout=LIMIT_S, check=False)
                self.assertEqual((answer.returncode, answer.stderr), (0, ""))

    def test_what_there_is(self):
        self.assertEqual(self.ok("devices"), "stage  shrc203  UP\n")
        self.assertEqual(self.ok("position"), "axis x  0 mm\naxis y  0 um\naxis 3  0 um\n")
        status = self.ok("status")
        self.assertIn("SHRC-203", status)
        self.assertRegex(status, r"(?m)^axis 1  x  0 mm  busy no  excited yes  homed no")
        self.assertRegex(self.ok("commands"), r"(?m)^M: ")
        self.assertIn("68)", self.ok("commands", "MP:"))

    def test_json_is_one_object_a_line(self):
        for arguments in (["devices"], ["status"], ["position"], ["commands"], ["move", "1=1"], ["stop"],
                          ["exec", "?:P1"]):
            with self.subTest(arguments):
                for line in self.ok("--json", *arguments).splitlines():
                    self.assertIsInstance(json.loads(line), dict)
        last = json.loads(self.ok("--json", "move", "1=2").splitlines()[-1])
        self.assertEqual(last["motion"]["state"], "MOTION_STATE_SUCCEEDED")

    def test_moves_are_exact_and_waited_for(self):
        shown = self.ok("move", "x=+0.00001", "2=-200um", "--relative", "--speed", "2mm/s", "--acceleration-ms", "50")
        self.assertRegex(shown, r"done: axis x at 0\.00001 mm, axis y at -200 um\n\Z")
        self.assertEqual(self.ok("position"), "axis x  0.00001 mm\naxis y  -200 um\naxis 3  0 um\n")
        self.ok("move", "1=100pulse", "2=70nm")
        self.assertEqual(self.ok("position"), "axis x  0.001 mm\naxis y  0.07 um\naxis 3  0 um\n")

    def test_home_shows_each_axis(self):
        shown = self.ok("home", "1,2")
        self.assertEqual(sorted(re.findall(r"axis \d completed", shown)), ["axis 1 completed", "axis 2 completed"])
        self.assertRegex(self.ok("status"), r"(?m)^axis 1 .* homed yes")

    def test_what_cannot_be_is_refused_and_nothing_moves(self):
        self.refused(3, "NOT_REPRESENTABLE", "move", "1=15nm")
        self.refused(3, "OUTSIDE_TRAVEL", "move", "x=9.00001mm")
        self.refused(3, "TOO_FAST", "move", "x=1mm", "--speed", "6mm/s")
        self.refused(3, "UNKNOWN_UNIT", "move", "x=1deg")
        self.refused(3, "UNKNOWN_DEVICE", "--device", "nowhere", "status")
        self.refused(2, "UNKNOWN_AXIS", "move", "w=1mm")
        self.refused(2, "UNKNOWN_UNIT", "move", "x=1inch")
        self.refused(2, "UNKNOWN_UNIT", "move", "x=1emm")
        self.refused(2, "INVALID_REQUEST", "move", "x=0.5pulse")
        self.assertEqual(self.ok("position"), "axis x  0 mm\naxis y  0 um\naxis 3  0 um\n")

    def test_path(self):
        path = os.path.join(self.folder, "square.txt")
        with open(path, "w", encoding="utf-8") as file:
            file.write("# a square\n1=0.2 2=0 speed=1mm/s\n1=0 2=200\n\n1=-0.2 2=0   # back\n1=0 2=-0.2mm\n")
        shown = self.ok("path", path, "--speed", "1mm/s")
        self.assertRegex(shown, r"segment 2 (sent: OK_D\n|came too late)")  # the latter on a busy machine
        self.assertIn("segment 4 done\n", shown)
        self.assertRegex(shown, r"axis 1 completed\n")
        self.assertRegex(shown, r"done: axis x at 0 mm, axis y at 0 um\n\Z")

    def test_path_error_names_file_and_line(self):
        answer = self.refused(2, "INVALID_REQUEST", "path", "-", stdin="1=1mm 2=1mm\n\n1=1mm 2\n")
        self.assertIn("standard input:3: ", answer.stderr)
        self.refused(2, "INVALID_REQUEST", "path", os.path.join(self.folder, "none.txt"))

    def test_exec_prints_answers_and_completions_and_nothing_else(self):
        self.assertEqual(self.ok("exec", "?:C1"), "1\n")
        self.assertEqual(self.ok("exec", "HRT:1"), "OK\n1\n")
        self.assertEqual(self.ok("exec", "M:1+P1000", "G:1"), "OK\nOK\n")
        reply = json.loads(self.ok("--json", "exec", "?:C1"))["reply"]
        self.assertEqual(reply["answer"], "1")
        self.assertTrue(reply["sent"].startswith("?:C"))

    def test_exec_refuses(self):
        self.refused(3, "INCOMPLETE_TRANSACTION", "exec", "M:1+P1000")
        self.refused(3, "UNKNOWN_COMMAND", "exec", "ZZZ:1")
        for line in ("Q:\rL:W", "Q:\nL:W", "Q:\u00b5"):
            self.refused(3, "MALFORMED_LINE", "exec", line)

    def test_stop_in_mid_move(self):
        move = self.daemon.start("move", "x=8mm", "--speed", "1mm/s")
        move.until("RUNNING")
        self.assertRegex(self.ok("stop"), r"(?m)^axis x: replied OK, stationary at ")
        self.assertEqual(move.end(), 1)
        self.assertRegex(move.errors, r"\Aaxisctl: STOPPED: [^\n]+\n\Z")

    def test_no_wait(self):
        self.assertRegex(self.ok("move", "x=8mm", "--speed", "1mm/s", "--no-wait"), r"\Astarted: motion \d+\n\Z")
        self.refused(5, "DEADLINE_PASSED", "move", "x=1mm")
        self.ok("stop", "x")

    def test_emergency_stop_latches_until_cleared(self):
        self.assertIn("nothing moves until `axisctl clear`", self.ok("estop"))
        self.assertEqual(self.daemon.run("move", "x=1mm").returncode, 3)
        self.ok("clear")

    def test_two_devices_need_a_name(self):
        self.daemon.stop()
        self.daemon = Daemon(self.folder, CONFIG + SECOND_DEVICE)
        answer = self.refused(2, "INVALID_REQUEST", "status")
        self.assertIn("--device: stage, other", answer.stderr)
        self.ok("--device", "other", "position")

    def test_watchers_see_the_same_and_resume(self):
        watchers = [self.daemon.start("--json", "watch", "--from", "1") for _ in range(3)]
        for watcher in watchers:
            self.addCleanup(watcher.kill)
        self.ok("move", "x=1mm")
        seen = []
        for watcher in watchers:
            events = [json.loads(watcher.next())]
            while events[-1].get("motion", {}).get("state") != "MOTION_STATE_SUCCEEDED":
                events.append(json.loads(watcher.next()))
            seen.append(events)
        self.assertEqual(seen[0], seen[1])
        self.assertEqual(seen[0], seen[2])
        revisions = [int(event["revision"]) for event in seen[0]]
        self.assertEqual(revisions, list(range(1, len(revisions) + 1)))

        self.ok("move", "x=2mm")
        back = self.daemon.start("watch", "--from", str(revisions[-1] + 1))
        self.addCleanup(back.kill)
        self.assertRegex(back.next(), rf"\A{revisions[-1] + 1} ")
        back.until("SUCCEEDED")

    def test_watch_outlives_a_restart_of_the_daemon(self):
        watcher = self.daemon.start("watch", "--from", "1")
        self.addCleanup(watcher.kill)
        self.ok("move", "x=1mm")
        watcher.until("SUCCEEDED")
        self.daemon.stop()
        self.daemon = Daemon(self.folder, CONFIG)
        watcher.until(r"^\d+ \S+ daemon started$")
        watcher.kill()
        self.assertNotIn("COMPACTED", watcher.errors)

    def test_a_daemon_lost_in_mid_move_is_an_unknown_outcome(self):
        move = self.daemon.start("move", "x=8mm", "--speed", "1mm/s")
        move.until("RUNNING")
        self.daemon.stop()
        self.assertEqual(move.end(), 1)
        self.assertRegex(move.errors, r"axisctl: (OUTCOME_UNKNOWN|STOPPED): ")
        self.daemon = Daemon(self.folder, CONFIG)


if __name__ == "__main__":
    unittest.main(verbosity=2)
