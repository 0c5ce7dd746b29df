"""A program written for a real controller, as shrc203-sim meets it: one that sets the tty up by itself, and has no word
with the simulator but over its line."""

import os
import select
import termios
import time

from shrc203_sim_test import IDN, PATIENCE_S, Client, SimulatorTest

STANDS = "R"  # manual 2) !:
MOVES = "B"

# Places of what tcgetattr returns.
IFLAG, OFLAG, CFLAG, LFLAG, ISPEED, OSPEED, CC = range(7)


def serial_mode(fd, baud=termios.B38400, vmin=1, vtime=0, iflag=0, cflag=0, lflag=0, when=termios.TCSANOW):
    """Raw, 8 data bits, no parity, and the flags given; vtime in tenths of a second."""
    mode = termios.tcgetattr(fd)
    mode[IFLAG] = iflag
    mode[OFLAG] = 0
    mode[CFLAG] = termios.CS8 | termios.CREAD | termios.CLOCAL | cflag
    mode[LFLAG] = lflag
    mode[ISPEED] = mode[OSPEED] = baud
    mode[CC][termios.VMIN] = vmin
    mode[CC][termios.VTIME] = vtime
    termios.tcsetattr(fd, when, mode)


class Program(Client):
    """Raw at 38400 baud with RTS/CTS unless another `mode` is given, which is told the descriptor."""

    def __init__(self, path, mode=lambda fd: serial_mode(fd, cflag=termios.CRTSCTS)):
        super().__init__(path)
        mode(self.fd)

    def lines(self, count):
        return [self.line() for _ in range(count)]

    def readable(self, seconds):
        return bool(select.select([self.fd], [], [], seconds)[0])

    def exchange(self, data, count):
        """Writes `data` and reads `count` lines meanwhile, as a program with a reader of its own does."""
        limit = time.monotonic() + PATIENCE_S
        while data or self.unread.count(b"\r\n") < count:
            left = limit - time.monotonic()
            readable, writable, _ = select.select([self.fd], [self.fd] if data else [], [], max(0.0, left))
            if not readable and not writable:
                raise AssertionError(f"{len(data)} bytes are not taken, and {len(self.unread)} came")
            try:
                if readable:
                    self.unread += os.read(self.fd, 65536)
                if writable:
                    data = data[os.write(self.fd, data[:1000]):]
            except BlockingIOError:  # Linux refuses while the tty's settings are being changed at its other end
                continue
        return self.lines(count)

    def flush(self):
        """As serial libraries empty their input."""
        termios.tcflush(self.fd, termios.TCIFLUSH)
        self.unread = b""

    def wait_until_ready(self):
        """Asks as fast as it can; returns how often."""
        limit = time.monotonic() + PATIENCE_S
        asked = 1
        while (reply := self.ask("!:")) != STANDS:
            if reply != MOVES or time.monotonic() > limit:
                raise AssertionError(f"!: was answered {reply!r} the {asked}th time")
            asked += 1
        return asked

    def coordinates(self):
        """As Q: tells them: sign left, digits right, ten characters (manual 4) Q:)."""
        fields = self.ask("Q:").split(",")
        return [int(field.replace(" ", "")) for field in fields[:3]]


class ForeignProgramTest(SimulatorTest):
    def program(self, *arguments):
        program = Program(self.link, *arguments)
        self.addCleanup(self.end, program)
        return program

    @staticmethod
    def end(program):
        if program.fd is not None:
            program.close()
            program.fd = None

    def assert_nothing_else(self, program):
        """What has come so far was all: the next line answers the next question."""
        self.assertEqual(program.ask("*IDN?"), IDN)
        self.assertFalse(program.readable(0))
        self.assertEqual(program.unread, b"")
