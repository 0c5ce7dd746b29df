#!/usr/bin/env python3
"""Jobs of people at a mill: sent, confirmed, started, paused, aborted, cancelled, and seen. Both mills are simulated;
`quick` is an MDX-20 that executes a small job within a second."""

import os
import pathlib
import pty
import re
import signal
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

[[device]]
name = "mill"
kind = "rml1"
profile = "mdx-20"
connection = "simulated"
tools = ["T1", "T2"]

[[device]]
name = "quick"
kind = "rml1"
profile = "%s"
connection = "simulated"
tools = ["T1"]
"""

# What an MDX-20 takes 50 s for.
SMALL = "^IN;!PZ-50,200;PU100,100;PU;H;\n"
# Moves with the tool up, 200 mm each: more than ten minutes.
LONG = "^IN;!MC0;!PZ-50,200;" + "PU8000,0;PU0,0;" * 50 + "H;\n"


def quick_profile():
    """That of the MDX-20, but for what takes time."""
    text = (ROOT / "deploy" / "mills" / "mdx-20.toml").read_text(encoding="utf-8")
    for key, value in (("travel", 1000), ("travel_z", 1000), ("cutting_maximum", 1000), ("z_maximum", 1000),
                       ("z_default", 1000), ("best", 10000), ("worst", 10000), ("slower", 0), ("spin_up_s", 0)):
        text, count = re.subn(rf"(?m)^{key} = \S+", f"{key} = {value}", text)
        if count != 1:
            raise AssertionError(f"the profile of the MDX-20 has {key} {count} times")
    return text


class MillJobs(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisctl-jobs-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        profile = self.folder / "quick.toml"
        profile.write_text(quick_profile(), encoding="utf-8")
        self.daemon = Daemon(folder.name, CONFIG % profile)
        self.addCleanup(lambda: self.daemon.stop())
        for device in ("mill", "quick"):
            self.await_queue("  line open\n", device)

    def run_mill(self, *arguments, device="mill", stdin=""):
        return self.daemon.run("--device", device, "mill", *arguments, stdin=stdin)

    def run_well(self, *arguments, **more):
        answer = self.run_mill(*arguments, **more)
        self.assertEqual((answer.returncode, answer.stderr), (0, ""), answer.stdout)
        return answer.stdout

    def refused(self, pattern, *arguments, code=3, **more):
        answer = self.run_mill(*arguments, **more)
        self.assertEqual(answer.returncode, code, answer.stdout + answer.stderr)
        self.assertRegex(answer.stderr, pattern)

    def run_as_stranger(self, *arguments, stdin=""):
        return subprocess.run([BIN / "axisctl", "--target", self.daemon.address(), "--device", "mill", "mill", *arguments],
                              input=stdin, capture_output=True, text=True, timeout=LIMIT_S, check=False)

    def send(self, job, *options, **more):
        """The number of the job."""
        sent = self.run_well("send", "-", "--title", "frame", *options, stdin=job, **more)
        return re.fullmatch(r"job (\d+) \(frame\) QUEUED; takes .+\n", sent)[1]

    def start_long(self):
        number = self.send(LONG)
        self.run_well("confirm", "--yes", "--start")
        self.await_queue(rf"job {number} \(frame\) SENDING ")
        return number

    def await_queue(self, pattern, device="mill"):
        deadline = time.monotonic() + LIMIT_S
        while True:
            answer = self.run_mill("queue", device=device)
            if re.search(pattern, answer.stdout):
                return answer.stdout
            self.assertLess(time.monotonic(), deadline, answer.stdout + answer.stderr)
            time.sleep(0.05)  # between two looks; the deadline above decides

    def test_from_the_file_to_the_workpiece(self):
        file = self.folder / "lid.rml"
        file.write_text(SMALL, encoding="ascii")
        sent = self.run_well("send", str(file), device="quick")
        number = re.fullmatch(r"job (\d+) \(lid\.rml\) QUEUED; takes .+\n", sent)[1]
        self.assertRegex(self.run_well("queue", device="quick"), rf"(?m)^{number} +lid\.rml +unix \S+ +QUEUED +T1 +panel ")
        self.refused("NOT_CONFIRMED", "start", number, device="quick")
        self.refused("a person at the mill must confirm", "confirm", code=2, device="quick")
        confirmed = self.run_well("confirm", "--yes", device="quick")
        self.assertRegex(confirmed, r"\n  tool      T1\n  origin    as it is set at the panel\n")
        self.assertRegex(confirmed, rf"\njob {number} \(lid\.rml\) is confirmed by unix \S+ until 20\d\d-")
        self.assertRegex(self.run_well("queue", device="quick"), r" CONFIRMED .* by unix \S+ until ")
        followed = self.run_well("start", "--follow", device="quick")
        self.assertRegex(followed, r"; after an abort at most \d+ bytes, up to \d.* s and \d+ mm, run on")
        self.assertRegex(followed, rf"\njob {number} \(lid\.rml\) FED: all was sent, ")
        self.assertRegex(self.run_well("queue", device="quick"), r"no job runs\n(.*\n)*.* FED ")
        self.assertEqual(self.run_well("done", number, device="quick"), f"job {number} is DONE\n")
        self.assertRegex(self.run_well("queue", device="quick"), r"\nno jobs\n\Z")

    def answer(self, text):
        """What `confirm` exits with after this answer at a terminal."""
        person, terminal = pty.openpty()
        self.addCleanup(os.close, person)
        os.write(person, text)
        asked = subprocess.run(self.daemon.command("--device", "mill", "mill", "confirm"), stdin=terminal,
                               capture_output=True, text=True, timeout=LIMIT_S, check=False)
        os.close(terminal)
        self.assertRegex(asked.stdout, r"\nThe material is in, the tool T2 is in, the origin is set, and nothing is in the "
                                       r"way\? \[yes/no\]\n")
        return asked.returncode

    def test_a_person_answers(self):
        self.send(SMALL, "--tool", "T2")
        self.assertEqual(self.answer(b"perhaps\n"), 1)
        self.assertRegex(self.run_well("queue"), " QUEUED ")
        self.assertEqual(self.answer(b"Y\n"), 0)
        self.assertRegex(self.run_well("queue"), " CONFIRMED ")

    def test_abort_in_the_middle(self):
        number = self.start_long()
        watching = self.daemon.start("--device", "mill", "mill", "watch")
        self.addCleanup(lambda: watching.process.poll() is None and watching.kill())
        watching.until(r"\ASENDING \[.{10}\] \d+( to \d+)? %, \d+ of \d+ bytes written, \d+ taken, ")
        self.send(SMALL)
        self.assertRegex(self.run_well("abort"),
                         rf"\Athe abort was sent: at most \d+ bytes of job {number}, up to .* s and \d+ mm, may run on.*; "
                         r"by the mill's profile what is executed ends (at|between) line \d+, column \d+( and .*)?; look at")
        self.assertEqual(watching.end(), 1)
        self.assertRegex(watching.errors, rf"ABORTED: the abort of job {number} |OUTCOME_UNKNOWN: job {number} has left")
        queue = self.run_well("queue")
        self.assertNotRegex(queue, rf"(?m)^{number} ")
        executed = rf"job {number} \(frame\) was aborted: by the mill's profile (what was executed ends (at|between) line .*)"
        history = self.daemon.run("--device", "mill", "history").stdout
        self.assertIn(re.search(executed, queue)[1], history)
        self.refused("NOT_CONFIRMED", "start")  # the next one is not confirmed by that

    def test_the_history_has_what_became_of_a_job(self):
        number = self.send(SMALL)
        self.run_well("cancel", number)
        history = self.daemon.run("--device", "mill", "history")
        self.assertEqual((history.returncode, history.stderr), (0, ""))
        self.assertRegex(history.stdout, rf"  mill  job {number} is CANCELLED, by unix \S+")
        self.assertRegex(history.stdout, rf"  mill  job {number} is QUEUED, by unix \S+")

    def test_abort_where_none_runs(self):
        self.assertEqual(self.run_well("abort"),
                         "the abort was sent; no job ran; look at the mill; in an emergency use its own emergency "
                         "stop\n")

    def test_pause_and_resume(self):
        number = self.start_long()
        self.assertRegex(self.run_well("pause"), rf"\Ajob {number} is paused: (\d+ to )?\d+ bytes of it, up to .* s and \d+ mm, "
                                                 r"still run.*; the cutter keeps turning in the cut\n\Z")
        self.assertRegex(self.run_well("queue"), rf"\njob {number} \(frame\) PAUSED \[")
        self.refused(f"WRONG_JOB_STATE: job {number} is paused already", "pause")
        self.assertRegex(self.run_well("resume"), rf"\Ajob {number} is resumed; ")
        self.await_queue(rf"\njob {number} \(frame\) SENDING \[")
        self.refused("WRONG_JOB_STATE", "resume")
        self.run_well("abort")

    def test_what_went_over_the_line_is_recorded(self):
        self.send(SMALL, device="quick")
        self.run_well("confirm", "--yes", "--start", device="quick")
        self.await_queue(" FED ", "quick")
        recorded = self.daemon.run("--device", "quick", "record", "--no-follow")
        self.assertEqual((recorded.returncode, recorded.stderr), (0, ""))
        self.assertRegex(recorded.stdout, r"\A# axisgate recording 1\n# kind: rml1\n# device: \"quick\"\n")
        written = "".join(re.findall(r'(?m)^\S+ #\d+ motion "" > "(.*)"$', recorded.stdout))
        self.assertTrue(written.startswith(";^DF;" + SMALL.replace("\n", "\\n")), written)

    def test_by_hand(self):
        self.send(LONG)
        self.run_well("confirm", "--yes")
        stepped = self.run_well("jog", "x=5", "Z=-0.5mm")
        self.assertRegex(stepped, r"the step, unchecked .*, was sent; by its profile the mill has done it within \d+\.\d s\n")
        self.refused("AXIS_BUSY: the mill may still do what it was sent by hand", "jog", "y=1")
        self.refused("NOT_CONFIRMED.* is no longer confirmed at the mill, since ", "start")
        self.refused("a step of 6 mm down is too long", "jog", "z=-6")
        self.refused("\"5\" is not an axis and a distance .*x=5", "jog", "5", code=2)
        self.refused("\"a=5\" is not an axis and a distance", "jog", "a=5", code=2)
        self.run_well("abort")
        self.await_queue("no job runs")
        self.assertEqual(self.run_well("origin", device="quick"), "Z0 was sent\n")
        self.assertEqual(self.run_well("origin", "--z", "-40", device="quick"), "Z0 was sent\n")
        self.refused("there is no|has no origin \"vice\"", "origin", "vice", device="quick")
        self.refused("OUT_OF_RANGE", "origin", "--z", "40", device="quick")
        self.refused("NAME excludes --z", "origin", "vice", "--z", "-40", device="quick", code=2)
        self.assertEqual(self.run_well("spindle", "off", device="quick"), "spindle off was sent\n")

    def test_cancel(self):
        first, second = self.send(SMALL), self.send(SMALL)
        self.assertEqual(self.run_well("cancel", first), f"job {first} is CANCELLED\n")
        self.assertEqual(re.findall(r"(?m)^(\d+) ", self.run_well("queue")), [second])
        self.refused("NOT_FOUND", "cancel", first)
        self.refused("WRONG_JOB_STATE", "done", second)

    def test_the_job_of_another_person_waits(self):
        running, mine = self.start_long(), self.send(SMALL)
        sent = self.run_as_stranger("send", "-", "--title", "lid", stdin=SMALL)
        self.assertEqual(sent.returncode, 0, sent.stderr)
        theirs = re.match(r"job (\d+) \(lid\) QUEUED", sent.stdout)[1]
        queue = self.run_well("queue")
        self.assertEqual(re.findall(r"(?m)^(\d+) ", queue), [running, mine, theirs])
        self.assertRegex(queue, rf"(?m)^{theirs} +lid +tcp 127\.0\.0\.1\S* +QUEUED ")
        self.refused("WRONG_JOB_STATE", "confirm", theirs, "--yes")
        refused = self.run_as_stranger("cancel", mine)
        self.assertEqual(refused.returncode, 3)
        self.assertRegex(refused.stderr, "NOT_ALLOWED")
        aborted = self.run_as_stranger("abort")  # as a stop: everybody may
        self.assertEqual(aborted.returncode, 0, aborted.stderr)
        self.assertRegex(aborted.stdout, rf"of job {running}, up to .* s and \d+ mm, may run on")

    def test_the_same_request_is_one_job(self):
        command = ("--device", "mill", "--request-id", "lid-1", "mill", "send", "-")
        first, again = (self.daemon.run(*command, stdin=SMALL) for _ in range(2))
        self.assertEqual((first.returncode, again.returncode), (0, 0), first.stderr + again.stderr)
        self.assertEqual(first.stdout, again.stdout)
        self.assertEqual(len(re.findall(r"(?m)^\d+ ", self.run_well("queue"))), 1)

    def test_what_is_not_sent_into_the_queue(self):
        self.refused("INVALID_REQUEST", "send", "-", stdin="Q;")
        self.refused("INVALID_REQUEST", "send", "-", stdin=SMALL + "!NR;")  # a warning
        self.refused("INVALID_REQUEST", "send", "-", "--tool", "T9", stdin=SMALL)
        self.refused("missing.rml cannot be read", "send", str(self.folder / "missing.rml"), code=2)
        self.assertRegex(self.run_well("queue"), r"\nno jobs\n\Z")

    def test_ctrl_c_does_not_end_a_job(self):
        number = self.start_long()
        watching = self.daemon.start("--device", "mill", "mill", "watch")
        watching.until(r"\ASENDING ")
        watching.process.send_signal(signal.SIGINT)
        self.assertEqual(watching.end(), 130)
        self.assertIn("axisctl: the job continues; to end it: axisctl mill abort\n", watching.errors)
        self.assertRegex(self.run_well("queue"), rf"\njob {number} \(frame\) SENDING \[")

    def metric(self, name, *labels):
        """Of the mill `quick`."""
        series = sorted((*labels, 'device="quick"'))
        found = re.findall(rf"(?m)^axisgate_mill_{name}{{(.*)}} (\S+)$", self.daemon.metrics_page())
        values = [float(value) for label, value in found if sorted(label.split(",")) == series]
        self.assertEqual(len(values), 1, f"{name} {series}: {found}")
        return values[0]

    def await_metric(self, expected, name, *labels):
        deadline = time.monotonic() + LIMIT_S
        while (value := self.metric(name, *labels)) != expected:
            self.assertLess(time.monotonic(), deadline, f"{name} {labels} is {value}, not {expected}")
            time.sleep(0.05)  # the page may be 100 ms old; the deadline above decides

    def test_what_prometheus_sees(self):
        self.await_metric(1, "line_open")
        number = self.send(SMALL, device="quick")
        self.run_well("confirm", "--yes", device="quick")
        self.await_metric(1, "queued_jobs", 'state="CONFIRMED"')
        self.run_well("start", "--follow", device="quick")
        self.await_metric(1, "queued_jobs", 'state="FED"')
        self.await_metric(len(SMALL), "written_bytes_total")
        self.await_metric(5, "commands_total")  # ^IN; !PZ; PU; PU; H; with what is behind each
        self.assertGreater(self.metric("job_seconds_total"), 0)
        least, most = (self.metric("job_estimate_seconds_total", f'bound="{bound}"') for bound in ("least", "most"))
        self.assertGreater(least, 0)
        self.assertLessEqual(least, most)
        self.run_well("done", number, device="quick")
        self.run_well("abort", device="quick")
        self.await_metric(1, "aborts_total")
        for outcome, jobs in (("FED", 1), ("DONE", 1), ("ABORTED", 0), ("CANCELLED", 0), ("EXPIRED", 0),
                              ("PAUSED_UNKNOWN", 0)):
            self.await_metric(jobs, "jobs_total", f'outcome="{outcome}"')
        self.await_metric(0, "queued_jobs", 'state="FED"')

    def test_the_buffer_of_a_job_that_runs(self):
        self.start_long()
        deadline = time.monotonic() + LIMIT_S
        page = ""
        while not re.search(r'(?m)^axisgate_mill_buffer_bytes{bound="most",device="mill"} [1-9]', page):
            self.assertLess(time.monotonic(), deadline, page)
            page = self.daemon.metrics_page()
        self.assertRegex(page, r'(?m)^axisgate_mill_queued_jobs{device="mill",state="RUNNING"} 1$')

    def test_which_device_is_meant_without_a_name(self):
        self.assertEqual(self.daemon.run("devices").stdout, "stage  shrc203  UP\nmill  rml1  UP\nquick  rml1  UP\n")
        answer = self.daemon.run("mill", "queue")
        self.assertEqual(answer.returncode, 2)
        self.assertRegex(answer.stderr, r"the daemon has 2 mills \(choose one with --device: mill, quick\)")
        self.assertRegex(self.daemon.run("position").stdout, r"\Aaxis 1  0 um\n")  # of the only stage
        leased = self.daemon.run("lease", "run", "--axes", "1", "--", BIN / "axisctl", "--target", self.daemon.socket,
                                 "lease", "list")
        self.assertRegex(leased.stdout, r"\Aaxis 1  held by ")
        leased = self.daemon.run("--device", "mill", "lease", "run", "--", BIN / "axisctl", "--target",
                                 self.daemon.socket, "--device", "mill", "lease", "list")
        self.assertRegex(leased.stdout, r"\Athe whole device  held by ")
        self.assertRegex(self.daemon.run("history").stdout, r"lease \d+ of .* over the whole device")
        refused = self.daemon.run("--device", "mill", "position")
        self.assertRegex(refused.stderr, r"INVALID_REQUEST: devices/mill is a mill: it has no axes to move")
        for words in (("outputs",), ("move", "1=1mm"), ("clear", "1")):
            refused = self.daemon.run("--device", "mill", *words)
            self.assertEqual(refused.returncode, 3, words)
            self.assertRegex(refused.stderr, r"devices/mill is a mill: it has no axes to move")
        self.assertEqual(self.daemon.run("--device", "mill", "status").stdout,
                         "mill  UP\nMDX-20; `axisctl mill queue` shows its jobs\n")
        self.assertEqual(self.daemon.run("--device", "quick", "sim", "cover", "open").returncode, 0)

    def test_a_stop_of_an_axis_is_no_abort(self):
        number = self.start_long()
        self.assertEqual(self.daemon.run("stop", "1").returncode, 0)
        self.assertRegex(self.run_well("queue"), rf"\njob {number} \(frame\) SENDING \[")
        self.daemon.run("stop")
        self.await_queue(r"\nno jobs\n\Z")


if __name__ == "__main__":
    unittest.main()
