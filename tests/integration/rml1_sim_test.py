"""rml1-sim as a sender of jobs and a person at the mill see it. Runs the binary in $AXISGATE_BIN, or in build/bin."""

import json
import os
import pathlib
import re
import signal
import socket
import subprocess
import tempfile
import termios
import time
import tty
import unittest

from programs import BIN, LIMIT_S, ROOT, Lines

PROGRAM = BIN / "rml1-sim"
SPEED = 50  # all times below are the mill's


def vectors(count):
    """Moves with the tool up, each of 0.25 mm on an MDX-20, that lead away from the origin."""
    return b"".join(b"PU%d,0;" % (10 * number) for number in range(1, count + 1))


class Person:
    """A connection to the control socket."""

    def __init__(self, path):
        self._socket = socket.socket(socket.AF_UNIX)
        self._socket.settimeout(LIMIT_S)
        self._socket.connect(str(path))
        self._replies = self._socket.makefile("r", encoding="ascii")

    def close(self):
        self._replies.close()
        self._socket.close()

    def say(self, command):
        self._socket.sendall(command.encode() + b"\n")
        return self._replies.readline().rstrip("\n")

    def state(self):
        reply = self.say("state")
        if not reply.startswith("ok "):
            raise AssertionError(reply)
        return dict(field.split("=") for field in reply[3:].split())

    def await_state(self, **expected):
        limit = time.monotonic() + LIMIT_S
        while True:
            state = self.state()
            if all(state[name] == value for name, value in expected.items()):
                return state
            if time.monotonic() > limit:
                raise AssertionError(f"{state} did not become {expected}")
            time.sleep(0.002)  # between two looks; the limit above decides


class LinkLine(unittest.TestCase):
    def test_it_has_no_parser_of_the_gateway(self):
        """Or a mistake of the check would agree with itself."""
        names = subprocess.run(["nm", "--demangle", PROGRAM], capture_output=True, text=True, check=True).stdout
        self.assertIn("rml1::simulator::Reader::", names, "nm shows what is linked")
        for part in ("Parser", "Machine", "Clip", "AxesReader"):
            self.assertNotIn(f" axisgate::rml1::{part}::", names)


class Terminal:
    """The mill's terminal, raw, with or without XON/XOFF; writes do not wait."""

    def __init__(self, path, xon):
        self.fd = os.open(path, os.O_RDWR | os.O_NOCTTY)
        tty.setraw(self.fd)
        self.set_xon(xon)
        os.set_blocking(self.fd, False)

    def set_xon(self, xon):
        settings = termios.tcgetattr(self.fd)
        settings[0] = settings[0] | termios.IXON if xon else settings[0] & ~termios.IXON
        termios.tcsetattr(self.fd, termios.TCSANOW, settings)

    def close(self):
        os.close(self.fd)

    def await_stopped(self):
        """Until the terminal takes no byte: XOFF comes a moment after the mill has written it."""
        for _ in range(2000):  # far fewer than the kernel's own queue takes
            try:
                os.write(self.fd, b";")
            except BlockingIOError:
                return
            time.sleep(0.001)  # between two tries; the count above decides
        raise AssertionError("the terminal was not stopped")

    def send(self, data):
        limit = time.monotonic() + LIMIT_S
        while data:
            try:
                data = data[os.write(self.fd, data):]
            except BlockingIOError:
                if time.monotonic() > limit:
                    raise
                time.sleep(0.002)  # between two tries; the limit above decides


