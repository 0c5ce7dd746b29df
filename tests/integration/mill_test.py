#!/usr/bin/env python3
"""`axisctl mill check`, as a person uses it at a shell.

Figures are those of an MDX-20 (deploy/mills): a step is 0.025 mm, the area 203.2 x 152.4 x 60.5 mm is 8128 x 6096 x
2420 steps. With ORIGIN it ends at X 7728, Y 5696 and Z -1620 steps; STOCK is 800 x 800 x 200 steps.
"""

import json
import pathlib
import re
import subprocess
import tempfile
import unittest

from programs import BIN, LIMIT_S, ROOT

PROFILE = "mdx-20"
ORIGIN = ("--origin", "10,10,20")
STOCK = ("--stock", "20,20,5")
HEAD = "PA;!MC1;!PZ-100,200;PU0,0;"
SHIPPED = ("mdx-15", "mdx-20", "mdx-40", "mdx-50", "mdx-540", "srm-20")
TOLD = re.compile(r"(.+):(\d+):(\d+): (error|warning|note)(?: (\d+))?: (.+?)(?: \[([a-z-]+)\])? \[(\d-\d)\]")
COUNTS = re.compile(r"(\d+) errors?, (\d+) warnings?, (\d+) notes?")


def mill(verb, *arguments, job=b""):
    content = job.encode("latin-1") if isinstance(job, str) else job
    return subprocess.run([BIN / "axisctl", "mill", verb, *arguments], capture_output=True, timeout=LIMIT_S,
                          check=False, input=content)


class Checked:
    """What one job was told: `told` is a list of the objects of --json, `summary` the last of them."""

    def __init__(self, job, *options, profile=PROFILE):
        answer = mill("check", "-", "--profile", profile, "--json", *options, job=job)
        self.code = answer.returncode
        self.errors = answer.stderr.decode()
        *self.told, self.summary = map(json.loads, answer.stdout.decode().splitlines())

    def about(self, word):
        return [each for each in self.told if re.search(word, each["text"])]

    def numbers(self):
        return [(each["number"], each["line"], each["column"]) for each in self.told]


def text_of(job, *options, profile=PROFILE):
    return mill("check", "-", "--profile", profile, *options, job=job).stdout.decode().splitlines()


def shipped_text(name=PROFILE):
    return (ROOT / "deploy" / "mills" / f"{name}.toml").read_text(encoding="utf-8")


class InAFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-mill-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def file(self, name, content):
        path = self.folder / name
        path.write_bytes(content.encode("latin-1"))
        return str(path)


