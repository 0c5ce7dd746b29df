#!/usr/bin/env python3
"""What saves a workpiece: for each warning of `axisctl mill check` a job that gives it, and nearly the same without it.

All figures are in steps of mill_test's MDX-20: area 8128 x 6096 x 2420, at ORIGIN to X 7728, Y 5696 and Z -1620; STOCK
800 x 800 x 200.
"""

import re
import unittest

from mill_test import HEAD, ORIGIN, SHIPPED, STOCK, Checked, InAFolder, shipped_text


class Warnings(InAFolder):
    def gives(self, word, job, at, *options, severity="warning", **where):
        """Exactly one diagnostic speaks of `word`, at the first place of the text `at`."""
        checked = Checked(job, *(options or (*ORIGIN, *STOCK)), **where)
        about = checked.about(word)
        self.assertEqual([(each["severity"], each["offset"]) for each in about], [(severity, job.index(at))], job)
        self.assertEqual(checked.code, 1 if checked.summary["errors"] else 0)
        return checked

    def silent(self, job, *options, **where):
        checked = Checked(job, *(options or (*ORIGIN, *STOCK)), **where)
        self.assertEqual((checked.told, checked.code), ([], 0), job)

    def test_below_the_surface_outside_of_the_stock(self):
        self.gives("outside.* stock", HEAD + "PD801,0;PU;", "PD801")
        self.gives("outside.* stock", HEAD + "PD0,-1;PU;", "PD0")
        self.gives("outside.* stock", HEAD + "PU900,0;PD;PU;", "PD;")
        self.gives("outside.* stock", "Z0,0,200,0,0,-10,801,0,-10,801,0,200;", "Z0")
        self.gives("outside.* stock", "D800,801;M0,0;", "D800")
        self.gives("outside.* stock", HEAD + "PD801,0;PU;", "PD801", *STOCK)
        for job in ("PD800,0;PU;", "PD800,800,0,800,0,0;PU;", "PU801,0;", "!PZ0,200;PD801,0;PU;"):
            self.silent(HEAD + job)
        self.silent("Z0,0,200,0,0,-10,0,0,200,801,0,200;")
        self.silent(HEAD + "PD801,0;PU;", *ORIGIN)

    def test_a_slope_through_the_side_of_the_stock(self):
        """From 10 deep at X 790 to 10 above at 900: out of the stock at 800, 8.2 deep, and on the surface at 845."""
        self.gives("outside.* stock", "Z0,0,200;Z790,0,-10;Z900,0,10;", "Z900")
        self.gives("outside.* stock", "Z0,0,200;Z900,0,10;Z790,0,-10;Z790,0,200;", "Z790")
        self.silent("Z0,0,200;Z790,0,-10;Z800,0,0;Z900,0,10;")

    def test_deeper_than_the_stock(self):
        self.gives("thick", "!PZ-201,200;PD100,0;PU;", "PD100")
        self.gives("thick", "Z0,0,200,0,0,-201,0,0,200;", "Z0")
        self.silent("!PZ-200,200;PD100,0;PU;")
        self.silent("Z0,0,200,0,0,-200,0,0,200;")

    def test_travel_on_the_surface(self):
        for travel in ("PU200,0;", "M200,0;", "R200,0;", "PA200,0;"):
            self.gives("Z2", f"!PZ-100,0;PU;{travel}", travel)
            self.silent(f"!PZ-100,1;PU;{travel}^PA;")
        self.silent("!PZ-100,0;PU;!PZ-100,1;PU200,0;")

    def test_homing_at_z2_on_the_surface(self):
        """IN makes Z2 what the machine has by itself (guideline 3-2 DF 6), which may be what was set, and takes the tool there."""
        for height, warned in ((0, True), (1, False)):
            text = re.sub(r"(?m)^# default_z2 = \S+", f"default_z2 = {height}", shipped_text())
            profile = self.file(f"z2-{height}.toml", text)
            self.gives("IN", "!PZ-100,0;IN;", "IN", *ORIGIN, profile=profile)
            for job in ("IN;", HEAD + "PD100,0;IN;", "^IN;"):
                if warned:
                    self.gives("IN ", job, "IN", *ORIGIN, profile=profile)
                else:
                    self.silent(job, *ORIGIN, profile=profile)
            self.silent(HEAD + "PD100,0;PU;H;", *ORIGIN, profile=profile)
        self.gives("Z2 = 0", "!PZ-100,0;H;", "H")
        self.silent("!PZ-100,1;H;")

    def test_no_spindle(self):
        self.gives("spindle", "!MC0;!PZ-100,200;PU0,0;PD100,0;PU;", "PD100")
        self.gives("spindle", HEAD + "PD;!MC0;PD100,0;PU;", "PD100")
        self.gives("spindle", "!MC0;!PZ-100,200;H;PD100,0;PU;", "PD100")
        self.gives("spindle", "!MC0;Z0,0,-1;Z0,0,1;", "Z0,0,-1")
        for permission in ("!MC1;", "!MC;", "IN;!PZ-100,200;", "DF;!PZ-100,200;"):
            self.silent(f"!MC0;!PZ-100,200;{permission}PU0,0;PD100,0;PU;")
        self.silent("!PZ-100,200;PU0,0;PD100,0;PU;")  # permitted at power-on
        self.silent("!MC0;!PZ0,200;PU0,0;PD100,0;PU;")

    def test_a_lift_of_another_units_travel(self):
        """The travel of Z: 60.5 mm are 2420 steps of 0.025 mm and 6050 of 0.01 mm, 105 mm are 10500 of these."""
        for lift, profile in ((6050, "mdx-20"), (10500, "mdx-15"), (2420, "srm-20"), (2420, "mdx-40")):
            self.gives("lift", HEAD + f"PD100,0;^PR;Z0,0,{lift};^PA;", "Z0", *ORIGIN, profile=profile)
            self.gives("lift", f"!PZ-100,{lift};PU0,0;", "!PZ", "--origin", "10,10,60", profile=profile)
        for lift, profile in ((2420, "mdx-15"), (2420, "mdx-20"), (10500, "mdx-40"), (6050, "srm-20"), (6050, "mdx-40"),
                              (6000, "mdx-20"), (10000, "mdx-20"), (2000, "srm-20")):
            self.silent(HEAD + f"PD100,0;^PR;Z0,0,{lift};^PA;", *ORIGIN, profile=profile)

    def test_larger_than_the_machine(self):
        for side, at, just in (("X", "PD{},0;", 8128), ("Y", "PD0,{};", 6096), ("Z", "Z0,0,-{};", 2420)):
            job = HEAD + at + "PU;"
            checked = self.gives("larger", job.format(just + 1), at[:2], "--stock", "250,250,61", severity="error")
            self.assertEqual((checked.code, checked.summary["errors"]), (1, 1))
            self.assertIn(side, checked.about("larger")[0]["text"])
            self.assertEqual(Checked(job.format(just), "--stock", "250,250,61").about("larger"), [])
        self.gives("larger", "PU-4000,0,4129,0;", "PU", "--stock", "99,99,9", severity="error")
        self.silent("PU-4000,0,4128,0;", "--stock", "99,99,9")

    def test_lifts_beyond_the_top_are_clipped(self):
        for lift in (2420, 9000, 8388607):
            self.silent(HEAD + f"PD100,0;^PR;Z0,0,{lift};^PA;Z0,0,-10;PU;")
            self.silent(HEAD + f"PD100,0;!PZ-100,{lift};PU;", "--stock", "20,20,5")

    def test_a_job_that_is_nothing_but_a_lift(self):
        """From the top, 800, to 800 + 2420."""
        self.silent("^PR;Z0,0,2420;^PA;")
        self.silent("!PZ-100,2421;PU;")

    def test_a_part_that_fits_only_in_the_other_unit(self):
        """12200 steps are 305 mm of 0.025 mm, and 122 mm of 0.01 mm."""
        self.gives("fits", HEAD + "PD12200,0;PU;", "PD12200", "--stock", "400,400,9")
        self.silent(HEAD + "PD8128,0;PU;", "--stock", "400,400,9")
        # 203.2 mm, all of X; 122 mm in X, but 160 mm in Y.
        self.gives("fits", HEAD + "PD20320,0;PU;", "PD20320", "--stock", "600,400,9")
        self.assertEqual(Checked(HEAD + "PD12200,16000;PU;").about("fits"), [])
        for steps, profile in ((30000, "mdx-20"), (30501, "mdx-40"), (20321, "srm-20")):
            checked = Checked(HEAD + f"PD{steps},0;PU;", profile=profile)
            self.assertEqual((len(checked.about("larger")), checked.about("fits")), (1, []))

    def test_an_end_without_terminator(self):
        for last in ("PU", "PU0,0", "PU0,0 ", "!MC0", "M0,0", "!ZEX1Y1Z300"):
            about = Checked(HEAD + last, *ORIGIN).about("terminator")
            self.assertEqual([(each["severity"], each["offset"]) for each in about], [("warning", len(HEAD))], last)
            for end in (";", "\r\n", "\n"):
                self.silent(HEAD + last.rstrip() + end)

    def test_a_circumflex_at_the_end(self):
        for job in ("^", "^;", "^\r\n;;"):
            self.gives(r"\^", HEAD + job, "^", severity="error")
        self.silent(HEAD + "^IN;")

    def test_a_pause(self):
        self.gives("!NR", HEAD + "!NR;", "!NR")
        self.silent(HEAD + "!RC;")

    def test_an_end_with_the_tool_down(self):
        for job in ("PD100,0;", "PD;!MC0;", "Z0,0,-1;"):
            self.assertEqual([each["severity"] for each in Checked(HEAD + job, *ORIGIN, *STOCK).about("tool down")],
                             ["warning"], job)
        for job in ("PD100,0;PU;", "PD;!ZM0;", "PD;H;", "PD;IN;", "Z0,0,-1,0,0,1;", "PD;^PR;Z0,0,101;^PA;"):
            self.silent(HEAD + job)

    def test_an_end_on_the_surface(self):
        for job in ("!PZ0,200;PD100,0;", "PD100,0;^PR;Z0,0,100;^PA;"):
            self.assertEqual(Checked(HEAD + job).about("below|-0.00"), [])

    def test_esc_k(self):
        for job in (HEAD + "\x1b.K", "\x1b.K" + HEAD):
            self.gives("ESC", job, "\x1b", severity="error")
        self.silent(HEAD + "\x1b;")

    def test_leaving_the_area(self):
        for job, at in (("PD7729,0,0,0;PU;", "PD"), ("PD-401,0,0,0;PU;", "PD"), ("PD0,5697,0,0;PU;", "PD")):
            self.gives("area", HEAD + job, at, *ORIGIN)
        for job in ("PU7729,0,0,0;", "PU0,-401,0,0;"):
            self.gives("area", HEAD + job, "PU" + job[2:], *ORIGIN, severity="note")
        self.gives("below|deep", "Z0,0,-1621,0,0,100;", "Z", *ORIGIN)
        for job in ("PD7728,0,0,0;PU;", "PD-400,5696,0,0;PU;"):
            self.silent(HEAD + job, *ORIGIN)
        self.assertEqual(Checked(HEAD + "Z0,0,-1620,0,0,100;", *ORIGIN).about("below|deep"), [])

    def test_each_cause_is_told_once(self):
        job = HEAD + "PD900,0;PU;PD900,900;PU;" * 1000
        checked = Checked(job, *ORIGIN, *STOCK)
        self.assertEqual([each["offset"] for each in checked.told], [len(HEAD)])

    def test_small_matters_hide_none(self):
        self.gives("!NR", "J1;" * 110 + "!NR;", "!NR")

    def test_a_good_job_is_good_on_each_machine(self):
        for name in SHIPPED:
            self.silent(HEAD + "PD100,0;PU;H;", *ORIGIN, *STOCK, profile=name)


if __name__ == "__main__":
    unittest.main()
