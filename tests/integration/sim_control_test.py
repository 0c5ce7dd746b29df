"""shrc203-sim's control socket, as a person at the simulated device uses it."""

import contextlib
import os
import re
import select
import shlex
import signal
import socket
import stat
import subprocess
import time
import unittest

from shrc203_sim_test import PATIENCE_S, PROGRAM, READY, ROOT, SimulatorTest

README = ROOT / "device" / "shrc203" / "simulator" / "README.md"
CONNECTIONS_MAX = 32  # ControlServer::kConnectionsMax
EMERGENCY = "20,R"  # bit 6 of the status (manual 5) Q:S), and READY


class Person:
    """A connection to the control socket."""

    def __init__(self, path):
        self.socket = socket.socket(socket.AF_UNIX)
        self.socket.settimeout(PATIENCE_S)
        self.socket.connect(str(path))
        self._replies = self.socket.makefile("r", encoding="ascii", newline="\n")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        self._replies.close()
        self.socket.close()

    def send(self, data):
        self.socket.sendall(data)

    def reply(self):
        line = self._replies.readline()
        if not line.endswith("\n"):
            raise AssertionError(f"the connection ended with {line!r}")
        return line[:-1]

    def say(self, command):
        self.send(command.encode() + b"\n")
        return self.reply()

    def rest(self):
        """What comes until the connection ends, or more than ought to."""
        return self._replies.read(100_000)


class ControlTest(SimulatorTest):
    def setUp(self):
        super().setUp()
        self.control = self.link.with_name("control")

    def start_controlled(self, *arguments):
        return self.start("--control", str(self.control), *arguments)

    def person(self):
        person = Person(self.control)
        self.addCleanup(person.close)
        return person


class TheSocket(ControlTest):
    def test_is_this_users_and_goes_with_the_program(self):
        for number in (signal.SIGTERM, signal.SIGINT):
            simulator = self.start_controlled()
            self.assertIn(f", control socket {self.control}", simulator.banner)
            status = os.stat(self.control)
            self.assertTrue(stat.S_ISSOCK(status.st_mode))
            self.assertEqual(stat.S_IMODE(status.st_mode), 0o600)
            with Person(self.control) as person:
                self.assertEqual(person.say("busy"), "ok no no no")
                self.assertEqual(simulator.end(number), 0)
                self.assertEqual(person.rest(), "")
            self.assertFalse(os.path.lexists(self.control))
            self.assertFalse(os.path.lexists(self.link))

    def test_one_that_is_served_is_left_alone(self):
        self.start_controlled()
        code, line = self.refused("--pty", str(self.link), "--control", str(self.control))
        self.assertEqual(code, 1)
        self.assertIn("another process serves it. End that one", line)
        self.assertEqual(self.person().say("busy"), "ok no no no")
        with self.client() as client:
            self.assertEqual(client.ask("!:"), READY)

    def test_one_of_a_killed_program_is_replaced(self):
        self.start_controlled().end(signal.SIGKILL)
        self.assertTrue(os.path.lexists(self.control))
        self.start_controlled()
        self.assertEqual(self.person().say("busy"), "ok no no no")

    def test_a_file_is_left_alone(self):
        self.control.write_text("precious")
        code, line = self.refused("--pty", str(self.link), "--control", str(self.control))
        self.assertEqual(code, 1)
        self.assertIn("something that is not a socket is already there", line)
        self.assertEqual(self.control.read_text(), "precious")
        self.assertFalse(os.path.lexists(self.link))

    def test_a_path_that_cannot_be(self):
        for path, why in ((self.link.with_name("x" * 120), "longer than 107 characters"),
                          (self.link.with_name("nowhere") / "control", "No such file or directory")):
            code, line = self.refused("--pty", str(self.link), "--control", str(path))
            self.assertEqual(code, 1)
            self.assertIn(why, line)

    def test_another_that_took_its_place_stays(self):
        simulator = self.start_controlled()
        os.unlink(self.control)
        self.control.write_text("another")
        self.assertEqual(simulator.end(), 0)
        self.assertEqual(self.control.read_text(), "another")

    def test_none_without_the_option(self):
        self.start()
        self.assertEqual([name for name in os.listdir(self.link.parent) if name != self.link.name], [])


