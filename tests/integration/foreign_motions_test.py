"""What programs do with a stage, in the lines that the manual shows: each asks as fast as it can meanwhile. The
simulator's time runs five times as fast."""

import time
import unittest

from foreign_program import MOVES, STANDS, ForeignProgramTest
from shrc203_sim_test import IDN, PATIENCE_S


class Motions(ForeignProgramTest):
    def setUp(self):
        super().setUp()
        self.start("--speed", "5")
        self.stage = self.program()

    def settings(self, *commands):
        for command in commands:
            self.assertEqual(self.stage.ask(command), "OK", command)

    def wait_for_completions(self, *axes):
        """Asks !: until all of `axes` have told their number and everything stands. Returns the numbers as they came."""
        limit = time.monotonic() + PATIENCE_S
        told, state = [], MOVES
        self.stage.send(b"!:\r\n")
        while state != STANDS or len(told) < len(axes):
            self.assertLess(time.monotonic(), limit, (told, state))
            line = self.stage.line()
            if line in (MOVES, STANDS):
                state = line
                self.stage.send(b"!:\r\n")
            else:
                self.assertIn(line, "123")
                told.append(line)
        self.assertEqual(self.stage.line(), STANDS)
        return told

    def test_the_vendors_way(self):
        """Which axes there are, origin, speeds, a move, a jog, a stop."""
        self.assertEqual([self.stage.ask(f"!:{axis}S") for axis in (1, 2, 3)], ["R", "R", "R"])
        self.settings("H:W")
        self.assertGreater(self.stage.wait_until_ready(), 1)
        self.assertEqual(self.stage.ask("Q:"), "+        0,+        0,+        0,K,K,R")
        self.settings("D:WS2000F20000R200S2000F20000R200S2000F20000R200", "M:W+P100+P100+P100", "G:")
        self.stage.wait_until_ready()
        self.assertEqual(self.stage.ask("Q:"), "+      100,+      100,+      100,K,K,R")
        self.settings("J:W+-+", "G:")
        self.await_true(lambda: self.stage.coordinates()[1] < -100)
        self.settings("L:W")
        self.stage.wait_until_ready()
        x, y, z = self.stage.coordinates()
        self.assertGreater(min(x, z), 300)
        self.assertLess(y, -100)

    def test_the_origin_told_by_each_axis(self):  # manual 60) HRT:
        self.settings("M:W+P1000+P2000+P3000", "G:W")
        self.stage.wait_until_ready()
        self.settings("HRT:W")
        self.assertEqual(sorted(self.wait_for_completions(1, 2, 3)), ["1", "2", "3"])
        self.assertEqual(self.stage.coordinates(), [0, 0, 0])
        self.assert_nothing_else(self.stage)

    def test_a_scan_of_places(self):
        for row, y in enumerate((0, 500, 1000)):
            for x in (0, 700, 1400) if row % 2 == 0 else (1400, 700, 0):
                self.settings(f"A:A+P{x}+P{y}", "G:A")
                self.stage.wait_until_ready()
                self.assertEqual(self.stage.coordinates(), [x, y, 0])
        self.assert_nothing_else(self.stage)

    def test_a_scan_in_micrometres(self):
        for step in range(1, 4):
            self.settings(f"A:W+U{10.0 * step:.2f}-U{5.0 * step:.2f}+U0.00", "G:")
            self.stage.wait_until_ready()
        self.assertEqual(self.stage.ask("Q:SU"), "U+30,U-15,U+0,1,1,1,R,R,R")

    def test_a_jog(self):  # manual 88) J:, 93) JD:
        self.settings("D:1S1000F20000R50", "J:1-", "G:1")
        self.await_true(lambda: self.stage.coordinates()[0] < -200)
        self.settings("JD:1F20000")
        self.await_true(lambda: self.stage.coordinates()[0] < -3000)
        self.assertEqual(self.stage.ask("!:"), MOVES)
        self.settings("L:1")
        self.stage.wait_until_ready()
        stands = self.stage.coordinates()
        self.assertEqual(self.stage.coordinates(), stands)
        self.assertEqual(self.stage.ask("Q:").split(",")[3:], ["K", "K", "R"])

    def test_segments_that_follow_each_other(self):  # manual 68) MP:
        self.assertEqual(self.stage.ask("MP:1+P20000,S1000F20000R100"), "OK")
        self.assertEqual(self.stage.ask("G:1"), "OK")
        self.assertEqual(self.stage.ask("MP:1+P20000"), "OK_D")
        for _ in range(3):
            self.assertEqual(self.stage.line(), "1")
            self.assertEqual(self.stage.ask("MP:1+P20000"), "OK_D")
        self.assertEqual(self.wait_for_completions(1, 1), ["1", "1"])
        self.assertEqual(self.stage.coordinates(), [100000, 0, 0])
        self.assert_nothing_else(self.stage)

    def test_completions_between_the_answers_of_a_poll(self):
        self.settings("MP:W+P5000+P10000+P15000", "G:W")
        self.assertEqual(self.wait_for_completions(1, 2, 3), ["1", "2", "3"])
        self.assertEqual(self.stage.coordinates(), [5000, 10000, 15000])
        self.assert_nothing_else(self.stage)

    def test_a_completion_that_nobody_waits_for(self):
        """A program that reads a reply for each line it writes finds the number where its next reply should be."""
        self.settings("MP:1+P10", "G:1")
        self.await_true(lambda: self.stage.waiting() == 3)
        self.stage.send(b"*IDN?\r\n")
        self.assertEqual(self.stage.lines(2), ["1", IDN])

    def test_circles_that_follow_each_other(self):  # manual 77) EP:0
        self.assertEqual(self.stage.ask("EP:0A0+P4000+P0,S20000F20000R100"), "OK")
        self.assertEqual(self.stage.ask("G:A"), "OK")
        self.assertEqual(self.stage.ask("EP:0A1-P4000+P0,S20000F20000R100"), "OK_D")
        self.assertEqual(self.wait_for_completions(1, 2, 1, 2), ["1", "2", "1", "2"])
        self.assertEqual(self.stage.coordinates(), [0, 0, 0])
        self.assert_nothing_else(self.stage)

    def test_a_circle_of_the_execution_buffer(self):  # manual 71) E:0
        self.settings("D:1S20000F20000R100", "E:0A0M0.05-M0.05", "G:A")
        self.await_true(lambda: max(map(abs, self.stage.coordinates())) > 10000)  # its radius is 7071 pulses of 10 nm
        self.stage.wait_until_ready()
        self.assertEqual(self.stage.coordinates(), [0, 0, 0])

    def test_straight_lines_that_follow_each_other(self):  # manual 84) KP:
        self.assertEqual(self.stage.ask("KP:A+P16000+P12000 ,S20000F20000R100"), "OK")
        self.assertEqual(self.stage.ask("G:A"), "OK")
        self.assertEqual(self.stage.ask("KP:A-P16000-P12000 ,S20000F20000R100"), "OK_D")
        self.assertEqual(self.wait_for_completions(1, 2, 1, 2), ["1", "2", "1", "2"])
        self.assertEqual(self.stage.coordinates(), [0, 0, 0])

    def test_stopped_in_mid_move(self):
        self.settings("M:1+P1000000", "G:1")
        self.await_true(lambda: self.stage.coordinates()[0] > 1000)
        self.assertEqual(self.stage.ask("M:1+P10"), "NG")  # Busy (manual 67) M:)
        self.settings("L:")
        self.stage.wait_until_ready()
        self.assertLess(self.stage.coordinates()[0], 1000000)
        self.settings("M:1+P10")


if __name__ == "__main__":
    unittest.main()
