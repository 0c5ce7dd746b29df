#!/usr/bin/env python3
"""Jobs that have ended are queued once more, whole or from a line on; a finishing continues the workpiece of a
roughing; and what is refused uses no number. The simulated mill is quick, but for the jobs that are aborted."""

import json
import pathlib
import re
import signal
import tempfile
import time
import unittest

from mill_jobs_test import quick_profile
from programs import BIN, LIMIT_S, Daemon, Lines

CONFIG = """
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "{socket}"

[[device]]
name = "mill"
kind = "rml1"
profile = "PROFILE"
connection = "serial"
path = "TTY"
baud = 9600
flow_control = "rtscts"
window = 64
converter = 0
tools = ["T1", "T2"]

[[device.origin]]
name = "vice"
x = 400
y = 400
z = -800
"""

# An MDX-20 has steps of 0.025 mm: two passes of 6 mm, and one of 12 mm, which breaks most tools.
SMALL = "^IN;VS500;!VZ500;!MC1;!PZ-40,200;PU100,100;PD300,100;PU0,0;!MC0;\n"
ROUGH = "^IN;VS500;!VZ500;!MC1;!PZ-240,200;PU0,0;PD1000,0;PU0,0;!PZ-480,200;PD1000,0;PU0,0;!MC0;\n"
DEEP = "^IN;VS500;!VZ500;!MC1;!PZ-480,200;PU0,0;PD1000,0;PU0,0;!MC0;\n"
# A line for each command, so that lines count as commands do.
LONG = "^IN;!MC0;!PZ-40,200;\n" + "".join(f"PU{number},100;\n" for number in range(1, 2001))
HEAD_LINES = 1