class AtTheDevice(ControlTest):
    def setUp(self):
        super().setUp()
        self.start_controlled()
        self.at = self.person()
        self.tty = self.client()
        self.addCleanup(self.tty.close)

    def test_what_is_done_there_shows_on_the_line(self):
        for command, question, answer in (
            ("mode MANUAL", "?:MODE", "MANUAL"),
            ("mode HOST", "?:MODE", "HOST"),
            ("dialect HIT", "?:FMT", "HIT"),
            ("dialect SHOT_FC", "?:FMT", "SHOT_FC"),
            ("limit 2 ccw on", "SRQ:2S", "100001,R"),
            ("error 1 scale on", "SRQ:1S", "4,R"),
            ("error 1 scale off", "SRQ:1S", "1,R"),
            ("flag 1 heat on", "SRQ:1S", "2001,R"),
            ("flag 1 heat off", "SRQ:1S", "1,R"),
            ("inputs 21", "I:", "21"),
            ("sleep on", "?:SLEEP", "1"),
            ("sleep off", "?:SLEEP", "0"),
            ("excitation 3 off", "?:C", "1,1,0"),
            ("emergency", "SRQ:1S", EMERGENCY),
        ):
            self.assertEqual(self.at.say(command), "ok", command)
            self.assertEqual(self.tty.ask(question), answer, command)

    def test_what_the_line_does_shows_there(self):
        self.assertEqual(self.tty.ask("O:42"), "OK")
        self.assertEqual(self.at.say("outputs"), "ok 42")
        self.assertEqual(self.tty.ask("T:M"), "OK")
        self.assertEqual(self.at.say("triggers"), "ok 1")
        self.assertEqual(self.tty.ask("M:1+P100"), "OK")
        self.assertEqual(self.tty.ask("G:1"), "OK")
        self.await_true(lambda: self.at.say("busy 1") == "ok no")
        self.assertEqual(self.at.say("position"), "ok 100 0 0")

    def test_a_move_is_stopped_and_nothing_is_told(self):
        self.assertEqual(self.tty.ask("MP:1+P1000000"), "OK")
        self.assertEqual(self.tty.ask("G:1"), "OK")
        self.await_true(lambda: self.at.say("position 1") != "ok 0")
        self.assertEqual(self.at.say("emergency"), "ok")
        where = self.at.say("position 1")
        self.assertEqual(self.tty.ask("SRQ:1S"), EMERGENCY)
        self.assertEqual(self.at.say("position 1"), where)
        self.assertEqual(self.at.say("busy"), "ok no no no")

    # Manual 58) WI:, ended by the inputs: the completion of what follows comes though nothing was sent.
    def test_what_follows_by_itself_is_told(self):
        self.assertEqual(self.tty.ask("WI:1,5"), "OK")
        self.assertEqual(self.tty.ask("G:1"), "OK")
        self.assertEqual(self.tty.ask("MP:1+P10"), "OK_D")
        self.assertEqual(self.at.say("inputs 5"), "ok")
        self.assertEqual(self.tty.line(), "1")
        self.assertEqual(self.at.say("position 1"), "ok 10")

    def seconds_until_an_answer(self, command):
        """From before `command` until a question is answered that is asked again and again."""
        began = time.monotonic()
        self.assertEqual(self.at.say(command), "ok")
        while True:
            self.assertLess(time.monotonic() - began, PATIENCE_S)
            self.tty.send(b"!:\r\n")
            if select.select([self.tty.fd], [], [], 0.01)[0]:
                return time.monotonic() - began

    def test_unplugged(self):
        self.assertGreaterEqual(self.seconds_until_an_answer("unplug 0.4"), 0.4)
        self.assertEqual(self.tty.line(), READY)

    def test_stuck(self):
        self.assertGreaterEqual(self.seconds_until_an_answer("stuck 0.4"), 0.4)

    def test_delay(self):
        self.assertEqual(self.at.say("delay 300"), "ok")
        began = time.monotonic()
        self.assertEqual(self.tty.ask("!:"), READY)
        self.assertGreaterEqual(time.monotonic() - began, 0.3)

    def test_power_cycle(self):
        self.assertGreaterEqual(self.seconds_until_an_answer("power cycle"), 1.0)

    def test_bad_input_changes_nothing_and_says_what_is_allowed(self):
        self.assertEqual(self.at.say("limit 1 up on"),
                         "error: 'up' cannot be used as cw|ccw; say: limit AXIS cw|ccw on|off (AXIS 1 to 3)")
        self.assertTrue(self.at.say("emergency!").startswith("error: there is no command 'emergency!'; say one of: "))
        self.assertTrue(self.at.say("\x00\x1b[2J").startswith("error: there is no command '\\x00\\x1B[2J'; "))
        self.assertTrue(self.at.say("").startswith("error: the line is empty; "))
        self.assertEqual(self.tty.ask("SRQ:1S"), "1,R")

    def test_help(self):
        usages = self.at.say("help").removeprefix("ok ").split("; ")
        self.assertIn("limit AXIS cw|ccw on|off", usages)
        for usage in usages:
            self.assertTrue(self.at.say(f"help {usage.split()[0]}").startswith(f"ok {usage}"), usage)

    def test_the_readmes_command_runs(self):
        function = re.search(r"^    (at_the_device\(\) \{.*\})$", README.read_text(encoding="utf-8"), re.MULTILINE)[1]
        for words, expected in ((["limit", "1", "cw", "on"], "ok\n"), (["position", "1"], "ok 0\n")):
            command = f"{function}; at_the_device {shlex.quote(str(self.control))} {shlex.join(words)}"
            result = subprocess.run(["bash", "-c", command], capture_output=True, text=True, timeout=PATIENCE_S,
                                    check=True)
            self.assertEqual(result.stdout, expected)
        self.assertEqual(self.tty.ask("SRQ:1S"), "80001,R")


