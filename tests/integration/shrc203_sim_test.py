"""shrc203-sim as a program that opens its terminal sees it. Runs the binary in $AXISGATE_BIN, or in build/bin."""

import array
import fcntl
import os
import select
import signal
import stat
import subprocess
import tempfile
import termios
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = Path(os.environ.get("AXISGATE_BIN", ROOT / "build" / "bin")) / "shrc203-sim"
PATIENCE_S = 20.0  # only a failing test waits so long
IDN = "SIGMAKOKI,SHRC-203,2106001001,V2.00.000"  # manual 1) *IDN?
READY = "R"  # manual 2) !:


class Client:
    """A program on the tty that sets no mode of its own, so that an echo would show."""

    def __init__(self, path):
        self.fd = os.open(path, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
        self.unread = b""

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        os.close(self.fd)

    def send(self, data):
        limit = time.monotonic() + PATIENCE_S
        while data:
            try:
                data = data[os.write(self.fd, data):]
            except BlockingIOError:  # Linux refuses while the tty's settings are being changed at its other end
                if time.monotonic() > limit:
                    raise
                select.select([], [self.fd], [], 0.01)

    def line(self):
        limit = time.monotonic() + PATIENCE_S
        while b"\r\n" not in self.unread:
            ready, _, _ = select.select([self.fd], [], [], max(0.0, limit - time.monotonic()))
            if not ready:
                raise AssertionError(f"no line came, only {self.unread!r}")
            try:
                got = os.read(self.fd, 4096)
            except BlockingIOError:  # a flush has come between
                continue
            if not got:
                raise AssertionError("the simulator has ended")
            self.unread += got
        line, self.unread = self.unread.split(b"\r\n", 1)
        return line.decode()

    def ask(self, command):
        self.send(command.encode() + b"\r\n")
        return self.line()

    def waiting(self):
        count = array.array("i", [0])
        fcntl.ioctl(self.fd, termios.FIONREAD, count)
        return count[0]


class Simulator:
    def __init__(self, link, *arguments):
        self.link = link
        self.process = subprocess.Popen(
            [str(PROGRAM), "--pty", str(link), *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
        self.banner = self.process.stdout.readline()

    def end(self, number=signal.SIGTERM):
        self.process.send_signal(number)
        self.process.communicate(timeout=PATIENCE_S)
        return self.process.returncode


class SimulatorTest(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory(prefix="axisgate-sim-")
        self.addCleanup(directory.cleanup)
        self.link = Path(directory.name) / "tty"

    def start(self, *arguments):
        simulator = Simulator(self.link, *arguments)
        self.addCleanup(self.clean_up, simulator.process)
        return simulator

    @staticmethod
    def clean_up(process):
        if process.poll() is None:
            process.kill()
        process.communicate()

    def client(self):
        return Client(self.link)

    def await_true(self, condition):
        limit = time.monotonic() + PATIENCE_S
        while not condition():
            self.assertLess(time.monotonic(), limit, "did not become true")
            time.sleep(0.001)

    def refused(self, *arguments):
        result = subprocess.run([str(PROGRAM), *arguments], capture_output=True, text=True, timeout=PATIENCE_S)
        self.assertEqual(result.stdout, "")
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        return result.returncode, result.stderr


class StartAndEnd(SimulatorTest):
    def test_says_where_it_is_and_takes_its_link_away(self):
        for number in (signal.SIGTERM, signal.SIGINT):
            simulator = self.start()
            device = os.readlink(self.link)
            self.assertRegex(device, r"^/dev/pts/\d+$")
            self.assertTrue(simulator.banner.startswith(f"SHRC-203 simulator on {self.link} ({device}), "))
            self.assertTrue(stat.S_ISCHR(os.stat(self.link).st_mode))
            self.assertEqual(simulator.end(number), 0)
            self.assertFalse(os.path.lexists(self.link))

    def test_takes_over_the_link_of_a_killed_one(self):
        first = self.start()
        first.end(signal.SIGKILL)
        self.assertTrue(os.path.islink(self.link))
        self.start()
        with self.client() as client:
            self.assertEqual(client.ask("*IDN?"), IDN)

    def test_leaves_a_file_alone(self):
        self.link.write_text("precious")
        code, line = self.refused("--pty", str(self.link))
        self.assertEqual(code, 1)
        self.assertIn("something that is not a symbolic link is already there", line)
        self.assertEqual(self.link.read_text(), "precious")

    def test_a_wrong_option_is_one_line_that_names_the_right_ones(self):
        for setting, expected in (
            ("busy_scope=some", "axis, controller"),
            ("colour=red", "busy_scope"),
            ("busy_scope", "NAME=VALUE"),
        ):
            code, line = self.refused("--pty", str(self.link), "--option", setting)
            self.assertEqual(code, 2)
            self.assertIn(expected, line)
            self.assertFalse(os.path.lexists(self.link))

    def test_wrong_arguments(self):
        for arguments in ((), ("--pty", "x", "--baud", "fast"), ("--pty", "x", "--speed", "0"), ("--noise",)):
            code, _ = self.refused(*arguments)
            self.assertEqual(code, 2, arguments)

    def test_lists_its_options(self):
        result = subprocess.run([str(PROGRAM), "--list-options"], capture_output=True, text=True, timeout=PATIENCE_S)
        self.assertEqual(result.returncode, 0)
        self.assertIn("busy_scope=axis|controller\n", result.stdout)
        self.assertIn("stop_keeps_prebuffer=cleared|kept|starts_next\n", result.stdout)


class OnTheLine(SimulatorTest):
    def test_answers_and_echoes_nothing(self):
        self.start()
        with self.client() as client:
            self.assertEqual(client.ask("*IDN?"), IDN)
            self.assertEqual(client.ask("!:"), READY)

    def test_another_unit(self):
        self.start("--serial-number", "2106001002")
        with self.client() as client:
            self.assertEqual(client.ask("*IDN?"), IDN.replace("2106001001", "2106001002"))

    def test_takes_several_lines_in_one_write_with_any_end_of_line_and_case(self):
        self.start()
        with self.client() as client:
            client.send(b"*idn?\r!:\n*IDN?\r\n!:\r\n")
            self.assertEqual([client.line() for _ in range(4)], [IDN, READY, IDN, READY])

    def test_a_client_that_does_not_read_holds_nothing_up(self):
        self.start("--baud", "4000000")
        with self.client() as mute:
            for _ in range(40):
                limit = time.monotonic() + PATIENCE_S
                rest = b"*IDN?\r\n" * 100
                while rest:
                    _, room, _ = select.select([], [mute.fd], [], max(0.0, limit - time.monotonic()))
                    self.assertTrue(room, "the simulator stopped reading")
                    rest = rest[os.write(mute.fd, rest) :]
            self.await_true(lambda: mute.waiting() > 3000)
        with self.client() as client:
            self.await_true(lambda: client.waiting() == 0)
            self.assertEqual(client.ask("!:"), READY)

    def test_an_unfinished_line_ends_with_its_client(self):
        self.start()
        with self.client() as client:
            client.send(b"!:\r\n?:C")  # one write: who answers its first line has read the second
            self.assertEqual(client.line(), READY)
        with self.client() as client:
            self.assertEqual(client.ask("*IDN?"), IDN)

    def test_what_a_client_wrote_is_done_though_it_has_gone(self):
        self.start("--speed", "20")
        with self.client() as client:
            client.send(b"M:1+P1000\r\nG:1\r\n")
        positions = []

        def arrived():
            with self.client() as client:
                positions.append(client.ask("Q:").split(",")[0].replace(" ", "").replace("_", ""))
            return positions[-1] in ("+1000", "1000")

        self.await_true(arrived)

    def test_serves_many_clients_one_after_another(self):
        self.start("--baud", "115200")
        for _ in range(50):
            with self.client() as client:
                self.assertEqual(client.ask("*IDN?"), IDN)


class Pace(SimulatorTest):
    def seconds(self, command):
        with self.client() as client:
            began = time.monotonic()
            answer = client.ask(command)
            return time.monotonic() - began, answer

    def test_bytes_take_their_time_on_the_line(self):
        self.start("--baud", "1200")
        took, answer = self.seconds("*IDN?")
        self.assertEqual(answer, IDN)
        # *IDN? and the CR that ends it, the answer and its CR LF, of 10 bits each.
        self.assertGreaterEqual(took, (6 + len(IDN) + 2) * 10 / 1200)

    def test_a_reply_can_be_delayed(self):
        self.start("--reply-delay", "150")
        took, _ = self.seconds("!:")
        self.assertGreaterEqual(took, 0.150)

    def move_seconds(self, *arguments):
        self.start(*arguments)
        with self.client() as client:
            self.assertEqual(client.ask("M:1+P100000"), "OK")
            began = time.monotonic()
            self.assertEqual(client.ask("G:1"), "OK")
            self.await_true(lambda: client.ask("!:") == READY)
            return time.monotonic() - began

    def test_its_time_runs_faster_when_asked(self):
        # 100000 pulses at no more than F 50000 pulses/s take more than two seconds of the simulator's time.
        self.assertLess(self.move_seconds("--speed", "20"), 2.0)

    def test_its_time_runs_true_otherwise(self):
        self.assertGreater(self.move_seconds(), 2.0)


if __name__ == "__main__":
    unittest.main()