class Diagnostics(InAFolder):
    def test_a_line_names_file_place_and_error(self):
        job = self.file("a job.rml", HEAD + "\n  Q;")
        lines = mill("check", job, "--profile", PROFILE).stdout.decode().splitlines()
        self.assertRegex(lines[0], rf"\A{re.escape(job)}:2:3: error 1: [^\n]+ \[2-3\]\Z")
        self.assertRegex(text_of("!NR;")[0], r"\A-:1:1: warning: [^\n]+ \[3-3\]\Z")

    def test_a_line_ends_at_lf_alone(self):
        """Column 1 is the byte behind LF; CR is a byte like others (README: place.h)."""
        for ending in ("\n", "\r\n"):
            with self.subTest(ending):
                told = Checked(f"PA;PA;{ending}Q5;{ending}{ending}\tPA 1;{ending}").numbers()
                self.assertEqual(told, [(1, 2, 1), (2, 2, 2), (2, 4, 5)])
        self.assertEqual(Checked("PA;\rQ;\r").numbers(), [(1, 1, 5)])

    def test_offsets_count_bytes_from_0(self):
        told = Checked("PA;\r\n\r\n\xe9Q;").told
        self.assertEqual([each["offset"] for each in told], [7, 8])

    def test_positions_of_each_error(self):
        """1 at the command, 2 at the surplus, 3 at the wrong parameter, in !ZE at the letter or the bare number, 11 at
        ESC."""
        for job, number, column in (("PU0,0;Q;", 1, 7), ("PU0,0;!XX;", 1, 7), ("M 1,2,3;PU;", 2, 7), ("5;", 2, 1),
                                    (";+1.5;", 2, 2), ("!DW -1;", 3, 5), ("W 32768;", 3, 3), ("!RC-1;", 3, 4),
                                    ("!PZ1,2;", 3, 4), ("!PZ0,-2;", 3, 6), ("!ZEX;", 3, 4), ("!ZE 5;", 3, 5),
                                    ("!ZEX1X2;", 2, 6), (";;\x1b.L", 11, 3), ("PA;^Q;", 2, 5)):
            with self.subTest(job):
                self.assertEqual(Checked(job).numbers()[0], (number, 1, column))

    def test_exit_codes(self):
        for code, job in ((1, ""), (1, "\0" * 9), (0, HEAD + "PD100,0;PU;"), (0, "!NR;"), (1, "Q;"), (1, "G21\n")):
            with self.subTest(job):
                answer = mill("check", "-", "--profile", PROFILE, job=job)
                self.assertEqual((answer.returncode, answer.stderr), (code, b""))

    def test_text_and_json_agree(self):
        for job in (HEAD + "PD801,0,5;\nQ5;", "J1;" + HEAD + "PU9000,0;!NR;", "\x1b.L!ZEX;!DW-1", "Q;" * 150, ""):
            with self.subTest(job[:40]):
                lines = text_of(job, *ORIGIN, *STOCK)
                shown = [match.groups() for match in map(TOLD.fullmatch, lines) if match]
                checked = Checked(job, *ORIGIN, *STOCK)
                self.assertEqual(shown, [("-", str(each["line"]), str(each["column"]), each["severity"],
                                          str(each["number"]) if each["number"] else None, each["text"],
                                          each.get("warning"), each["section"]) for each in checked.told])
                counts = COUNTS.fullmatch(lines[-1]).groups()
                self.assertEqual(counts, tuple(str(checked.summary[kind]) for kind in ("errors", "warnings", "notes")))

    def test_a_depth_that_the_job_did_not_set_is_a_warning(self):
        warned = "lowers the tool before it sets Z1: Z -2.50 mm is from the profile, a mill may differ"
        for job in ("PD;PU;", "@;PD;PU;", HEAD + "DF;PD;PU;"):
            self.assertEqual([each["severity"] for each in Checked(job, *ORIGIN).about(warned)], ["warning"], job)
        for job in ("@-9;PD;PU;", "Z0,0,-9;PU;", "PU;"):
            self.assertEqual(Checked(job, *ORIGIN).about("sets Z1"), [], job)

    def test_what_is_no_job_is_asked_about(self):
        """Before anything else, so that nobody has to read it all."""
        asked = "is it a job in RML-1?"
        self.assertIn(asked, text_of("lorem ipsum dolor sit amet\n")[0])
        for job in ("Q;" + HEAD + "PD9,9;PU;", ""):
            self.assertNotIn(asked, "".join(text_of(job)))

    def test_an_origin_beside_the_machine_is_told(self):
        for origin in ("-1,0,0", "0,152.5,0"):
            answer = mill("check", "-", "--profile", PROFILE, "--origin", origin, job="H;")
            self.assertIn(b"outside the work area", answer.stderr)
            self.assertEqual(answer.returncode, 0)

    def test_shape_of_the_json(self):
        checked = Checked(HEAD + "PD800,0;PU;Q;", *ORIGIN)
        for each in checked.told:
            name = {"warning": str} if each["severity"] == "warning" else {}
            self.assertEqual({key: type(value) for key, value in each.items()},
                             {"number": int, "severity": str, "offset": int, "line": int, "column": int,
                              "section": str, "text": str} | name)
        summary = checked.summary
        self.assertEqual(summary["final"], {"x": 800, "y": 0, "z": 200})
        # All that is driven, but for the height at which the job begins.
        self.assertEqual(summary["bounds"], {"min": {"x": 0, "y": 0, "z": -100}, "max": {"x": 800, "y": 0, "z": 200}})
        # From the top, 20 mm above Z0, to Z2 at 5 mm; to Z1, 2.5 mm below Z0; 20 mm along X; to Z2 again.
        self.assertAlmostEqual(summary["distance_mm"], 15 + 7.5 + 20 + 7.5, places=6)
        self.assertEqual([summary[key] for key in ("spin_ups", "commands", "errors", "warnings", "notes", "omitted")],
                         [1, 6, 1, 0, 0, 0])
        self.assertEqual(sorted(summary["seconds"]), ["high", "low"])
        self.assertIsNone(Checked("PA;").summary["bounds"])

    def test_ten_of_a_kind_and_a_count(self):
        for errors, told, omitted in ((9, 9, 0), (10, 10, 0), (11, 10, 1), (5000, 10, 4990)):
            with self.subTest(errors):
                job = HEAD + "H;" * 5000 + "Q;\n" * errors
                checked = Checked(job)
                self.assertEqual((len(checked.about("no command")), checked.summary["omitted"]), (told, omitted))
                self.assertEqual(checked.summary["errors"], errors)
                lines = text_of(job)
                self.assertEqual(sum("no command" in line for line in lines), told)
                more = f"-: {omitted} more like the error of line 1, up to line {errors}"
                self.assertEqual(more in lines, omitted > 0)

    def test_warnings_hide_no_error(self):
        checked = Checked("!NR;" * 300 + "Q;" * 5)
        self.assertEqual([each["offset"] for each in checked.told if each["severity"] == "error"],
                         [1200, 1202, 1204, 1206, 1208])
        self.assertEqual((len(checked.told), checked.summary["omitted"], checked.code), (15, 290, 1))


