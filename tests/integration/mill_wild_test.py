#!/usr/bin/env python3
"""Jobs in the shapes that CAM programs are known to write: what `axisctl mill check` says of each, and their time.

The jobs are our own. Feeds are in mm/s; a step of `mdx-15` and `mdx-20` is 0.025 mm, of all others 0.01 mm.
"""

import random
import unittest

from mill_test import Checked, mill, text_of

AT = ("--origin", "0,0,30")
SPIN_UP_S = 2
WORST = 100  # mm/s2: every shipped profile that is used here
SLOWER = 1.5  # and at its high end all ways take so much longer
BYTES_A_SECOND = 960  # 9600 baud, 8N1


class Ways:
    """A job's moves as its author means them: (mm, feed) each, from the place before."""

    def __init__(self, *moves):
        self.moves = moves

    def bounds(self, job, baud=True):
        """Not shorter than distance over feed, by a spindle that needs no time; at most from rest to rest for each move,
        which adds no more than feed / acceleration to it, and behind the last byte of the job."""
        ways = sum(way / feed for way, feed in self.moves)
        ramps = sum(feed / WORST for _, feed in self.moves)
        line = len(job) / BYTES_A_SECOND if baud else 0
        return ways, SLOWER * (ways + ramps) + SPIN_UP_S + line


class Wild(unittest.TestCase):
    def told(self, job, *options, profile="mdx-20"):
        checked = Checked(job, *(options or AT), profile=profile)
        self.assertEqual(checked.errors, "")
        return checked

    def silent(self, job, *options, profile="mdx-20"):
        checked = self.told(job, *options, profile=profile)
        self.assertEqual((checked.told, checked.code), ([], 0))
        return checked

    def takes(self, checked, ways, job, baud=True):
        least, most = ways.bounds(job, baud)
        low, high = checked.summary["seconds"]["low"], checked.summary["seconds"]["high"]
        self.assertLessEqual(least, low + 1e-6)
        self.assertLessEqual(low, high)
        self.assertLessEqual(high, most + 1e-6)
        self.assertAlmostEqual(checked.summary["distance_mm"], sum(way for way, _ in ways.moves), places=3)


FAB_HEAD = "PA;PA;VS4;!VZ4;!PZ0,80;!MC1;"
FAB_END = "PA;PA;!PZ0,2420;PU0,6096;!MC0;"


def fab(end=FAB_END, between="\n"):
    """Two grooves of 10 mm, 0.1 mm deep."""
    lines = ("PU0,0;", "Z0,0,-4;", "Z400,0,-4;", "PU400,0;", "PU400,400;", "Z400,400,-4;", "Z0,400,-4;", "PU0,400;")
    return FAB_HEAD + between.join(lines) + between + end


# From the top at 30 mm to Z2 at 2 mm, and the two grooves with a way of 10 mm between them.
FAB_WAYS = Ways((28, 4), (2.1, 4), (10, 4), (2.1, 4), (10, 15), (2.1, 4), (10, 4), (2.1, 4))


class FabModules(Wild):
    def test_it_is_silent(self):
        checked = self.silent(fab())
        self.assertEqual(checked.summary["final"], {"x": 0, "y": 6096, "z": 1200})
        self.assertEqual(checked.summary["bounds"], {"min": {"x": 0, "y": 0, "z": -4},
                                                     "max": {"x": 400, "y": 6096, "z": 1200}})

    def test_the_way_to_the_far_edge_is_travel(self):
        """PU with Z2 above the top runs X and Y there at PU's own speed (guideline 3-2 PU): 142.4 mm at 15 mm/s."""
        self.takes(self.silent(fab()), Ways(*FAB_WAYS.moves, (28, 4), (142.4, 15)), fab())

    def test_an_origin_away_from_home_makes_it_a_note(self):
        checked = self.told(fab(), "--origin", "10,10,30")
        self.assertEqual([(each["severity"], each["line"], each["column"]) for each in checked.told], [("note", 9, 17)])

    def test_another_machine_is_noticed(self):
        checked = self.told(fab(), profile="srm-20")
        self.assertEqual([(each["severity"], each["offset"]) for each in checked.told],
                         [("warning", fab().index("!PZ0,2420"))])

    def test_an_end_byte(self):
        for job in (fab() + "\x04", "\x04" + fab(), fab() + "\x04" * 50, fab() + "\x1a", fab() + "\0" * 100):
            self.silent(job)

    def test_crlf_and_semicolons_are_the_same_job(self):
        plain = self.silent(fab()).summary
        for job in (fab(between="\r\n"), fab(between=""), fab().replace(";", "\r\n"), fab().lower(),
                    fab().replace(",", " "), fab().replace(",", " , "), fab().replace(";", " ;\t")):
            summary = self.silent(job).summary
            for key in ("final", "bounds", "distance_mm", "spin_ups", "commands"):
                self.assertEqual(summary[key], plain[key])

    def test_no_terminator_at_all(self):
        job = fab(between="").replace(";", "")
        checked = self.told(job)
        self.assertEqual([(each["severity"], each["offset"]) for each in checked.told],
                         [("warning", job.rindex("!MC0"))])
        self.assertEqual(checked.summary["final"], {"x": 0, "y": 6096, "z": 1200})

    def test_a_byte_order_mark(self):
        checked = self.told(b"\xef\xbb\xbf" + fab().encode())
        self.assertEqual(checked.numbers(), [(1, 1, 1)])
        self.assertEqual(checked.summary["final"], {"x": 0, "y": 6096, "z": 1200})

    def test_cad_py_ends_a_thousand_times(self):
        job = fab(end="PA;PA;!PZ0,2420;PU0,0;" + "!MC0;" * 1000)
        checked = self.silent(job)
        self.assertEqual((checked.summary["commands"], checked.summary["spin_ups"]), (6 + 8 + 4 + 1000, 1))
        self.takes(checked, Ways(*FAB_WAYS.moves, (28, 4), (10, 15)), job)


