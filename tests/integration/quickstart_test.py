#!/usr/bin/env python3
"""deploy/quickstart.sh: what it says where a port is taken, and that it builds what the documentation uses."""

import os
import pathlib
import re
import resource
import socket
import subprocess
import unittest

from programs import LIMIT_S, ROOT

SCRIPT = ROOT / "deploy" / "quickstart.sh"
# A pipe of the kernel holds 64 KiB, and the kernel's table of sockets has 150 bytes for each.
LISTENERS = 900


def run_function(command):
    """Runs a function of the script, whose last line is what starts it."""
    source = "".join(SCRIPT.read_text(encoding="utf-8").splitlines(keepends=True)[:-1])
    return subprocess.run(["bash", "-c", f"source /dev/stdin\n{command}"], input=source, capture_output=True, text=True,
                          timeout=LIMIT_S, check=False)


class Ports(unittest.TestCase):
    def listen(self):
        listener = socket.socket()
        self.addCleanup(listener.close)
        listener.bind(("127.0.0.1", 0))
        listener.listen()
        return listener.getsockname()[1]

    def test_a_taken_port_is_named_and_its_program(self):
        port = self.listen()
        answer = run_function(f"require_free_port {port} gRPC")
        self.assertEqual(answer.returncode, 1, answer)
        own = pathlib.Path("/proc/self/comm").read_text(encoding="utf-8").strip()
        self.assertEqual(answer.stderr,
                         f"quickstart: port {port} (gRPC) is taken by {own} (process {os.getpid()}). End it and try "
                         "again, or start build/bin/axisgated with a configuration that names other ports.\n")

    def test_so_is_one_at_the_head_of_a_long_table(self):
        before = resource.getrlimit(resource.RLIMIT_NOFILE)
        resource.setrlimit(resource.RLIMIT_NOFILE, (max(before[0], 2 * LISTENERS), before[1]))
        self.addCleanup(resource.setrlimit, resource.RLIMIT_NOFILE, before)
        ports = {self.listen() for _ in range(LISTENERS)}
        table = pathlib.Path("/proc/net/tcp").read_text(encoding="utf-8")
        listed = (int(number, 16) for number in re.findall(r":([0-9A-F]{4}) 00000000:0000 0A ", table))
        first = next(port for port in listed if port in ports)
        answer = run_function(f"require_free_port {first} gRPC")
        self.assertEqual(answer.returncode, 1, answer)
        self.assertIn(f"port {first} (gRPC) is taken by ", answer.stderr)

    def test_a_free_port_is_none_of_its_business(self):
        with socket.socket() as bound:  # nobody else takes it, and nobody listens
            bound.bind(("127.0.0.1", 0))
            answer = run_function(f"require_free_port {bound.getsockname()[1]} gRPC")
        self.assertEqual((answer.returncode, answer.stderr), (0, ""))


class Programs(unittest.TestCase):
    def test_it_builds_what_the_documentation_uses(self):
        built = run_function('printf "%s\\n" "${programs[@]}"').stdout.split()
        pages = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
        used = {name for page in pages for name in re.findall(r"build/bin/([\w-]+)", page.read_text(encoding="utf-8"))}
        self.assertLessEqual({"axisgated", "axisctl", "rml1-sim"}, used)
        self.assertLessEqual(used, set(built))


if __name__ == "__main__":
    unittest.main(verbosity=2)
