"""Programs that set the tty up in every way that serial libraries have, and that come and go."""

import fcntl
import os
import subprocess
import termios
import time
import unittest

from foreign_program import ForeignProgramTest, Program, serial_mode
from shrc203_sim_test import IDN, PATIENCE_S, PROGRAM, READY

MODEL = "SHRC-203"  # manual 30) ?:N
NOBODY = 65534


def mode(**settings):
    return lambda fd: serial_mode(fd, **settings)


MODES = {
    "as it is found": lambda fd: None,
    "9600 baud without handshake": mode(baud=termios.B9600),
    "115200 baud": mode(baud=termios.B115200),
    "RTS/CTS": mode(cflag=termios.CRTSCTS),
    "XON/XOFF": mode(iflag=termios.IXON | termios.IXOFF),
    "two stop bits, hang up at the end": mode(cflag=termios.CSTOPB | termios.HUPCL),
    "marked parity errors": mode(iflag=termios.INPCK | termios.PARMRK),
    "no bytes needed, no time": mode(vmin=0, vtime=0),
    "no bytes needed, 100 ms": mode(vmin=0, vtime=1),
    "one byte needed": mode(vmin=1, vtime=0),
    "one byte, then 100 ms between two": mode(vmin=1, vtime=1),
    "many bytes, 100 ms between two": mode(vmin=255, vtime=1),
    "waits until all is sent": mode(when=termios.TCSADRAIN),
    "drops what has come": mode(when=termios.TCSAFLUSH),
}


class Modes(ForeignProgramTest):
    def test_each(self):
        self.start("--speed", "20")
        for name, chosen in MODES.items():
            with self.subTest(name):
                program = self.program(chosen)
                self.assertEqual([program.ask("*IDN?"), program.ask("!:")], [IDN, READY])
                program.send(b"A:1+P100\r\nG:1\r\n")
                self.assertEqual(program.lines(2), ["OK", "OK"])
                program.wait_until_ready()
                program.send(b"A:1+P0\rG:1\r")
                self.assertEqual(program.lines(2), ["OK", "OK"])
                program.wait_until_ready()
                self.assertEqual(program.coordinates(), [0, 0, 0])
                self.end(program)

    def test_line_by_line_without_echo(self):
        """Cooked: the kernel hands whole lines over, and turns the CR of CR LF into nothing."""
        self.start()
        program = self.program(mode(iflag=termios.IGNCR, lflag=termios.ICANON))
        os.set_blocking(program.fd, True)
        for _ in range(100):
            program.send(b"?:N\r\nQ:\r\n")
            self.assertEqual(os.read(program.fd, 4096), MODEL.encode() + b"\n")
            self.assertEqual(os.read(program.fd, 4096), b"+        0,+        0,+        0,K,K,R\n")

    def test_reads_that_end_by_time(self):
        self.start()
        program = self.program(mode(vmin=0, vtime=1))
        os.set_blocking(program.fd, True)
        self.assertEqual(os.read(program.fd, 100), b"")
        program.send(b"!:\r\n")
        self.assertEqual(os.read(program.fd, 100), b"R\r\n")
        self.assertEqual(os.read(program.fd, 100), b"")

    def test_reads_of_a_length(self):
        """Q: has always 38 characters (manual 4) Q:), and CR LF."""
        self.start()
        program = self.program(mode(vmin=40, vtime=0))
        os.set_blocking(program.fd, True)
        for _ in range(100):
            program.send(b"Q:\r\n")
            self.assertTrue(program.readable(PATIENCE_S))
            self.assertEqual(os.read(program.fd, 40), b"+        0,+        0,+        0,K,K,R\r\n")

    def test_reads_byte_by_byte(self):
        self.start()
        program = self.program()
        program.send(b"*IDN?\r\n!:\r\n")
        got = b""
        while not got.endswith(b"R\r\n"):
            self.assertTrue(program.readable(PATIENCE_S))
            got += os.read(program.fd, 1)
        self.assertEqual(got, IDN.encode() + b"\r\nR\r\n")

    def test_modes_changed_in_mid_motion(self):
        self.start()
        program = self.program()
        program.send(b"M:1+P20000\r\nG:1\r\n")
        self.assertEqual(program.lines(2), ["OK", "OK"])
        for chosen in MODES.values():
            chosen(program.fd)
            self.assertRegex(program.ask("!:"), "^[BR]$")
        program.wait_until_ready()
        self.assertEqual(program.coordinates(), [20000, 0, 0])

    def test_all_that_is_done_to_a_port(self):
        self.start()
        program = self.program()
        for _ in range(20):
            termios.tcflush(program.fd, termios.TCIOFLUSH)
            program.send(b"?:N\r\n")
            termios.tcdrain(program.fd)
            self.assertEqual(program.line(), MODEL)
            termios.tcsendbreak(program.fd, 0)
            termios.tcflow(program.fd, termios.TCOOFF)
            termios.tcflow(program.fd, termios.TCOON)
            self.assertEqual(program.ask("!:"), READY)