class HeeksCnc(Wild):
    JOB = (";;^IN;!MC0;\nV50.0;^PR;Z0,0,10500;^PA;\n!RC15;\n!MC1;\nV30.0;\nZ1000,2000,10500;\nZ1000,2000,200;\nV5.0;\n"
           "Z1000,2000,-100;\nZ3000,2000,-100;\nV30.0;\nZ3000,2000,500;\n!VZ50.0;!ZM0;\n!MC0;^IN;\n")
    # 10 and 20 mm at the top, 28 and 3 mm down, 20 mm along X, 6 and 25 mm up, the last at Z's own 30 mm/s.
    WAYS = Ways((500 ** .5, 30), (28, 30), (3, 5), (20, 5), (6, 30), (25, 30))

    def test_it_is_silent(self):
        """But for a note: the speed of the spindle stays set."""
        for job in (self.JOB, self.JOB.replace("\n", "\r\n"), self.JOB.replace("\n", "")):
            checked = self.told(job, profile="mdx-40")
            self.assertEqual([(each["severity"], each["offset"]) for each in checked.told],
                             [("note", job.index("!RC15"))])
            self.takes(checked, self.WAYS, job)
            self.assertEqual(checked.summary["final"], {"x": 3000, "y": 2000, "z": 3000})
            self.assertEqual(checked.summary["spin_ups"], 1)

    def test_another_machine_is_noticed(self):
        checked = self.told(self.JOB)
        self.assertEqual([(each["severity"], each["line"], each["column"]) for each in checked.told if
                          "lift" in each["text"]], [("warning", 2, 11)])


class AutodesksPost(Wild):
    JOB = (";;^IN;\n!MC1;\n^PR;V15.0;Z0,0,162.6;^PA;\nV15.0;Z400.0,400.0,200.0;\nV5.0;Z400.0,400.0,-40.0;\n"
           "Z800.0,400.0,-40.0;\nV15.0;Z800.0,400.0,200.0;\n^PR;Z0,0,2420.0;^PA;\n!MC0;\n^IN;\n")
    # The first lift begins at the top, and is commanded 163 whole steps above it: for so many of the 1163 steps to 200
    # the tool stays there, and goes on in X and Y, which are 14.142 mm; 25 mm down. 6 mm down, 10 along X, 6 and 25 up.
    PART = 163 / 1163
    WAYS = Ways((200 ** .5 * PART, 15), ((200 * (1 - PART) ** 2 + 625) ** .5, 15), (6, 5), (10, 5), (6, 15), (25, 15))

    def test_it_is_silent(self):
        for profile in ("mdx-15", "mdx-20"):
            checked = self.silent(self.JOB, profile=profile)
            self.takes(checked, self.WAYS, self.JOB)
            self.assertEqual(checked.summary["final"], {"x": 800, "y": 400, "z": 1200})

    def test_fractions_of_a_step(self):
        self.silent(self.JOB.replace("800.0,400.0", "800.4,399.6"))


