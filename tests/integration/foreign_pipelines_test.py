"""Programs that write without waiting for answers, that do not read them, or that ask as fast as they can."""

import socket
import termios
import time
import unittest

from foreign_program import MOVES, STANDS, ForeignProgramTest, serial_mode
from shrc203_sim_test import IDN, PATIENCE_S

MODEL = "SHRC-203"  # manual 30) ?:N
AT_ZERO = "+        0,+        0,+        0,K,K,R"  # manual 4) Q:


class Pipelines(ForeignProgramTest):
    def test_replies_are_read_meanwhile(self):
        self.start()
        program = self.program()
        got = program.exchange(b"?:N\r\nq:\r!:\n" * 2000, 6000)
        self.assertEqual(got, [MODEL, AT_ZERO, STANDS] * 2000)
        self.assert_nothing_else(program)

    def test_replies_are_read_afterwards(self):
        for arguments in ((), ("--baud", "4000000")):
            with self.subTest(arguments):
                simulator = self.start(*arguments)
                program = self.program()
                program.send(b"Q:\r\n?:N\r\n" * 2000)
                self.assertEqual(program.lines(4000), [AT_ZERO, MODEL] * 2000)
                self.assert_nothing_else(program)
                self.end(program)
                simulator.end()

    def test_settings_and_starts_in_one_write(self):
        self.start("--speed", "20")
        program = self.program()
        program.send(b"D:1S1000F50000R100\r\n?:D1\r\nM:1+P1000\r\n?:M1\r\nG:1\r\n!:\r\nM:1+P5\r\nL:1\r\n")
        # Busy: no further setting (manual 67) M:).
        self.assertEqual(program.lines(8), ["OK", "S1000F50000R100", "OK", "1000", "OK", MOVES, "NG", "OK"])
        program.wait_until_ready()

    def test_an_answer_late_by_200_ms_does_not_disturb_the_order(self):
        self.start("--reply-delay", "200")
        program = self.program()
        program.send(b"?:N\r\n!:\r\nXX:\r\n" * 300)
        self.assertEqual(program.lines(900), [MODEL, STANDS, "NG"] * 300)


class UnreadReplies(ForeignProgramTest):
    def setUp(self):
        super().setUp()
        self.control = self.link.with_name("control")
        self.moves = 0

    def position(self):
        """Where axis 1 stands, as told beside the line."""
        with socket.socket(socket.AF_UNIX) as at_the_device:
            at_the_device.settimeout(PATIENCE_S)
            at_the_device.connect(str(self.control))
            at_the_device.sendall(b"position 1\n")
            return at_the_device.makefile().readline().strip()

    def write_unread(self, program, data):
        """All of it has been carried out afterwards."""
        program.send(data + b"M:1+P1\r\nG:1\r\n")
        self.moves += 1
        self.await_true(lambda: self.position() == f"ok {self.moves}")

    def test_flushed_and_gone_on(self):
        self.start("--control", str(self.control))
        program = self.program()
        for lines in (100, 500, 5000):
            with self.subTest(lines):
                self.write_unread(program, b"*IDN?\r\n" * lines)
                program.flush()
                program.wait_until_ready()
                self.assert_nothing_else(program)

    def test_flushed_by_setting_the_mode(self):
        self.start("--control", str(self.control))
        program = self.program()
        self.write_unread(program, b"*IDN?\r\n" * 90)
        self.await_true(lambda: program.waiting() == 90 * 41 + 8)  # with the two OK of a move
        serial_mode(program.fd, when=termios.TCSAFLUSH)
        self.assertEqual(program.ask("?:N"), MODEL)
        self.assert_nothing_else(program)

    def test_more_than_is_kept(self):
        """The oldest megabyte is kept, and of the others no part."""
        self.start("--control", str(self.control))
        program = self.program()
        self.write_unread(program, b"*IDN?\r\n" * 40000)
        kept = program.lines(25000)
        program.send(b"?:N\r\n")
        while (line := program.line()) != MODEL:
            kept.append(line)
        self.assertEqual(set(kept), {IDN})
        self.assertLess(len(kept), 30000)
        self.assert_nothing_else(program)

    def test_left_to_a_successor(self):
        self.start("--control", str(self.control))
        first = self.program()
        self.write_unread(first, b"*IDN?\r\n" * 5000)
        self.end(first)
        second = self.program()
        self.await_true(lambda: second.waiting() == 0)
        self.assertEqual(second.ask("?:N"), MODEL)
        self.assert_nothing_else(second)

    def test_a_successor_that_pipelines_at_once(self):
        self.start("--control", str(self.control))
        first = self.program()
        self.write_unread(first, b"*IDN?\r\n" * 5000)
        self.end(first)
        second = self.program()
        self.await_true(lambda: second.waiting() == 0)
        second.send(b"?:N\r\n" * 5000)
        self.assertEqual(second.lines(5000), [MODEL] * 5000)
        self.assert_nothing_else(second)


class Polls(ForeignProgramTest):
    def start_move(self, program):
        self.assertEqual(program.ask("A:W+P30000-P20000+P10000"), "OK")
        self.assertEqual(program.ask("G:"), "OK")

    def test_where_it_is_until_it_stands(self):
        self.start()
        program = self.program()
        self.start_move(program)
        limit = time.monotonic() + PATIENCE_S
        last, polls, state = [0, 0, 0], 0, MOVES
        while state == MOVES:
            self.assertLess(time.monotonic(), limit)
            *fields, error, stop, state = program.ask("Q:").split(",")
            self.assertEqual((error, stop), ("K", "K"))
            self.assertEqual([len(field) for field in fields], [10, 10, 10])
            now = [int(field.replace(" ", "")) for field in fields]
            for axis, direction in enumerate((1, -1, 1)):
                self.assertGreaterEqual(now[axis] * direction, last[axis] * direction)
            last, polls = now, polls + 1
        self.assertEqual((state, last), (STANDS, [30000, -20000, 10000]))
        self.assertGreater(polls, 10)

    def test_whether_it_moves_as_fast_as_it_can(self):
        self.start()
        program = self.program()
        self.start_move(program)
        self.assertGreater(program.wait_until_ready(), 10)
        self.assertEqual(program.coordinates(), [30000, -20000, 10000])

    def test_ahead_of_the_answers(self):
        """Ten questions are always on their way."""
        self.start()
        program = self.program()
        self.start_move(program)
        limit = time.monotonic() + PATIENCE_S
        program.send(b"!:1S\r\n" * 10)
        answers = []
        while not answers or answers[-1] == MOVES:
            self.assertLess(time.monotonic(), limit)
            answers.append(program.line())
            program.send(b"!:1S\r\n")
        moved = len(answers) - 1
        self.assertEqual(answers, [MOVES] * moved + [STANDS])
        self.assertEqual(program.lines(10), [STANDS] * 10)
        self.assert_nothing_else(program)

    def test_each_after_emptying_the_input(self):
        self.start()
        program = self.program()
        self.start_move(program)
        limit = time.monotonic() + PATIENCE_S
        program.flush()
        while (answer := program.ask("!:")) == MOVES:
            self.assertLess(time.monotonic(), limit)
            program.flush()
        self.assertEqual(answer, STANDS)


if __name__ == "__main__":
    unittest.main()