class Refusals(InAFolder):
    def refused(self, *arguments, verb="check", job=b""):
        answer = mill(verb, *arguments, job=job)
        self.assertEqual((answer.returncode, answer.stdout), (2, b""), arguments)
        self.assertRegex(answer.stderr.decode(), r"\A(axisctl: \S+?:[^\n]+\n)*axisctl: [A-Z_]+: [^\n]+\n\Z")
        return answer.stderr.decode()

    def test_what_cannot_be_read(self):
        self.assertIn("nothing.rml", self.refused(str(self.folder / "nothing.rml"), "--profile", PROFILE))
        self.assertIn(str(self.folder), self.refused(str(self.folder), "--profile", PROFILE))

    def test_profiles_that_there_are_not(self):
        told = self.refused("-", "--profile", "mdx-2000")
        for name in ("mdx-2000", *SHIPPED):
            self.assertIn(name, told)
        self.assertIn("nothing.toml", self.refused("-", "--profile", "nothing.toml"))
        self.assertIn("profile", self.refused("-"))
        self.refused("-", "--profile", str(self.folder))

    def test_lengths_that_are_none(self):
        for option in ("--origin", "--stock"):
            for value in ("10,10", "1,2,3,4", "a,b,c", ",,", "1,2,3mm", "", "nan,1,1", "1,1,inf"):
                with self.subTest(f"{option} {value}"):
                    self.refused("-", "--profile", PROFILE, option, value)
        self.assertIn("60.5", self.refused("-", "--profile", PROFILE, "--origin", "10,10,60.6"))
        self.refused("-", "--profile", PROFILE, "--stock", "20,0,5")

    def test_each_mistake_of_a_profile(self):
        lines = shipped_text().splitlines()
        mistakes = {}
        for key, value in (("step_mm", '"x"'), ("x_mm", "-1"), ("travel", '"fast"'), ("tolerated", '["K"]')):
            where = next(number for number, line in enumerate(lines) if re.match(rf"{key} *=", line))
            lines[where] = f"{key} = {value}"
            mistakes[key] = where + 1
        lines.append("flat_comands = 5")
        mistakes["flat_comands"] = len(lines)
        path = self.file("mine.toml", "\n".join(lines))
        told = self.refused("-", "--profile", path)
        for key, line in mistakes.items():
            self.assertRegex(told, rf"{re.escape(path)}:{line}: [\w.]*\b{key}\b")
        self.assertEqual(told.count(f"{path}:"), len(mistakes))

    def test_a_profile_that_is_no_toml(self):
        path = self.file("mine.toml", 'name = "mine"\nstep_mm = = 3\n')
        self.assertIn(f"{path}:2:", self.refused("-", "--profile", path))
        self.assertIn("area", self.refused("-", "--profile", self.file("empty.toml", "")))


