#!/usr/bin/env python3
"""What the daemon says to its service manager, which the test plays; and the unit that systemd would read."""

import configparser
import os
import pathlib
import re
import signal
import socket
import subprocess
import tempfile
import unittest

from programs import BIN, LIMIT_S, ROOT

CONFIG = """
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "{folder}/axisgate.sock"

[[device]]
name = "stage"
connection = "simulated"
"""


class ServiceManager(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-service-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.heard = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self.addCleanup(self.heard.close)
        self.heard.bind(os.path.join(self.folder, "notify"))
        self.heard.settimeout(LIMIT_S)

    def start(self, **environment):
        config = pathlib.Path(self.folder, "axisgate.toml")
        config.write_text(CONFIG.format(folder=self.folder), encoding="utf-8")
        environment = dict(os.environ, STATE_DIRECTORY=os.path.join(self.folder, "state"),
                           NOTIFY_SOCKET=os.path.join(self.folder, "notify"), **environment)
        self.daemon = subprocess.Popen([BIN / "axisgated", "--config", config], env=environment,
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(self.daemon.wait)
        self.addCleanup(self.daemon.kill)

    def hear(self):
        return self.heard.recv(4096).decode()

    def test_ready_then_alive_then_stopping(self):
        self.start(WATCHDOG_USEC="400000")
        self.assertEqual(self.hear(), "READY=1")
        for _ in range(5):
            self.assertEqual(self.hear(), "WATCHDOG=1")
        self.daemon.send_signal(signal.SIGTERM)
        while (said := self.hear()) == "WATCHDOG=1":
            pass
        self.assertRegex(said, r"\ASTOPPING=1\nWATCHDOG_USEC=\d{8}\Z")
        self.assertEqual(self.daemon.wait(LIMIT_S), 0)

    def test_frozen_it_says_nothing_and_abort_ends_it(self):
        self.start(WATCHDOG_USEC="400000")
        while self.hear() != "WATCHDOG=1":
            pass
        self.daemon.send_signal(signal.SIGSTOP)
        self.heard.settimeout(2.0)  # five times as long as a service manager would wait
        with self.assertRaises(TimeoutError):
            while True:  # what was on its way
                self.hear()
        self.daemon.send_signal(signal.SIGABRT)
        self.daemon.send_signal(signal.SIGCONT)
        self.assertEqual(self.daemon.wait(LIMIT_S), -signal.SIGABRT)

    def test_without_a_watchdog_it_only_says_that_it_is_ready(self):
        self.start()
        self.assertEqual(self.hear(), "READY=1")
        self.daemon.send_signal(signal.SIGTERM)
        self.assertRegex(self.hear(), "STOPPING=1")
        self.assertEqual(self.daemon.wait(LIMIT_S), 0)


class Unit(unittest.TestCase):
    def setUp(self):
        parser = configparser.ConfigParser(strict=False, interpolation=None)
        parser.optionxform = str
        parser.read(ROOT / "deploy" / "systemd" / "axisgated.service", encoding="utf-8")
        self.service = parser["Service"]

    def seconds(self, key):
        number, unit = re.fullmatch(r"(\d+)(ms)?", self.service[key]).groups()
        return int(number) / (1000 if unit else 1)

    def test_a_frozen_daemon_runs_again_within_10_s(self):
        self.assertEqual(self.service["Type"], "notify")
        self.assertEqual(self.service["Restart"], "on-failure")
        self.assertLess(sum(self.seconds(key) for key in ("WatchdogSec", "TimeoutAbortSec", "RestartSec")), 10)

    def test_it_may_take_as_long_to_end_as_motions_take(self):
        self.assertGreater(self.seconds("TimeoutStopSec"), 80)

    def test_what_it_starts_can_check_its_configuration(self):
        self.assertTrue(self.service["ExecStart"].endswith("axisgated --config /etc/axisgate/axisgate.toml"))
        checked = subprocess.run([BIN / "axisgated", "--config", ROOT / "deploy" / "axisgate.toml", "--check-config"],
                                 capture_output=True, text=True, timeout=LIMIT_S, check=False)
        self.assertEqual(checked.returncode, 0, checked.stderr)


if __name__ == "__main__":
    unittest.main()