class FlatCam(Wild):
    JOB = (";;^IN;!MC0;\nV15.0;^PR;Z0,0,1200;^PA;\n!MC1\nV15.0;Z120.0,280.0,80.0;\nV2.0;Z120.0,280.0,-20.0;\n"
           "Z520.0,280.0,-20.0;\nV15.0;Z520.0,280.0,80.0;\n!MC0\n^IN;\n")
    # As above: 1200 of 2320 steps at the top, of 3 and 7 mm in X and Y. 2.5 mm down, 10 mm along X, 2.5 mm up; IN at
    # the default 2 mm/s.
    PART = 1200 / 2320
    WAYS = Ways((58 ** .5 * PART, 15), ((58 * (1 - PART) ** 2 + 784) ** .5, 15), (2.5, 2), (10, 2), (2.5, 15), (28, 2))

    def test_it_is_silent(self):
        self.takes(self.silent(self.JOB), self.WAYS, self.JOB)

    def test_old_commands_are_tolerated(self):
        checked = self.told("!1;J1;" + self.JOB)
        self.assertEqual([each["offset"] for each in checked.told if each["severity"] == "warning"], [0, 3])
        self.takes(checked, self.WAYS, self.JOB)

    def test_negative_coordinates(self):
        job = self.JOB.replace("Z120.0", "Z-120.0").replace("Z520.0", "Z-520.0")
        checked = self.silent(job, "--origin", "20,0,30")
        self.takes(checked, self.WAYS, job)
        self.assertEqual(checked.summary["bounds"]["min"], {"x": -520, "y": 0, "z": -20})


class Size(Wild):
    def test_a_megabyte_on_one_line(self):
        """120,000 times 0.25 mm there and back, at 4 mm/s."""
        job = FAB_HEAD + "PU0,0;PD" + ",".join(("10,0", "0,0") * 120000) + ";PU;"
        self.assertGreater(len(job), 1 << 20)
        checked = self.silent(job)
        self.assertEqual(checked.summary["commands"], 6 + 3)
        self.takes(checked, Ways((28, 4), (2, 4), *[(.25, 4)] * 240000, (2, 4)), job)

    def test_tens_of_thousands_of_speed_changes(self):
        job = FAB_HEAD + "PU0,0;" + "VS1;PD400,0;VS10;PD0,0;" * 20000 + "PU;"
        checked = self.silent(job)
        self.assertEqual(checked.summary["commands"], 6 + 2 + 80000)
        self.takes(checked, Ways((28, 4), (2, 4), *[(10, 1), (10, 10)] * 20000, (2, 4)), job)

    def test_a_line_is_slower_than_short_moves(self):
        """20 bytes for 0.025 mm: 9600 baud needs 20.8 ms for each, 15 mm/s only 1.7 ms."""
        job = FAB_HEAD + "VS15;PU0,0;" + "".join(f"PD{1 + step % 2},0{' ' * 13};\n" for step in range(10000)) + "PU;"
        summary = self.told(job).summary
        self.assertGreater(summary["seconds"]["low"], 0.99 * len(job) / BYTES_A_SECOND)

    def test_never_a_flood(self):
        chance = random.Random(6)
        garbage = bytes(chance.randrange(256) for _ in range(1 << 20))
        text = "".join(chance.choice("ABPUDZ0123,;.!^\n\x1b") for _ in range(1 << 20))
        for job in (garbage, text, fab() + "é" * 1000, b"\x80" * (1 << 20), "!" * (1 << 20), "1" * (1 << 20),
                    "9" * 400 + ";", "-,-,-" * 50000, "!ZE" * 100000, "^" * (1 << 20), "\x1b." * 100000):
            with self.subTest(job[:20]):
                checked = self.told(job)
                self.assertLessEqual(len(checked.told), 100)
                self.assertEqual(checked.code, 1)
                counted = sum(checked.summary[kind] for kind in ("errors", "warnings", "notes"))
                self.assertEqual(checked.summary["omitted"], counted - len(checked.told))
                self.assertLess(len(text_of(job, *AT)), 115)

    def test_hardly_anything(self):
        """A job without a command is none."""
        for job in ("", "\n", ";", " ", "\r\n\r\n", "\x04", "\0"):
            with self.subTest(job):
                checked = self.told(job)
                self.assertEqual([(each["severity"], each["offset"]) for each in checked.told], [("error", 0)])
                self.assertEqual((checked.summary["bounds"], checked.summary["commands"]), (None, 0))
                self.assertEqual(checked.summary["seconds"], {"low": 0, "high": 0})

    def test_a_job_of_one_byte(self):
        for byte in range(0, 256, 3):
            answer = mill("check", "-", "--profile", "mdx-20", job=bytes([byte]))
            self.assertIn(answer.returncode, (0, 1))


if __name__ == "__main__":
    unittest.main()