class ItsOwnTime(ControlTest):
    def test_seconds_are_the_devices(self):
        self.start_controlled("--speed", "1000")
        with self.client() as tty:
            self.assertEqual(self.person().say("stuck 3000"), "ok")
            began = time.monotonic()
            self.assertEqual(tty.ask("!:"), READY)
            self.assertGreater(time.monotonic() - began, 1.0)


class ManyPeople(ControlTest):
    def setUp(self):
        super().setUp()
        self.simulator = self.start_controlled()

    def test_lines_come_in_any_pieces(self):
        person = self.person()
        person.send(b"busy 1\nposition 2\r\n\nbu")
        self.assertEqual([person.reply() for _ in range(2)], ["ok no", "ok 0"])
        self.assertTrue(person.reply().startswith("error: the line is empty"))
        person.send(b"sy 3\n")
        self.assertEqual(person.reply(), "ok no")

    def test_whoever_sends_no_more_gets_the_replies_that_are_due(self):
        person = self.person()
        person.send(b"busy 1\nposition 2\nemergency")
        person.socket.shutdown(socket.SHUT_WR)
        self.assertEqual(person.rest(), "ok no\nok 0\n"
                         "error: the last line has no end; end each line with a line feed\n")
        with self.client() as tty:
            self.assertEqual(tty.ask("SRQ:1S"), "1,R")

    def test_a_line_without_end_costs_one_reply(self):
        person = self.person()
        person.send(b"busy " + b"1" * 1_000_000 + b"\nbusy 1\n" + b" " * 194 + b"busy 2\n" + b" " * 195 + b"busy 3\n")
        self.assertTrue(person.reply().startswith("error: the line is longer than 200 characters; "))
        self.assertEqual(person.reply(), "ok no")
        self.assertEqual(person.reply(), "ok no")
        self.assertTrue(person.reply().startswith("error: the line is longer than 200 characters; "))

    def test_the_silent_and_the_slow_hold_nobody_up(self):
        silent, half, slow = self.person(), self.person(), self.person()
        half.send(b"emerg")
        slow.socket.setblocking(False)
        # Until it takes no more: it waits for its replies to be read, and has as many commands as the kernel keeps.
        limit = time.monotonic() + PATIENCE_S
        sent = 0
        with contextlib.suppress(BlockingIOError):
            while select.select([], [slow.socket], [], 1.0)[1]:
                self.assertLess(time.monotonic(), limit, "it takes whatever comes")
                sent += slow.socket.send(b"help\n" * 1000)
        self.assertGreater(sent, 0)
        lively = self.person()
        with self.client() as tty:
            for _ in range(100):
                self.assertEqual(lively.say("busy 1"), "ok no")
                self.assertEqual(tty.ask("!:"), READY)
        self.assertEqual(silent.say("busy 1"), "ok no")
        half.send(b"ency\n")
        self.assertEqual(half.reply(), "ok")
        slow.socket.settimeout(PATIENCE_S)
        for _ in range(100):
            self.assertTrue(slow.reply().startswith("ok help"))
        slow.close()
        self.assertEqual(lively.say("busy 1"), "ok no")
        self.assertEqual(self.simulator.end(), 0)

    def test_leaked_connections_keep_nobody_out(self):
        leaked = [self.person() for _ in range(CONNECTIONS_MAX)]
        for person in [*leaked, leaked[0]]:
            self.assertEqual(person.say("busy 1"), "ok no")
        last = self.person()
        self.assertEqual(last.say("busy 1"), "ok no")
        self.assertEqual(leaked[1].rest(), "", "the one that has been silent for longest was closed")
        for person in (leaked[0], *leaked[2:]):
            self.assertEqual(person.say("busy 1"), "ok no")

    def test_many_come_and_go(self):
        before = len(os.listdir(f"/proc/{self.simulator.process.pid}/fd"))
        for number in range(500):
            with Person(self.control) as person:
                person.send(b"position\nhelp\n" if number % 2 else b"posi")
        self.assertEqual(self.person().say("busy 1"), "ok no")
        self.await_true(lambda: len(os.listdir(f"/proc/{self.simulator.process.pid}/fd")) == before + 1)


if __name__ == "__main__":
    unittest.main()
