#!/usr/bin/env python3
"""What `axisctl mill check` and `preview` report beyond errors: files that are no jobs, speeds, passes, time, and mm.

A step of `mdx-20` is 0.025 mm; its highest speed is 15 mm/s.
"""

import re
import unittest

from mill_test import HEAD, ORIGIN, PROFILE, Checked, InAFolder, mill, text_of

SLOT = "!PZ-40,200;VS4;!VZ2;\nPU400,400;PD1200,400;\nPU;H;\n"  # 1 mm deep, 20 mm long


class OtherFiles(InAFolder):
    FILES = (("a PDF document", b"%PDF-1.4\n%\xe2\xe3\xcf\xd3\n1 0 obj\n<</Type/Catalog>>\n" * 50),
             ("a Gerber file", b"%FSLAX24Y24*%\n%MOMM*%\nG01*\nX0Y0D02*\n" * 50),
             ("a model in STL", b"solid part\n facet normal 0 0 1\n  outer loop\n" * 50),
             ("an HTML page", b"\n<!doctype html>\n<html><body>404</body></html>\n"),
             ("a text in UTF-16", HEAD.encode("utf-16")), ("a PNG picture", b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR" * 50))

    def test_one_line_says_what_it_is(self):
        for what, content in self.FILES:
            with self.subTest(what):
                self.assertEqual(text_of(content), [f"-:1:1: error: this is {what}, not a job in RML-1 [1-2]"])
                self.assertEqual(Checked(content).code, 1)

    def test_nothing_is_drawn(self):
        path = self.folder / "a.svg"
        for _, content in (*self.FILES, ("", b""), ("", b"\0" * 1000)):
            answer = mill("preview", "-", "--profile", PROFILE, "-o", str(path), job=content)
            self.assertEqual((answer.returncode, path.exists(), answer.stdout.count(b"\n")), (1, False, 1))

    def test_zeros_are_no_job(self):
        self.assertEqual(text_of(b"\0" * 1_000_000)[0],
                         "-:1:1: error: 1000000 bytes without a command: this is no job [1-2]")

    def test_lost_bytes(self):
        lines = text_of(HEAD + "\nPU1,1;" * 20 + "\nU1,\n;,7;1;\n", *ORIGIN)
        self.assertIn("-:22:1: warning: sound before line 22, and from line 22 on ", lines[0])


class Summaries(unittest.TestCase):
    def test_speeds_and_passes(self):
        lines = text_of(SLOT, *ORIGIN)
        self.assertIn("plunges at 2 mm/s from line 2 on: 1 mm, to 1.00 mm deep, up to 1.00 mm per pass", lines)
        self.assertIn("cuts at 4 mm/s from line 2 on: 20 mm, to 1.00 mm deep, up to 1.00 mm per pass", lines)

    def test_what_a_tool_removes(self):
        """20 x 2 x 1 mm and round ends: 43.1 mm3, of which 10 % is more than the grid's error."""
        sections = Checked(SLOT, *ORIGIN, "--tool", "2").summary["sections"]
        self.assertAlmostEqual(sum(each["removed_mm3"] for each in sections), 43.14, delta=4.3)
        self.assertEqual([each["kind"] for each in sections], ["plunge", "cut"])
        self.assertEqual(sum(", removes " in line for line in text_of(SLOT, *ORIGIN, "--tool", "2")), 2)
        self.assertNotIn("removes", "".join(text_of(SLOT, *ORIGIN)))
        self.assertEqual([each["removed_mm3"] for each in Checked(SLOT).summary["sections"]], [None, None])
        for tool in ("0", "-1", "nan", "101", "x"):
            self.assertEqual(mill("check", "-", "--profile", PROFILE, "--tool", tool).returncode, 2, tool)

    def test_steps_and_mm(self):
        summary = Checked(SLOT, *ORIGIN).summary
        self.assertEqual(summary["step_mm"], 0.025)
        self.assertEqual(summary["final_mm"], {"x": 0, "y": 0, "z": 20})
        self.assertEqual(summary["bounds_mm"], {"min": {"x": 0, "y": 0, "z": -1}, "max": {"x": 30, "y": 10, "z": 20}})
        self.assertIsNone(Checked("F5;").summary["bounds_mm"])

    def test_one_rule_for_the_upper_height(self):
        """The height at which a job begins does not count; where it ends at the top, that is said."""
        low = SLOT.replace("H;", "")
        for options in (ORIGIN, ()):
            summary = Checked(low, *options).summary
            self.assertEqual((summary["bounds_mm"]["max"]["z"], summary["reaches_top"]), (5, False))
            self.assertIn("Z -1.00 to 5.00 mm", text_of(low, *options)[1])
            self.assertTrue(Checked(SLOT, *options).summary["reaches_top"])
        self.assertTrue(text_of(SLOT, *ORIGIN)[1].endswith("Z -1.00 to 20.00 mm (the top)"))
        self.assertTrue(text_of(SLOT)[1].endswith("Z -1.00 mm to the top"))

    def test_why_the_time_is_a_range(self):
        assumed = ("at full speed throughout, or by a mill that stops at each point (100 mm/s2 are assumed) or is 50 % "
                   "slower")
        self.assertIn("time: " + assumed, text_of(SLOT, *ORIGIN))
        self.assertTrue(any(line.startswith(f"time: {assumed}; the longer time has ") for line in text_of(SLOT)))
        self.assertEqual(Checked(SLOT, *ORIGIN).summary["seconds_down"], 0)
        # From 60.5 mm to 5 mm at 2 mm/s, half slower.
        self.assertAlmostEqual(Checked(SLOT).summary["seconds_down"], 55.5 / 2 * 1.5, places=6)

    def test_how_the_spindle_ends(self):
        """Guideline 5-2: !MC0 and IN stop it; 3-3 !MC: after !MC0 it is forbidden."""
        for end, turns, permitted in (("", True, True), ("H;", False, True), ("!MC0;", False, False),
                                      ("IN;", False, True)):
            job = HEAD + "PD100,0;PU;" + end
            summary = Checked(job).summary
            self.assertEqual((summary["spindle_turns"], summary["spindle_permitted"]), (turns, permitted), end)
            text = "".join(text_of(job))
            self.assertEqual(("turns at the end" in text, "forbidden at the end" in text), (turns, not permitted))


class OtherMachines(unittest.TestCase):
    def test_a_speed_of_another_machine(self):
        about = Checked("VS60;" + SLOT).about("mm/s")
        self.assertEqual([each["severity"] for each in about], ["warning"])
        self.assertRegex(about[0]["text"], r"at most 15 mm/s.*MDX-50")
        self.assertNotIn("MDX-50", Checked("V16.7;" + SLOT).about("mm/s")[0]["text"])

    def test_a_raster_of_another_unit(self):
        """Multiples of 100 steps: 2.5 mm on an MDX-20, whole millimetres on an SRM-20."""
        job = HEAD + "".join(f"PU{100 * step},{100 * step * step};" for step in range(1, 8))
        self.assertEqual([each["severity"] for each in Checked(job).about("multiples of 100")], ["note"])
        self.assertEqual(Checked(job, profile="srm-20").about("multiples"), [])


class Previews(InAFolder):
    def test_reports_are_printed_and_drawn(self):
        path = self.folder / "a.svg"
        answer = mill("preview", "-", "--profile", PROFILE, "-o", str(path), job=SLOT + "!NR;")
        self.assertEqual((answer.returncode, answer.stderr), (0, b""))
        self.assertRegex(answer.stdout.decode(), r"\A-:4:1: warning: !NR [^\n]+\n\Z")
        self.assertRegex(path.read_text(encoding="utf-8"), r">warning, line 4: !NR ")

    def test_nothing_leaves_its_view(self):
        """Without an origin the tool comes from 60.5 mm above the assumed Z0; a view ends near Z2, 5 mm."""
        path = self.folder / "a.svg"
        mill("preview", "-", "--profile", PROFILE, "-o", str(path), job=SLOT)
        drawn = path.read_text(encoding="utf-8")
        clips = re.findall(r'<clipPath id="(view\d)"><rect class="frame" x="([\d.]+)" y="([\d.]+)" width="([\d.]+)"'
                           r' height="([\d.]+)"/>', drawn)
        self.assertEqual([name for name, *_ in clips], ["view0", "view1", "view2"])
        width, height = map(int, re.search(r'width="(\d+)" height="(\d+)"', drawn).groups())
        for name, *numbers in clips:
            x, y, wide, high = map(float, numbers)
            self.assertTrue(x + wide < width and y + high < height)
            self.assertEqual(drawn.count(f'clip-path="url(#{name})"'), 1)


if __name__ == "__main__":
    unittest.main()
