#!/usr/bin/env python3
"""axisctl record, replay and support, as a person uses them."""

import getpass
import os
import re
import signal
import subprocess
import tempfile
import time
import unittest

from programs import BIN, LIMIT_S, Daemon

CONFIG = """
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "{socket}"

[[device]]
name = "stage"
connection = "simulated"
speed = 20
"""

SERIAL_NUMBER = re.compile(r"SIGMAKOKI,SHRC-203,(\d+),")


def read(path):
    with open(path, encoding="ascii") as file:
        return file.read()


def run_axisctl(*arguments, **process):
    return subprocess.run([BIN / "axisctl", *arguments], capture_output=True, text=True, timeout=LIMIT_S, check=False,
                          **process)


class InAFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-recording-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.recording = os.path.join(self.folder, "stage.recording")

    def serve(self, config=CONFIG):
        self.daemon = Daemon(self.folder, config)
        self.addCleanup(lambda: self.daemon.stop())

    def ok(self, *arguments):
        answer = self.daemon.run(*arguments)
        self.assertEqual((answer.returncode, answer.stderr), (0, ""), arguments)
        return answer.stdout

    def wait_until_recorded(self, pattern):
        deadline = time.monotonic() + LIMIT_S
        while not (os.path.exists(self.recording) and re.search(pattern, read(self.recording))):
            self.assertLess(time.monotonic(), deadline, f"{pattern} is not recorded")
            time.sleep(0.02)  # between two looks; the deadline above decides

    def assert_replays(self, path):
        replayed = run_axisctl("replay", path)
        self.assertEqual((replayed.returncode, replayed.stderr), (0, ""), replayed.stdout)
        self.assertRegex(replayed.stdout, rf"\A{path}: [1-9]\d* exchanges, no difference\n\Z")


class Record(InAFolder):
    def setUp(self):
        super().setUp()
        self.serve()

    def test_a_move_is_recorded_from_the_start_and_replayed(self):
        self.ok("move", "1=1mm", "--relative")
        self.assertRegex(self.ok("record", "--no-follow", "--output", self.recording),
                         rf"\A{self.recording}: \d+ lines\n\Z")
        text = read(self.recording)
        self.assertRegex(text, r'\A# axisgate recording 1\n')
        self.assertIn('# device: "stage"\n', text)
        self.assertRegex(text, SERIAL_NUMBER)
        self.assertRegex(text, rf'(?m)^\d+\.\d+ #\d+ motion "unix {getpass.getuser()}" > "MP:1\+P100000\\r\\n"')
        self.assertRegex(text, r'(?m)^\d+\.\d+ .*completion 1\b')
        self.assert_replays(self.recording)

    def test_what_comes_is_followed_until_an_interruption(self):
        recorder = self.daemon.start("record", "--new", "--output", self.recording)
        self.addCleanup(recorder.kill)
        self.wait_until_recorded("axisgate recording")
        self.ok("move", "1=1mm")
        self.wait_until_recorded("completion 1")
        recorder.process.send_signal(signal.SIGINT)
        self.assertRegex(recorder.until("lines"), rf"\A{self.recording}: \d+ lines\Z")
        self.assertEqual(recorder.end(), 0)
        self.assertNotRegex(read(self.recording), SERIAL_NUMBER)
        self.assert_replays(self.recording)

    def test_it_ends_by_itself_and_writes_to_the_standard_output(self):
        self.assertRegex(self.ok("record", "--seconds", "1"), r"\A# axisgate recording 1\n(.*\n)+\Z")

    def test_what_cannot_be_is_refused(self):
        for arguments in (["--json"], ["--output", "/nonexistent/recording"], ["--no-follow", "--new"], ["--seconds", "0"]):
            with self.subTest(arguments):
                answer = self.daemon.run("record", *arguments)
                self.assertEqual(answer.returncode, 2)
                self.assertRegex(answer.stderr, r"\Aaxisctl: INVALID_REQUEST: [^\n]+\n\Z")
        self.assertEqual(self.daemon.run("--device", "nowhere", "record").returncode, 3)


