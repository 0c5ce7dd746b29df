#!/usr/bin/env python3
"""The state directory: one daemon at a time, nothing that others may write, and revocations that reach the disk late."""

import os
import re
import signal
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
"""


class State(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-state-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.state = os.path.join(self.folder, "state")
        self.config = os.path.join(self.folder, "axisgate.toml")

    def start(self):
        daemon = Daemon(self.folder, CONFIG)
        self.addCleanup(daemon.stop)
        return daemon

    def refused(self, code, pattern):
        """The start of a further daemon, with the same files but a socket of its own."""
        if not os.path.exists(self.config):
            with open(self.config, "w", encoding="utf-8") as file:
                file.write(CONFIG.format(socket=os.path.join(self.folder, "second.sock")))
        ended = subprocess.run([BIN / "axisgated", "--config", self.config], capture_output=True, text=True,
                               env=dict(os.environ, STATE_DIRECTORY=self.state), timeout=LIMIT_S, check=False)
        self.assertEqual(ended.returncode, code, ended.stderr)
        self.assertRegex(ended.stderr, pattern)

    def test_two_daemons_do_not_share_it(self):
        first = self.start()
        self.refused(1, rf"\Aaxisgated: the state directory {re.escape(self.state)} is held by another axisgated "
                        rf"\(process {first.pid}\); end the other one, or give this one [^\n]* STATE_DIRECTORY\n\Z")
        self.assertEqual(first.run("status").returncode, 0)

    def test_a_killed_daemon_leaves_nothing_in_the_way(self):
        first = self.start()
        first.signal(signal.SIGKILL)
        first.exit_code()
        with open(os.path.join(self.state, "generation.new"), "w", encoding="ascii") as file:
            file.write("17")
        second = self.start()
        with open(os.path.join(self.state, "lock"), encoding="ascii") as file:
            self.assertEqual(file.read(), f"{second.pid}\n")

    def test_a_fifo_is_refused_and_not_waited_for(self):
        os.mkdir(self.state, 0o700)
        for name in ("lock", "tokens", "positions", "generation"):
            path = os.path.join(self.state, name)
            os.mkfifo(path, 0o600)
            self.refused(1, rf"{re.escape(path)} is a FIFO, not a regular file; move it away")
            os.remove(path)

    def test_what_others_may_write_is_refused_with_the_command(self):
        os.mkdir(self.state)
        os.chmod(self.state, 0o777)
        self.refused(1, rf"state directory .* by everybody on this machine, .*; chmod go-w {re.escape(self.state)}\n\Z")
        os.chmod(self.state, 0o755)
        os.chmod(self.config, 0o646)
        self.refused(2, rf"axisgate\.toml: .* by everybody on this machine, .*; chmod go-w {re.escape(self.config)}\n\Z")

    def test_a_directory_behind_a_link_is_used(self):
        disk = os.path.join(self.folder, "disk")
        os.mkdir(disk, 0o700)
        os.symlink(disk, self.state)
        daemon = self.start()
        moved = daemon.run("move", "1=+100pulse", "--relative")
        self.assertEqual(moved.returncode, 0, moved.stderr)
        self.assertIn("motion", daemon.run("history").stdout)
        self.assertTrue(os.path.exists(os.path.join(disk, "journal.sqlite")))
        daemon.stop()
        os.chmod(disk, 0o777)
        self.refused(1, rf"state directory {re.escape(disk)} may be written by everybody on this machine, .*; "
                        rf"chmod go-w {re.escape(disk)}\n\Z")

    def test_a_revocation_that_cannot_be_written_is_written_later(self):
        daemon = self.start()
        self.assertEqual(daemon.run("token", "create", "scan").returncode, 0)
        obstacle = os.path.join(self.state, "tokens.new")
        os.mkdir(obstacle)  # stops root, too
        refused = daemon.run("token", "revoke", "scan")
        self.assertNotEqual(refused.returncode, 0)
        self.assertRegex(refused.stderr, r"INTERNAL: the token scan is revoked, but not on disk, .*tokens\.new: File "
                                         r"exists.*; the daemon tries again every few seconds")
        self.assertIn("revoked", daemon.run("token", "list").stdout)
        os.rmdir(obstacle)
        daemon.wait_for_log("revocations of tokens that could not be written are on disk now")
        daemon.stop()
        self.assertRegex(self.start().run("token", "list").stdout, r"\Ascan  \w+  revoked ")


if __name__ == "__main__":
    unittest.main(verbosity=2)