class MillRepeat(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-mill-repeat-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.profile = self.folder / "quick.toml"
        self.profile.write_text(quick_profile(), encoding="utf-8")
        self.record = self.folder / "record.json"
        mill = Lines([BIN / "rml1-sim", "--pty", self.folder / "tty", "--profile", self.profile, "--baud", "9600",
                      "--record", self.record])
        self.addCleanup(mill.kill)
        mill.until("simulator on")
        self.config = CONFIG.replace("PROFILE", str(self.profile)).replace("TTY", str(self.folder / "tty"))
        self.begin_daemon()

    def begin_daemon(self):
        self.daemon = Daemon(str(self.folder), self.config)
        self.addCleanup(self.daemon.stop)
        self.await_queue("  line open\n")

    def run_mill(self, *arguments, stdin=""):
        return self.daemon.run("mill", *arguments, stdin=stdin)

    def run_well(self, *arguments, stdin=""):
        answer = self.run_mill(*arguments, stdin=stdin)
        self.assertEqual((answer.returncode, answer.stderr), (0, ""), answer.stdout)
        return answer.stdout

    def refused(self, pattern, *arguments, code=3, stdin=""):
        answer = self.run_mill(*arguments, stdin=stdin)
        self.assertEqual(answer.returncode, code, answer.stdout + answer.stderr)
        self.assertRegex(answer.stderr, pattern)
        return answer.stderr

    def await_queue(self, pattern):
        deadline = time.monotonic() + LIMIT_S
        while True:
            answer = self.run_mill("queue")
            if re.search(pattern, answer.stdout):
                return answer.stdout
            self.assertLess(time.monotonic(), deadline, answer.stdout + answer.stderr)
            time.sleep(0.05)  # between two looks; the deadline above decides

    def send(self, job, *options):
        sent = self.run_well("send", "-", "--title", "frame", *options, stdin=job)
        return re.match(r"job (\d+) \(frame\) QUEUED", sent)[1]

    def finish(self, number):
        self.run_well("confirm", number, "--yes", "--start", "--follow")
        self.run_well("done", number)

    def abort_long(self):
        number = self.send(LONG)
        self.run_well("confirm", "--yes", "--start")
        self.await_queue(r"SENDING .* [1-9]\d\d+ of \d+ bytes written")
        self.run_well("abort")
        self.await_queue(r"(?m)^no job runs$")
        return number

    def vectors(self):
        """The first coordinates of the PU commands that the mill has begun, in their order."""
        lines = self.record.read_text(encoding="ascii").splitlines(keepends=True)
        entries = [json.loads(line) for line in lines if line.endswith("\n")]
        pairs = [entry["numbers"] for entry in entries if entry.get("command") == "PU" and entry.get("numbers")]
        return [int(x) for x, y in pairs if int(y) == 100]

    def test_what_is_refused_uses_no_number(self):
        self.refused("INVALID_ARGUMENT|INVALID_REQUEST", "send", "-", "--title", "bad", stdin="PA;Q5;")
        self.refused("deep-pass", "send", "-", "--title", "deep", stdin=DEEP)
        self.assertEqual(self.send(SMALL), "1")

    def test_an_ended_job_again(self):
        first = self.send(SMALL, "--tool", "T2", "--origin", "vice", "--stock", "50,50,5")
        self.refused(rf"WRONG_JOB_STATE: job {first} .* has not ended", "again", first)
        self.finish(first)
        self.assertRegex(self.run_well("again", first), rf"\Ajob {int(first) + 1} \(frame\) QUEUED; takes ")
        queue = json.loads(self.daemon.run("--json", "mill", "queue").stdout)
        again = queue["jobs"][0]
        self.assertEqual((again["setup"]["tool"], again["setup"]["origin"], again["stock"]["x"]["mm"]), ("T2", "vice", "50"))
        self.assertEqual(again["continues"], "", "the workpiece is new")
        self.refused("NOT_CONFIRMED", "start")
        self.finish(again["name"].rpartition("/")[2])
        self.refused("NOT_FOUND: job 77 of mill is not kept", "again", "77")

    def test_an_ended_job_with_what_was_accepted_for_it(self):
        first = self.send(DEEP, "--accept", "deep-pass")
        self.run_well("cancel", first)
        again = self.run_well("again", first)
        self.assertRegex(again, r"\Ajob 2 \(frame\) QUEUED")
        self.assertRegex(self.run_well("confirm", "--yes"), r"\n  accepted  deep-pass\n")
        self.refused("drags-home", "again", first, "--accept", "drags-home")

    def test_the_rest_of_an_aborted_job(self):
        first = self.abort_long()
        why = self.refused(rf"INVALID_REQUEST: no line is named from which job {first} .* continues: what the mill has "
                           r"executed of it ends at line \d+, column \d+", "send", "--rest-of", first)
        least = int(re.search(r"ends at line (\d+)", why)[1])
        done = self.vectors()
        self.assertLessEqual(least - HEAD_LINES, len(done) + 1, "the lower bound is executed")
        rest = self.run_well("send", "--rest-of", first, "--from", "1995")
        self.assertRegex(rest, rf"\Ajob 2 \(frame\) QUEUED, from line 1995 on, on the workpiece of job {first}; takes ")
        self.assertRegex(self.await_queue("QUEUED"), r"(?m)^2 +frame .* QUEUED \(line 1995\) ")
        confirmed = self.run_well("confirm", "--yes")
        self.assertRegex(confirmed, r"(?s)\n  continues at line 1995, column 1\n"
                                    rf"  continues the workpiece of job {first}\n")
        before = len(self.vectors())
        self.run_well("start", "--follow")
        came = self.vectors()[before:]
        # Line 1995 has the vector 1994; above the end of the one before it the tool goes down.
        self.assertEqual(came, [1993, 1994, 1995, 1996, 1997, 1998, 1999, 2000])
        self.run_well("done")
        self.refused(r"WRONG_JOB_STATE: job 2 .* is DONE: it has no rest", "send", "--rest-of", "2", "--from", "3")

    def test_the_rest_keeps_its_place_over_a_kill(self):
        first = self.abort_long()
        self.run_well("send", "--rest-of", first, "--from", "1995")
        self.run_well("confirm", "--yes")
        self.daemon.signal(signal.SIGKILL)
        self.daemon.wait(LIMIT_S)
        self.begin_daemon()
        self.assertRegex(self.await_queue("QUEUED"), r"(?m)^2 +frame .* QUEUED \(line 1995\) ")
        self.run_well("confirm", "--yes", "--start", "--follow")

    def test_a_rest_has_all_else_of_its_job(self):
        self.refused("all else of that job", "send", "--rest-of", "1", "--tool", "T1", code=2)
        self.refused("FILE is required", "send", code=2)
        first = self.send(SMALL)
        self.run_well("cancel", first)
        self.refused("is CANCELLED, and was never begun: it has no rest", "send", "--rest-of", first, "--from", "1")

    def test_a_finishing_goes_on_with_a_roughing(self):
        rough = self.send(ROUGH, "--tool", "T1", "--stock", "50,50,20")
        self.finish(rough)
        self.refused("deep-pass", "send", "-", "--title", "fine", "--stock", "50,50,20", stdin=DEEP)
        sent = self.send(DEEP, "--continues", rough, "--tool", "T2", "--stock", "50,50,20")
        self.assertRegex(self.run_well("confirm", sent, "--yes"), rf"\n  continues the workpiece of job {rough}\n")

    def test_what_no_job_goes_on_with(self):
        rough = self.send(ROUGH)
        self.refused(rf"WRONG_JOB_STATE: job {rough} .* has not ended", "send", "-", "--continues", rough, stdin=ROUGH)
        self.finish(rough)
        for options, why in ((["--origin", "vice"], "had the origin of the panel, and this job has the origin vice"),
                             (["--stock", "50,50,5"], "had no stock, and this job has a stock of 50 x 50 x 5 mm")):
            self.refused(why, "send", "-", "--continues", rough, *options, stdin=ROUGH)
        self.refused("sets Z0 itself", "send", "-", "--continues", rough, stdin="!ZO-400;" + ROUGH)
        number = self.send(ROUGH, "--continues", rough)
        self.run_well("origin", "vice")
        self.refused(rf"SETUP_CHANGED: Z0 was sent to the mill since job {rough} began, and job {number} ", "confirm",
                     "--yes")
        self.run_well("cancel", number)
        self.refused(rf"Z0 was sent to the mill since job {rough} began", "send", "-", "--continues", rough, stdin=ROUGH)
        self.assertEqual(self.send(SMALL), str(int(number) + 1), "what was refused has no number")

    def test_the_check_knows_origins_by_name(self):
        file = self.folder / "small.rml"
        file.write_text(SMALL, encoding="ascii")
        answer = self.run_mill("check", str(file), "--profile", str(self.profile), "--origin", "vice")
        self.assertEqual((answer.returncode, answer.stderr), (0, ""), answer.stdout)
        placed = self.run_mill("check", str(file), "--profile", str(self.profile), "--origin", "10,10,20")
        self.assertEqual(answer.stdout, placed.stdout, "400 steps of 0.025 mm, and 800 below the top")
        self.refused('mill has no origin "vise" .*use vice', "check", str(file), "--profile", str(self.profile),
                     "--origin", "vise", code=2)


if __name__ == "__main__":
    unittest.main()