class Replay(InAFolder):
    def test_a_doctored_recording_says_where_it_differs(self):
        self.serve()
        self.ok("move", "1=1mm")
        self.ok("record", "--no-follow", "--output", self.recording)
        lines = read(self.recording).splitlines(keepends=True)
        place = next(i for i, line in enumerate(lines) if " motion " in line and " = ok" in line)
        lines[place] = lines[place].replace('< "OK\\r\\n"', '< "NG\\r\\n"')
        doctored = os.path.join(self.folder, "doctored.recording")
        with open(doctored, "w", encoding="ascii") as file:
            file.writelines(lines)
        answer = run_axisctl("replay", doctored)
        self.assertEqual(answer.returncode, 1)
        self.assertRegex(answer.stdout, rf"\A{doctored}:{place + 1}: recorded [^\n]+; now [^\n]+\n")
        self.assertRegex(answer.stdout, rf"\n{doctored}: \d+ exchanges, \d+ differences?\n\Z")

    def test_what_is_no_recording_is_refused_with_its_line(self):
        def refused(text):
            answer = run_axisctl("replay", "-", input=text)
            self.assertEqual(answer.returncode, 2)
            self.assertRegex(answer.stderr, r"\Aaxisctl: INVALID_REQUEST: standard input[^\n]+\n\Z")
            return answer.stderr

        self.assertIn("is not a recording", refused("hello\n"))
        head = '# axisgate recording 1\n# kind: shrc203\n# baud: 38400\n# reply-limit: 0.500000\n'
        self.assertIn("line 5: ", refused(head + "1.0 what\n"))
        self.assertIn("(counted from line 6 on): line 5: ", refused(head + "\n" + head + "1.0 what\n"))
        answer = run_axisctl("replay", "-", input=head)
        self.assertEqual(answer.returncode, 1)
        self.assertIn("NOTHING_COMPARED", answer.stderr)
        self.assertEqual(run_axisctl("replay", "/nonexistent/recording").returncode, 2)


class AtTheLinesPace(InAFolder):
    def test_lines_that_come_byte_by_byte_read_as_lines_and_replay(self):
        self.serve(CONFIG.replace("speed = 20", "baud = 38400"))
        self.ok("move", "1=1mm", "--relative")
        self.ok("record", "--no-follow", "--output", self.recording)
        for line in read(self.recording).splitlines():
            self.assertLess(line.count(' < "'), 10, line)
        self.assert_replays(self.recording)


class TheDaemonsFile(InAFolder):
    def test_is_complete_over_a_restart(self):
        config = CONFIG + f'record = "{self.recording}"\n'
        for target in ("1mm", "2mm"):
            self.serve(config)
            self.ok("move", "1=" + target)
            self.daemon.stop()
        text = read(self.recording)
        self.assertEqual(len(re.findall(r"(?m)^# axisgate recording 1$", text)), 2)
        self.assertEqual(len(re.findall(r"completion 1\b", text)), 2)
        self.assert_replays(self.recording)


class Support(InAFolder):
    SECTIONS = ("support report of Axisgate", "report of axisgated", "versions", "configuration, with the defaults",
                "state of stage", "metrics", "recording of stage", "replaced")

    def test_it_has_all_sections_and_no_secrets(self):
        self.serve(CONFIG + f'record = "{self.recording}"\n')
        self.ok("move", "1=1mm")
        serial_number = SERIAL_NUMBER.search(self.ok("record", "--no-follow"))[1]
        report = os.path.join(self.folder, "report.txt")
        self.assertIn(report, self.ok("support", "--output", report))
        text = read(report)
        self.assertEqual(re.findall(r"(?m)^== (.*) ==$", text), list(self.SECTIONS))
        for secret in (serial_number, f'"unix {getpass.getuser()}"', self.folder, os.uname().nodename + "\n"):
            self.assertNotIn(secret, text)
        self.assertIn('motion "unix user-1"', text)
        self.assertRegex(text, r"(?m)^axisgated \d+\.\d+\.\d+$")
        self.assertRegex(text, r"(?m)^gRPC 1\.")
        self.assertRegex(text, r"(?m)^system .*Linux \d")
        self.assertRegex(text, r'(?m)^record = "/path-\d"$')
        self.assertRegex(text, r'(?m)^link: LINK_STATE_UP$')
        self.assertRegex(text, r'(?m)^axisgate_motions_total\{.*outcome="SUCCEEDED"\} 1$')
        self.assertRegex(text, r"(?m)completion 1\b")
        self.assert_replays(report)

    def test_without_a_daemon_it_says_so(self):
        answer = run_axisctl("--target", "/nonexistent/axisgate.sock", "support", cwd=self.folder)
        self.assertEqual(answer.returncode, 0)
        self.assertRegex(answer.stderr, r"\Aaxisctl: UNAVAILABLE: no daemon answers [^\n]+\n\Z")
        name = re.fullmatch(r"(axisgate-support-\d{8}-\d{6}\.txt): without the daemon's part; [^\n]+\n", answer.stdout)[1]
        text = read(os.path.join(self.folder, name))
        self.assertIn("the daemon is reached by a Unix socket, which cannot be reached: No such file", text)
        self.assertRegex(text, r"(?m)^== no report of axisgated, or an incomplete one: UNAVAILABLE ==$")
        self.assertNotIn("nonexistent", text)


if __name__ == "__main__":
    unittest.main(verbosity=2)
