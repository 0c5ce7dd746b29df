#!/usr/bin/env python3
"""Who may do what, as people meet it: tokens, roles and the configuration of both."""

import os
import re
import subprocess
import tempfile
import time
import unittest

from programs import BIN, LIMIT_S, Daemon

CONFIG = """
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "{socket}"

[access]
local = "%s"
admin_commands = [%s]

[[device]]
name = "stage"
connection = "simulated"
"""


class Access(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisctl-access-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.daemon = None

    def start(self, local="operator", admin_commands='"BEC:"'):
        self.daemon = Daemon(self.folder, CONFIG % (local, admin_commands))
        self.addCleanup(lambda: self.daemon.stop())

    def over_tcp(self, *arguments, token=None):
        environment = dict(os.environ)
        environment.pop("AXISGATE_TOKEN", None)
        if token is not None:
            environment["AXISGATE_TOKEN"] = token
        return subprocess.run([BIN / "axisctl", "--target", self.daemon.address(), *arguments], env=environment,
                              capture_output=True, text=True, timeout=LIMIT_S, check=False)

    def make(self, name, *options):
        made = self.daemon.run("token", "create", name, *options)
        self.assertEqual(made.returncode, 0, made.stderr)
        self.assertRegex(made.stdout, rf"\Aaxisgate\.{name}\.[0-9a-f]{{64}}\n\Z")
        return made.stdout.strip()

    def wait_until(self, condition, what):
        deadline = time.monotonic() + LIMIT_S
        while not condition():
            self.assertLess(time.monotonic(), deadline, what)
            time.sleep(0.05)  # between two looks; the deadline above decides

    def refused(self, answer, pattern):
        self.assertEqual(answer.returncode, 3, answer.stdout)
        self.assertRegex(answer.stderr, pattern)

    def test_whoami(self):
        self.start()
        self.assertRegex(self.daemon.run("whoami").stdout, r"\Aunix \S+, admin\n\Z")
        self.assertRegex(self.over_tcp("whoami").stdout, r"\Atcp 127\.0\.0\.1:\d+, operator\n\Z")
        token = self.make("night-scan", "--role", "observer")
        self.assertEqual(self.over_tcp("whoami", token=token).stdout, "token night-scan, observer\n")

    def test_a_token_and_its_end(self):
        self.start()
        token = self.make("night-scan")
        self.assertIn("token night-scan", self.over_tcp("--json", "move", "1=1mm", token=token).stdout)
        self.assertRegex(self.daemon.run("token", "list").stdout, r"\Anight-scan  operator  expires 20\d\d-")
        self.assertEqual(self.daemon.run("token", "revoke", "night-scan").stdout, "night-scan is revoked\n")
        self.refused(self.over_tcp("status", token=token), r"UNAUTHENTICATED: the token \"night-scan\" was revoked \(")
        self.assertRegex(self.daemon.run("token", "list").stdout, r"\Anight-scan  operator  revoked 20\d\d-")

    def test_a_revoked_token_ends_what_it_has_open(self):
        self.start()
        token = self.make("night-scan")
        environment = dict(os.environ, AXISGATE_TOKEN=token)
        jog = subprocess.Popen([BIN / "axisctl", "--target", self.daemon.address(), "jog", "1=+", "--speed", "1mm/s"],
                               env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        watch = subprocess.Popen([BIN / "axisctl", "--target", self.daemon.address(), "watch"], env=environment,
                                 stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        for program in (jog, watch):
            self.addCleanup(program.wait)
            self.addCleanup(program.kill)
        self.wait_until(lambda: "busy yes" in self.daemon.run("status").stdout, "the jog")
        self.assertEqual(self.daemon.run("token", "revoke", "night-scan").stdout, "night-scan is revoked\n")
        for program in (jog, watch):
            _, said = program.communicate(timeout=LIMIT_S)
            self.assertRegex(said, r"revoked")
        self.wait_until(lambda: "busy yes" not in self.daemon.run("status").stdout, "the stage to stand")

    def test_a_token_outlives_the_daemon(self):
        self.start()
        token = self.make("night-scan")
        self.daemon.stop()
        self.start()
        self.assertEqual(self.over_tcp("whoami", token=token).stdout, "token night-scan, operator\n")
        with open(os.path.join(self.folder, "state", "tokens"), encoding="ascii") as file:
            self.assertNotIn(token.rsplit(".", 1)[1], file.read())

    def test_an_observer_sees_and_stops(self):
        self.start()
        token = self.make("guest", "--role", "observer")
        for arguments in (["status"], ["position"], ["stop"], ["lease", "list"], ["estop"]):
            self.assertEqual(self.over_tcp(*arguments, token=token).returncode, 0, arguments)
        for arguments in (["move", "1=1mm"], ["home"], ["exec", "C:11"], ["rearm"], ["lease", "run", "--", "true"]):
            self.refused(self.over_tcp(*arguments, token=token),
                         r"NOT_ALLOWED: \S+ asks for the role operator, and token guest is observer \(")

    def test_only_administrators_make_tokens(self):
        self.start()
        token = self.make("colleague")
        for arguments in (["create", "own", "--role", "admin"], ["list"], ["revoke", "colleague"]):
            self.refused(self.over_tcp("token", *arguments, token=token), "NOT_ALLOWED: .* role admin, and token")

    def test_locals_may_need_a_token(self):
        self.start(local="nobody")
        self.refused(self.over_tcp("status"), r"UNAUTHENTICATED: a caller over TCP needs a token here \(")
        self.refused(self.over_tcp("stop"), r"UNAUTHENTICATED: ")
        token = self.make("colleague")
        self.assertEqual(self.over_tcp("status", token=token).returncode, 0)

    def test_commands_for_administrators_are_configured(self):
        self.start()
        self.refused(self.over_tcp("clear"), "NOT_ALLOWED: ")
        self.refused(self.over_tcp("exec", "BEC:D"), "NOT_ALLOWED: only an administrator may send this command")
        self.assertEqual(self.daemon.run("clear").returncode, 0)
        self.daemon.stop()
        self.start(admin_commands="")
        self.assertEqual(self.over_tcp("clear").returncode, 0)
        self.assertEqual(self.over_tcp("lease", "run", "--take-over", "--", "true").returncode, 0)

    def test_a_wrong_configuration_names_its_lines(self):
        path = os.path.join(self.folder, "wrong.toml")
        with open(path, "w", encoding="ascii") as file:
            file.write('[access]\nlocal = "everybody"\nadmin_commands = ["BEC"]\n[access.roles]\nalice = "admin"\n'
                       '"unix bert" = "boss"\n[[device]]\nname = "stage"\nconnection = "simulated"\n')
        checked = subprocess.run([BIN / "axisgated", "--config", path, "--check-config"], capture_output=True,
                                 text=True, timeout=LIMIT_S, check=False)
        self.assertEqual(checked.returncode, 2)
        said = re.sub(r"(?m)^\S*wrong\.toml", "wrong.toml", checked.stderr).splitlines()
        self.assertEqual(len(said), 4, checked.stderr)
        self.assertRegex(said[0], r'wrong.toml:2: access.local: "everybody" is not known; use one of "nobody", ')
        self.assertRegex(said[1], r'wrong.toml:3: access.admin_commands: "BEC" is not one of them; use some of "BEC:"')
        self.assertRegex(said[2], r'wrong.toml:5: access.roles.alice: is neither "unix LOGIN"')
        self.assertRegex(said[3], r'wrong.toml:6: access.roles.unix bert: "boss" is not known; ')


if __name__ == "__main__":
    unittest.main()