class MillTest(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory(prefix="axisgate-mill-")
        self.addCleanup(directory.cleanup)
        self.folder = pathlib.Path(directory.name)
        self.link = self.folder / "mill"
        self.control = self.folder / "control"
        self.record = self.folder / "record"

    def start(self, *arguments, where=None):
        mill = Lines([PROGRAM, *(where or ["--pty", self.link]), "--profile", "mdx-20", "--control", self.control,
                      "--record", self.record, "--speed", str(SPEED), *arguments])
        self.addCleanup(mill.kill)
        self.banner = mill.next()
        return mill

    def person(self):
        person = Person(self.control)
        self.addCleanup(person.close)
        return person

    def terminal(self, xon=False):
        terminal = Terminal(self.link, xon)
        self.addCleanup(terminal.close)
        return terminal

    def recorded(self, key):
        whole = self.record.read_text().rpartition("\n")[0]
        return [line for line in map(json.loads, whole.splitlines()) if key in line]


    def await_recorded(self, key, count):
        limit = time.monotonic() + LIMIT_S
        while len(self.recorded(key)) < count:
            self.assertLess(time.monotonic(), limit, self.record.read_text())
            time.sleep(0.002)  # between two looks; the limit above decides


class StartAndEnd(MillTest):
    def test_says_where_it_is_and_takes_its_files_away(self):
        mill = self.start()
        self.assertRegex(self.banner, rf"^MDX-20 simulator on {re.escape(str(self.link))} \(/dev/pts/\d+\), 9600 baud, ")
        mill.process.send_signal(signal.SIGTERM)
        self.assertEqual(mill.process.wait(LIMIT_S), 0)
        self.assertFalse(os.path.lexists(self.link))
        self.assertFalse(os.path.lexists(self.control))

    def test_wrong_arguments(self):
        for arguments, expected in (
            (["--profile", "mdx-20"], "--pty LINK or --tcp PORT is required"),
            (["--pty", self.link], "--profile P is required"),
            (["--pty", self.link, "--tcp", "0", "--profile", "mdx-20"], "excludes"),
            (["--pty", self.link, "--profile", "mdx-21"], 'there is no profile "mdx-21"; use mdx-15, '),
            (["--pty", self.link, "--profile", "mdx-20", "--flow", "dtr"], "dtr not in {none,xon,rts}"),
            (["--pty", self.link, "--profile", "mdx-20", "--option", "escape_k=C"], "Give one of: toggle, one-shot"),
            (["--pty", self.link, "--profile", "mdx-20", "--option", "colour=red"], "Name one of: escape_k, "),
        ):
            mill = Lines([PROGRAM, *arguments])
            self.assertEqual(mill.end(), 2)
            self.assertIn(expected, mill.errors)
            self.assertEqual(mill.errors.count("\n"), 1, mill.errors)

    def test_a_record_that_cannot_be_written_prevents_the_start(self):
        mill = Lines([PROGRAM, "--pty", self.link, "--profile", "mdx-20", "--record", self.folder / "no" / "file"])
        self.assertEqual(mill.end(), 1)
        self.assertIn("No such file or directory", mill.errors)
        self.assertFalse(os.path.lexists(self.link))


class ThePage(MillTest):
    PAGE = (ROOT / "device" / "rml1" / "simulator" / "README.md").read_text()

    def test_lists_every_option(self):
        listed = subprocess.run([PROGRAM, "--list-options"], capture_output=True, text=True, check=True).stdout
        on_page = re.findall(r"^\| `(\w+=[^`]*)` \|", self.PAGE, flags=re.MULTILINE)
        self.assertEqual([option.replace("\\|", "|") for option in on_page], listed.splitlines()[1:])

    def test_lists_every_command_of_the_panel(self):
        self.start()
        usages = self.person().say("help").removeprefix("ok ").split("; ")
        self.assertIn("".join(f"    {usage}\n" for usage in usages), self.PAGE)

    def test_has_an_example_that_works(self):
        self.start()
        [job] = re.findall(r"printf '([^']*)' > /tmp/mill", self.PAGE)
        self.terminal().send(job.encode())
        self.await_recorded("path", 2)
        self.assertEqual(self.person().state()["errors"], "none")


class Jobs(MillTest):
    def test_a_job_is_executed_and_recorded(self):
        self.start()
        person, terminal = self.person(), self.terminal()
        self.assertEqual(person.say("z0 -1000"), "ok")
        # 1000 steps of 0.025 mm; the spindle needs 2 s, the travel of 15 mm/s 25 mm / 15, Z at 2 mm/s 27.5 mm / 2.
        terminal.send(b"PU1000,0;PD;")
        state = person.await_state(z="-100", moving="no")
        self.assertEqual((state["x"], state["tool"], state["spindle"], state["errors"]), ("1000", "down", "6500", "none"))
        self.assertEqual([line["command"] for line in self.recorded("command")], ["PU", "PD"])
        self.assertEqual([line["path"] for line in self.recorded("path")],
                         [[[0, 0, 0], [1000, 0, 0]], [[1000, 0, 0], [1000, 0, -1100]]])
        for line, seconds in zip(self.recorded("path"), (25 / 15, 27.5 / 2)):
            self.assertAlmostEqual(line["t"] - line["began"], seconds, places=5)
        self.assertEqual([line["spindle"] for line in self.recorded("spindle")], [6500])

    def test_slower_is_slower(self):
        self.start("--slower", "20")
        self.terminal().send(b"!MC0;PU1000,0;")
        self.person().await_state(x="1000", moving="no")
        [line] = self.recorded("path")
        self.assertAlmostEqual(line["t"] - line["began"], 1.2 * 25 / 15, places=5)

    def test_bytes_take_their_time_on_the_line(self):
        # 1200 baud are 120 bytes a second. Blanks are executed at once.
        self.start("--baud", "1200")
        began = time.monotonic()
        self.terminal().send(b"!MC0;" + b" " * 1200 + b"PU10,0;")
        self.person().await_state(x="10")
        self.assertGreater((time.monotonic() - began) * SPEED, 10)

    def test_what_a_host_wrote_before_it_left_is_executed(self):
        self.start("--baud", "0")
        terminal = Terminal(self.link, False)
        terminal.send(b"!MC0;PU200,0;")
        terminal.close()
        self.person().await_state(x="200", moving="no")
        self.terminal().send(b"PU300,0;")
        self.person().await_state(x="300", moving="no")


class FlowControl(MillTest):
    JOB = vectors(400)

    def await_overflow(self):
        self.await_recorded("error", 1)
        self.assertEqual(self.recorded("error")[0]["error"], 16)

    def test_xon_loses_nothing_of_a_host_that_obeys(self):
        self.start("--buffer", "64", "--flow", "xon")
        person = self.person()
        self.terminal(xon=True).send(self.JOB)
        state = person.await_state(x="4000", moving="no")
        self.assertEqual(state["errors"], "none")
        self.assertEqual(len(self.recorded("command")), 400)

    def test_xon_does_not_help_a_host_that_ignores_it(self):
        self.start("--buffer", "64", "--flow", "xon")
        terminal = self.terminal(xon=False)
        terminal.send(self.JOB)
        self.await_overflow()
        self.assertIn(b"\x13", os.read(terminal.fd, 100))

    def test_a_host_that_was_stopped_gets_through_by_ignoring_xoff(self):
        self.start("--buffer", "64", "--flow", "xon", "--option", "escape_k=one-shot")
        person = self.person()
        person.say("view")
        terminal = self.terminal(xon=True)
        terminal.send(vectors(10))
        person.await_state(paused="view", buffered="48")
        terminal.await_stopped()
        terminal.set_xon(False)
        terminal.send(b"\x1b.K")
        person.await_state(buffered="0")

    def test_rts_holds_the_host_and_loses_nothing(self):
        self.start("--buffer", "64", "--flow", "rts")
        person = self.person()
        self.terminal().send(self.JOB)
        state = person.await_state(x="4000", moving="no")
        self.assertEqual(state["errors"], "none")

    def test_without_flow_control_a_full_buffer_loses_bytes(self):
        self.start("--buffer", "64", "--baud", "0")
        person = self.person()
        self.terminal().send(self.JOB)
        self.await_overflow()
        person.await_state(buffered="0", moving="no")
        self.assertLess(len(self.recorded("command")), 400)


class SerialServer(MillTest):
    def connect(self):
        port = int(re.search(r"127\.0\.0\.1:(\d+)", self.banner)[1])
        connection = socket.create_connection(("127.0.0.1", port), LIMIT_S)
        self.addCleanup(connection.close)
        return connection

    def test_one_host_after_another(self):
        self.start("--baud", "0", where=["--tcp", "0"])
        person = self.person()
        first = self.connect()
        first.sendall(b"!MC0;PU100,0;")
        person.await_state(x="100", moving="no")
        second = self.connect()
        second.sendall(b"PU200,0;")
        first.close()
        person.await_state(x="200", moving="no")

    def test_the_server_keeps_the_flow_control_to_itself(self):
        for flow in ("xon", "rts"):
            mill = self.start("--buffer", "64", "--flow", flow, where=["--tcp", "0"])
            person = self.person()
            connection = self.connect()
            connection.sendall(vectors(400))
            state = person.await_state(x="4000", moving="no")
            self.assertEqual(state["errors"], "none")
            connection.setblocking(False)
            self.assertRaises(BlockingIOError, connection.recv, 1)
            mill.process.terminate()
            mill.process.wait(LIMIT_S)


class AtTheMill(MillTest):
    def test_view_cover_stop_and_power(self):
        self.start("--option", "view_takes_effect=at-once", "--option", "pause_position=stays")
        person, terminal = self.person(), self.terminal()
        person.say("view")
        job = b"!MC0;" + b"PU8000,0;PU0,0;" * 50
        terminal.send(job)
        person.await_state(buffered=str(len(job)))
        person.say("view")
        person.await_state(moving="yes")
        for key in ("view", "cover open"):
            self.assertEqual(person.say(key), "ok")
            held = person.await_state(paused=key.split()[0], moving="no")
            self.assertGreater(float(held["x"]), 0)
            self.assertEqual(person.state()["x"], held["x"])
            self.assertEqual(person.say("view" if key == "view" else "cover closed"), "ok")
            self.assertEqual(person.state()["paused"], "no")
        self.assertEqual(person.say("stop"), "ok")
        self.assertEqual(person.state()["moving"], "no")
        self.assertEqual(person.say("power off"), "ok")
        self.assertEqual(person.state()["power"], "off")
        self.assertEqual(person.say("power on"), "ok")
        self.assertEqual([line["panel"] for line in self.recorded("panel")],
                         ["view", "view released"] * 2 + ["cover open", "cover closed", "stop", "power off", "power on"])

    def test_z1_and_z2_of_the_panel(self):
        self.start()
        person = self.person()
        for command in ("z0 -1000", "z1 -50", "z2 70"):
            self.assertEqual(person.say(command), "ok")
        self.terminal().send(b"!MC0;PD;")
        person.await_state(z="-50", moving="no")
        self.terminal().send(b"PU;")
        person.await_state(z="70", moving="no")


if __name__ == "__main__":
    unittest.main()