class ComingAndGoing(ForeignProgramTest):
    def test_opened_and_closed_for_each_command(self):
        self.start("--speed", "20")
        for step in range(1, 101):
            with Program(self.link) as program:
                self.assertEqual(program.ask("M:1+P10"), "OK")
            with Program(self.link) as program:
                self.assertEqual(program.ask("G:1"), "OK")
            with Program(self.link) as program:
                program.wait_until_ready()
                self.assertEqual(program.coordinates(), [10 * step, 0, 0])

    def test_opened_and_closed_without_a_word(self):
        self.start()
        for _ in range(300):
            with Program(self.link):
                pass
        self.assert_nothing_else(self.program())

    def test_a_program_after_another_that_left_a_mess(self):
        self.start()
        for chosen in MODES.values():
            first = self.program(chosen)
            self.assertEqual(first.ask("!:"), READY)
            first.send(b"?:N\r\n" * 100 + b"M:1")
            self.await_true(lambda program=first: program.waiting() == 1000)
            self.end(first)
            second = self.program(lambda fd: None)
            self.await_true(lambda program=second: program.waiting() == 0)
            self.assertEqual(second.ask("?:N"), MODEL)
            self.assert_nothing_else(second)
            self.end(second)

    def test_one_motion_and_two_programs(self):
        self.start()
        first = self.program()
        first.send(b"MP:1+P60000\r\nG:1\r\n")
        self.assertEqual(first.lines(2), ["OK", "OK"])
        self.end(first)
        second = self.program()
        limit = time.monotonic() + PATIENCE_S
        while (line := second.ask("!:")) != "1":  # its completion comes to whoever is there (manual 68) MP:)
            self.assertEqual(line, "B")
            self.assertLess(time.monotonic(), limit)
        self.assertIn(second.line(), "BR")
        second.wait_until_ready()
        self.assertEqual(second.coordinates(), [60000, 0, 0])

    def test_locked_by_flock(self):
        self.start()
        for _ in range(3):
            with Program(self.link) as program:
                fcntl.flock(program.fd, fcntl.LOCK_EX | fcntl.LOCK_NB)
                self.assertEqual(program.ask("!:"), READY)


class Exclusive(ForeignProgramTest):
    """TIOCEXCL keeps out everybody but root, so none of it is root's."""

    ASK_ALONE = """
import fcntl, os, select, sys, termios
fd = os.open(sys.argv[1], os.O_RDWR | os.O_NOCTTY)
fcntl.ioctl(fd, termios.TIOCEXCL)
os.write(fd, b"!:\\r\\n")
assert select.select([fd], [], [], 20)[0]
print(os.read(fd, 100).decode().strip())
"""

    def setUp(self):
        super().setUp()
        self.somebody = {}
        if os.geteuid() == 0:
            self.somebody = {"user": NOBODY, "group": NOBODY}
            os.chown(self.link.parent, NOBODY, NOBODY)

    def start_as_somebody(self):
        try:
            simulator = subprocess.Popen([PROGRAM, "--pty", self.link], stdout=subprocess.PIPE, text=True,
                                         **self.somebody)
        except PermissionError:
            self.skipTest(f"nobody but root can run {PROGRAM}")
        self.addCleanup(self.clean_up, simulator)
        simulator.stdout.readline()

    def ask_alone(self):
        asked = subprocess.run(["/usr/bin/python3", "-c", self.ASK_ALONE, self.link], capture_output=True, text=True,
                               timeout=2 * PATIENCE_S, check=False, **self.somebody)
        self.assertEqual(asked.stderr, "")
        return asked.stdout.strip()

    def opens(self):
        """Whether the name leads to a tty that somebody else may open, too."""
        tried = subprocess.run(["/usr/bin/python3", "-c", "import os, sys; os.open(sys.argv[1], os.O_RDWR | os.O_NOCTTY)",
                                self.link], capture_output=True, timeout=PATIENCE_S, check=False, **self.somebody)
        return tried.returncode == 0

    def test_programs_that_never_give_it_back(self):
        self.start_as_somebody()
        for _ in range(3):
            self.await_true(self.opens)
            self.assertEqual(self.ask_alone(), READY)


if __name__ == "__main__":
    unittest.main()
