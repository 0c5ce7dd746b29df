#!/usr/bin/env python3
"""Every example that `axisctl help` shows works, run in the order of its table, as from a shell."""

import os
import re
import signal
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

[[device]]
name = "mill"
kind = "rml1"
profile = "mdx-20"
connection = "simulated"
tools = ["T1", "T2"]
"""

ENDLESS = "until Ctrl-C"
TOPICS = ("units", "paths", "scans", "leases", "settings", "triggers")


def axisctl(*arguments):
    return subprocess.run([BIN / "axisctl", *arguments], capture_output=True, text=True, timeout=LIMIT_S, check=False)


def examples():
    return axisctl("help", "--list-examples").stdout.splitlines()


def verbs():
    return re.findall(r"(?m)^  ([a-z]+) {2,}\w", axisctl("help").stdout)


class Texts(unittest.TestCase):
    def test_every_verb_has_an_example(self):
        self.assertGreater(len(verbs()), 30)
        for verb in verbs():
            if verb != "help":
                self.assertTrue(any(re.search(rf"\baxisctl (--json )?{verb}\b", line) for line in examples()), verb)

    def test_every_topic_shows_examples_of_the_list(self):
        for topic in (*verbs(), *TOPICS):
            with self.subTest(topic):
                answer = axisctl("help", topic)
                self.assertEqual((answer.returncode, answer.stderr), (0, ""))
                if topic != "help":
                    shown = re.search(r"(?s)\nExamples?:\n(.*)", answer.stdout)[1]
                    for line in shown.strip().splitlines():
                        self.assertIn(line.strip(), examples())

    def test_a_verb_says_the_same_of_itself(self):
        self.assertEqual(axisctl("speed", "--help").stdout.split("Options:")[1].strip(),
                         axisctl("help", "speed").stdout.split("Options:")[1].strip())

    def test_the_list_is_for_tests_only(self):
        self.assertNotIn("--list-examples", axisctl("help", "help").stdout)


class Examples(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisctl-help-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.daemon = Daemon(self.folder, CONFIG)
        self.addCleanup(lambda: self.daemon.stop())
        self.environment = dict(os.environ, AXISGATE_TARGET=self.daemon.socket,
                                PATH=f"{BIN}{os.pathsep}{os.environ['PATH']}")

    def run_one(self, line):
        answer = subprocess.run(["sh", "-c", line], cwd=self.folder, env=self.environment, capture_output=True,
                                text=True, timeout=2 * LIMIT_S, check=False)
        if line.startswith("axisctl withdraw"):  # every stop was obeyed
            self.assertIn("is not open", answer.stderr)
            self.assertEqual(answer.returncode, 3)
            return
        self.assertEqual(answer.returncode, 0, f"{line}: {answer.stdout}{answer.stderr}")

    def interrupt_one(self, line):
        # Where the tests run in the background of a shell, SIGINT is ignored by all that they start.
        endless = Lines(["env", "--default-signal=INT", f"AXISGATE_TARGET={self.daemon.socket}",
                         f"PATH={self.environment['PATH']}", "sh", "-c", "exec " + line])
        self.addCleanup(endless.process.kill)
        endless.next()
        endless.process.send_signal(signal.SIGINT)
        self.assertIn(endless.end(), (0, -signal.SIGINT), f"{line}: {endless.errors}")

    def is_up(self):
        return self.daemon.run("devices").stdout == "stage  shrc203  UP\nmill  rml1  UP\n"

    def wait_until_up(self):
        deadline = time.monotonic() + LIMIT_S
        while not self.is_up():
            self.assertLess(time.monotonic(), deadline, "the device does not come back")
            time.sleep(0.05)  # between two looks; the deadline above decides

    def test_they_work_in_their_order(self):
        self.assertGreater(len(examples()), 60)
        for line in examples():
            if line.endswith(ENDLESS):
                self.interrupt_one(line)
            else:
                self.run_one(line)
            self.wait_until_up()  # a reset takes a second


if __name__ == "__main__":
    unittest.main(verbosity=2)
