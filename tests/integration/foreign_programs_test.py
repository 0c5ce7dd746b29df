"""What programs write for a real controller, byte for byte, and what the manual has answered. The binary is that of
$AXISGATE_BIN, or of build/bin."""

import select
import unittest

from foreign_program import ForeignProgramTest
from shrc203_sim_test import IDN

MODEL = "SHRC-203"  # manual 30) ?:N
AT_ZERO = "+        0,+        0,+        0,K,K,R"  # manual 4) Q:


class EndsOfLines(ForeignProgramTest):
    def test_each_alone(self):
        self.start()
        program = self.program()
        for end in (b"\r\n", b"\r", b"\n", b"\n\r", b"\r\r\n"):
            with self.subTest(end):
                program.send(b"*IDN?" + end + b"!:" + end)
                self.assertEqual(program.lines(2), [IDN, "R"])
                self.assert_nothing_else(program)

    def test_mixed_in_one_write(self):
        self.start()
        program = self.program()
        program.send(b"*IDN?\r!:\n?:N\r\n\n\n!:\r\r?:N\n\r")
        self.assertEqual(program.lines(5), [IDN, "R", MODEL, "R", MODEL])
        self.assert_nothing_else(program)

    def test_cr_and_lf_of_one_line_in_two_writes(self):
        self.start()
        program = self.program()
        program.send(b"?:N\r")
        self.assertEqual(program.line(), MODEL)
        program.send(b"\n")
        self.assert_nothing_else(program)

    def test_lines_without_anything_in_them(self):
        self.start()
        program = self.program()
        program.send(b"\r\n\r\n \r\n\t\r\n\n\n\r\r")
        self.assert_nothing_else(program)

    def test_byte_by_byte_with_pauses(self):
        self.start()
        program = self.program()
        for byte in b"M:1+P1000\r":
            self.assertFalse(select.select([program.fd], [], [], 0.002)[0], "answered before its end")
            program.send(bytes([byte]))
        self.assertEqual(program.line(), "OK")
        program.send(b"\n")
        self.assertEqual(program.ask("?:M1"), "1000")

    def test_an_unfinished_line_is_finished_later(self):
        self.start()
        program = self.program()
        program.send(b"!:\r\n?")  # one write: who answers its first line has read the second
        self.assertEqual(program.line(), "R")
        self.assertFalse(program.readable(0.01))
        program.send(b":N\r\n")
        self.assertEqual(program.line(), MODEL)


class LettersAndBlanks(ForeignProgramTest):
    def answers(self, *exchanges):
        self.start()
        program = self.program()
        for command, answer in exchanges:
            with self.subTest(command):
                self.assertEqual(program.ask(command), answer)
        self.assert_nothing_else(program)

    def test_small_letters(self):
        self.answers(
            ("*idn?", IDN), ("?:n", MODEL), ("q:", AT_ZERO), ("!:1s", "R"), ("srq:1s", "1,R"),
            ("q:su", "U+0,U+0,U+0,1,1,1,R,R,R"),
            ("d:1s100f1000r100", "OK"), ("?:d1", "S100F1000R100"), ("m:w+u10+n50+p300", "OK"), ("?:m", "1000,5,300"),
            ("g", "OK"), ("l:w", "OK"),
        )

    def test_mixed_letters(self):
        self.answers(("*Idn?", IDN), ("?:Mode", "HOST"), ("Mp:1+p10,s100F1000r200", "OK"), ("?:mP1", "10"))

    def test_blanks_as_the_manual_prints_them(self):
        self.answers(
            ("* IDN?", IDN),  # manual 1)
            ("Q :", AT_ZERO),  # manual 4)
            ("KP:A+P1000+P200 ,S100F1000R200", "OK"),  # manual 84)
            ("  !:  ", "R"), ("\t?:N\t", MODEL), ("M: 1 + P 1000", "OK"), ("?: M 1", "1000"),
        )

    def test_numbers_as_languages_print_them(self):
        self.answers(
            ("A:1+1000", "OK"), ("?:A1", "1000"),  # without a unit
            ("A:1+P1500.0", "OK"), ("?:A1", "1500"),
            ("A:1-P0002000", "OK"), ("?:A1", "-2000"),
            ("A:W+U10.00-U20.50+M0.05", "OK"), ("?:A", "1000,-2050,5000"),  # 10 nm a pulse
            ("A:1P700", "OK"), ("?:A1", "700"),  # without a sign
        )

    def test_what_is_wrong_is_answered_once(self):
        self.answers(
            ("XX:", "NG"), ("Q", "NG"), ("A:1-P%100", "NG"), ("A:1:+P100", "NG"), ("M:1+P100;G:1", "NG"),
            ("D:1,2000,20000,200", "NG"),  # as the dialect HIT has it
            ("DF:1,100000000", "NG"), ("M:4+P100", "NG"), ("?:MODE?", "NG"), ("Q:", "+        0,+        0,+        0,X,K,R"),
        )


class Garbage(ForeignProgramTest):
    def answers(self, data, *answers):
        self.start()
        program = self.program()
        program.send(data)
        self.assertEqual(program.lines(len(answers)), list(answers))
        self.assert_nothing_else(program)

    def test_what_is_not_ascii(self):  # manual 3.
        self.answers(b"\xff\xfe\r\nM:1+P\xb510\r\n?:M1\r\n", "NG_I", "NG_I", "NS")

    def test_null(self):  # manual 3.
        self.answers(b"\0\r\nQ\0:\r\n!:\r\n", "NG_I", "NG_I", "R")

    def test_a_string_with_the_null_that_ends_it(self):
        self.answers(b"!:\r\n\0!:\r\n!:\r\n", "R", "NG_I", "R")

    def test_control_characters_are_no_blanks(self):
        self.answers(b"\x11!:\r\n!:\x13\r\n\x1b[A\r\n!:\r\n", "NG", "NG", "NG", "R")

    def test_each_byte_as_a_line(self):
        self.start()
        program = self.program()
        program.send(b"".join(bytes([byte]) + b"\r\n" for byte in range(256) if byte not in b"\t\n\r "))
        self.assertEqual(program.lines(252), ["NG_I"] + 123 * ["NG"] + 128 * ["NG_I"])  # G: nothing was set
        self.assert_nothing_else(program)

    def test_a_line_without_end(self):
        self.answers(b"M:1+P" + b"1" * 100000 + b"\r\n?:M1\r\n", "NG", "NS")

    def test_an_unfinished_line_of_one_that_has_gone(self):
        self.start()
        first = self.program()
        first.send(b"!:\r\n" + b"\xff" * 1000)  # one write: who answers its first line has read the second
        self.assertEqual(first.line(), "R")
        self.end(first)
        self.assert_nothing_else(self.program())


if __name__ == "__main__":
    unittest.main()