class Profiles(InAFolder):
    def test_each_shipped_one_by_its_name(self):
        self.assertEqual(sorted(path.stem for path in (ROOT / "deploy" / "mills").glob("*.toml")), sorted(SHIPPED))
        for name in SHIPPED:
            for spelled in (name, name.upper(), name.capitalize()):
                with self.subTest(spelled):
                    answer = mill("check", "-", "--profile", spelled, job="PA;")
                    self.assertEqual((answer.returncode, answer.stderr), (0, b""))
                    self.assertIn(name.upper(), answer.stdout.decode())

    def test_a_file_of_ones_own(self):
        mine = shipped_text().replace('name = "MDX-20"', 'name = "Bench mill"').replace("\nx_mm = 203.2", "\nx_mm = 20")
        path = self.file("mine.toml", mine)
        self.assertIn("Bench mill", "\n".join(text_of("PA;", profile=path)))
        self.assertEqual(Checked(HEAD + "PD800,0;PU;", profile=path).code, 0)
        self.assertEqual(Checked(HEAD + "PD801,0;PU;", profile=path).code, 1)

    def test_what_a_machine_tolerates(self):
        path = self.file("strict.toml", re.sub(r"(?m)^tolerated = .*", "tolerated = []", shipped_text()))
        for job in ("J1;", "!1;", "!0;"):
            self.assertEqual([each["severity"] for each in Checked(job).told], ["warning"], job)
            self.assertEqual(Checked(job, profile=path).numbers()[0], (1, 1, 1), job)


class GCode(unittest.TestCase):
    def test_its_openings(self):
        for job, place in (("%\nO1000\n", 0), ("(a part)\nG21\n", 0), ("G21\nG90\n", 0), ("N10 G0 X0\n", 0),
                           ("O1000\n", 0), ("g0x0", 0), ("n5g1x1", 0), ("o0001", 0), (" \r\n\n\t G1 X1\n", 6),
                           ("G 0 X1", 0), ("%", 0), ("G28\n" * 1000, 0), ("; a part\nG21\n", 9),
                           ("T1 M6\nM3 S8000\nG0 X1\n", 15)):
            with self.subTest(job[:20]):
                checked = Checked(job)
                self.assertEqual([(each["severity"], each["offset"]) for each in checked.told], [("error", place)])
                self.assertIn("G-code", checked.told[0]["text"])
                self.assertEqual((checked.code, checked.summary["bounds"]), (1, None))

    def test_what_only_looks_like_it(self):
        for job in ("Z0,0,0;", "M0,0;", "F10;", "H;", "^IN;", "!1;", ";;^IN;", "@-10,20;", "V15.0;", "M0,0;R5,5;"):
            with self.subTest(job):
                self.assertEqual(Checked(job).summary["errors"], 0)
        for job in ("N;", "O;", "G;", "PA;G0;", "PA;%", "PA;(a);", "Q;G21"):
            with self.subTest(job):
                checked = Checked(job)
                first = next(each for each in checked.told if each["number"])
                self.assertEqual((first["number"], checked.about("G-code")), (1, []))


if __name__ == "__main__":
    unittest.main()
