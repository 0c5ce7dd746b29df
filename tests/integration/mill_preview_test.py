#!/usr/bin/env python3
"""The pictures of `axisctl mill preview`: views, cuts, what remains, legend, and what they are written to.

Figures are those of mill_test.py.
"""

import base64
import os
import struct
import unittest
import xml.etree.ElementTree
import zlib

from mill_test import HEAD, ORIGIN, PROFILE, STOCK, Checked, InAFolder, mill


class Previews(InAFolder):
    JOB = "PA;!MC1;VS4;!VZ2;!PZ-40,200;PU100,0;PD400,0;!PZ-180,200;PD400,300;PU0,0;"

    def drawn(self, name, *options, job=JOB):
        """What `check` reports of the job is on the standard output."""
        path = self.folder / name
        answer = mill("preview", self.file("job.rml", job), "--profile", PROFILE, "-o", str(path), *options)
        self.assertEqual((answer.returncode, answer.stderr), (0, b""))
        return path

    def svg(self, *options, job=JOB):
        root = xml.etree.ElementTree.parse(self.drawn("job.svg", *options, job=job)).getroot()
        self.assertEqual(root.tag, "{http://www.w3.org/2000/svg}svg")
        return root

    @staticmethod
    def classed(root, kind):
        return [each for each in root.iter() if kind in each.get("class", "").split()]

    @staticmethod
    def words(root):
        return "\n".join("".join(each.itertext()) for each in root.iter("{http://www.w3.org/2000/svg}text"))

    def test_three_views(self):
        """And area and stock once more, small."""
        root = self.svg(*ORIGIN, *STOCK)
        self.assertEqual([len(self.classed(root, kind)) for kind in ("view", "area", "stock", "origin")], [3, 4, 4, 3])
        for word in ("top", "front", "side"):
            self.assertRegex(self.words(root), rf"(?m)^{word}\b")
        self.assertEqual(len(self.classed(self.svg(*ORIGIN), "stock")), 0)

    def test_travel_cuts_and_depth(self):
        top = self.classed(self.svg(*ORIGIN), "view")[0]
        cuts, travels = self.classed(top, "cut"), self.classed(top, "travel")
        self.assertEqual(len({each.get("stroke") for each in cuts}), 2)  # 1 mm and 4.5 mm deep
        self.assertFalse({each.get("stroke") for each in cuts} & {each.get("stroke") for each in travels})
        self.assertEqual([each.get("d") for each in cuts], ["M100 0l300 0", "M400 0l0 300"])

    def test_what_remains(self):
        """The first cut is at column 37, the second at 57."""
        root = self.svg(*ORIGIN, "--from", "1:57")
        top = self.classed(root, "view")[0]
        self.assertEqual([each.get("d") for each in self.classed(top, "done")], ["M100 0l300 0"])
        self.assertEqual([each.get("d") for each in self.classed(top, "cut")], ["M400 0l0 300"])
        self.assertEqual(self.classed(top, "perhaps"), [])
        self.assertRegex(self.words(root), r"(?m)^job\.rml: what remains on the MDX-20$")
        root = self.svg(*ORIGIN, "--from", "1:37-1:57")
        top = self.classed(root, "view")[0]
        self.assertEqual(self.classed(top, "done"), [])
        self.assertEqual([each.get("d") for each in self.classed(top, "perhaps")], ["M100 0l300 0"])
        self.assertRegex(self.words(root), r"(?m)^perhaps done up to line 1, column 57: \d+ mm driven, 8 mm cutting$")
        self.assertGreater(self.drawn("job.svg", "--from", "1:37-1:57").stat().st_size, 1_000)
        answer = mill("preview", "-", "--profile", PROFILE, "-o", "x.svg", "--from", "9-8", job=self.JOB)
        self.assertEqual(answer.returncode, 2)
        self.assertIn(b'"9-8" is not valid for --from: name a line', answer.stderr.replace(b" (", b": "))

    def test_cuts_are_as_wide_as_the_tool(self):
        """0.4 mm are 16 steps. From the front and from the side they stay lines."""
        top, front, side = self.classed(self.svg(*ORIGIN, "--tool", "0.4"), "view")
        self.assertEqual({each.get("stroke-width") for each in self.classed(top, "cut")}, {"16"})
        for view in (front, side):
            self.assertEqual({each.get("stroke-width") for each in self.classed(view, "cut")}, {None})

    def test_two_files_are_two_parts(self):
        second = self.file("second.rml", "PA;!MC1;!PZ-180,200;PU0,0;PD100,0;PU0,0;")
        path = self.folder / "both.svg"
        options = ("--profile", PROFILE, *ORIGIN, "-o", str(path))
        first = self.file("job.rml", self.JOB)
        answer = mill("preview", first, second, *options, "--tool", "0.4,1")
        self.assertEqual((answer.returncode, answer.stderr), (0, b""))
        root = xml.etree.ElementTree.parse(path).getroot()
        words = self.words(root)
        self.assertRegex(words, r"(?m)^job\.rml, second\.rml on the MDX-20$")
        self.assertRegex(words, r"(?m)^part 1: 4\.50 mm deep$")
        self.assertRegex(words, r"(?m)^part 2: 4\.50 mm deep$")
        cuts = self.classed(self.classed(root, "view")[0], "cut")
        self.assertEqual([each.get("stroke-width") for each in cuts], ["16", "16", "40"])
        self.assertEqual(len({each.get("stroke") for each in cuts}), 3, "the same depth has a colour in each part")
        for wrong in (("--tool", "0.4,1,2"), ("--from", "3")):
            self.assertEqual(mill("preview", first, second, *options, *wrong).returncode, 2, wrong)

    def assert_png(self, content):
        self.assertEqual(content[:8], b"\x89PNG\r\n\x1a\n")
        at, chunks = 8, []
        while at < len(content):
            length, kind = struct.unpack_from(">I4s", content, at)
            data = content[at + 8:at + 8 + length]
            self.assertEqual(struct.unpack_from(">I", content, at + 8 + length)[0], zlib.crc32(kind + data))
            chunks.append((kind, data))
            at += length + 12
        self.assertEqual((chunks[0][0], chunks[-1]), (b"IHDR", (b"IEND", b"")))
        width, height, depth, colour = struct.unpack_from(">IIBB", chunks[0][1])
        pixels = zlib.decompress(b"".join(data for kind, data in chunks if kind == b"IDAT"))
        samples = {0: 1, 2: 3, 3: 1, 6: 4}[colour]
        self.assertEqual(len(pixels), height * (1 + (width * samples * depth + 7) // 8))

    def test_a_relief_is_shaded(self):
        """Nine depths: the view from above shows the surface, as a picture in the picture."""
        job = "PA;!MC1;!ZZ0,0,200;" + "".join(f"!ZZ{i * 40},0,-{i * 4};!ZZ{i * 40},400,-{i * 4};" for i in range(1, 10)) + "!ZZ0,0,200;"
        root = self.svg(*ORIGIN, job=job)
        relief, = self.classed(root, "relief")
        kind, encoded = relief.get("href").split(",")
        self.assertEqual(kind, "data:image/png;base64")
        self.assert_png(base64.b64decode(encoded))
        top, front, side = self.classed(root, "view")
        self.assertEqual((self.classed(top, "cut"), bool(self.classed(front, "cut"))), ([], True))
        self.assertRegex(self.words(root), r"shaded as a flat tool of 2 mm leaves it")

    def test_a_legend(self):
        words = self.words(self.svg(*ORIGIN))
        self.assertRegex(words, r"\b4 mm/s")
        seconds = Checked(self.JOB, *ORIGIN).summary["seconds"]
        self.assertIn(f"{seconds['low']:.0f} s to {seconds['high']:.0f} s", words)
        self.assertRegex(words, r"\b4\.50 mm")

    def test_lines_are_a_pixel_wide_for_whoever_scales_them(self):
        for view in self.classed(self.svg(*ORIGIN), "view"):
            scale = float(view.get("transform").removeprefix("matrix(").split()[0])
            self.assertAlmostEqual(float(view.get("stroke-width")) * scale, 1, places=4)
            for path in self.classed(view, "travel"):
                self.assertAlmostEqual(float(path.get("stroke-width")) * scale, 0.6, places=4)

    def test_names_are_no_markup(self):
        path = self.folder / "a<b>&\"c.rml"
        path.write_text(self.JOB, encoding="ascii")
        answer = mill("preview", str(path), "--profile", PROFILE, "-o", str(self.folder / "a.svg"))
        self.assertEqual(answer.returncode, 0)
        self.assertIn(path.name, self.words(xml.etree.ElementTree.parse(self.folder / "a.svg").getroot()))

    def test_names_of_any_bytes(self):
        """What is no UTF-8 is left out of a picture, and nothing else is."""
        for name, shown in ((b"k\xc3\xb6rper.rml", "körper.rml on the"), (b"k\xffrper.rml", "krper.rml on the")):
            path = os.fsencode(self.folder) + b"/" + name
            with open(path, "wb") as file:
                file.write(self.JOB.encode())
            picture = self.folder / "a.svg"
            answer = mill("preview", path, "--profile", PROFILE, "-o", str(picture))
            self.assertEqual((answer.returncode, answer.stderr), (0, b""))
            self.assertIn(shown, self.words(xml.etree.ElementTree.parse(picture).getroot()))

    def test_a_way_through_the_surface_is_cut_below_it(self):
        """From 5 mm above to 2.5 mm below Z0: the lower third, in the front view."""
        front = self.classed(self.svg(*ORIGIN, job="!PZ-100,200;PU0,0;Z300,0,-100;PU;"), "view")[1]
        self.assertEqual(self.classed(front, "cut")[0].get("d").split("l")[0], "M200 0")

    def test_nothing_is_cut(self):
        words = self.words(self.svg(job="PU100,0;PU0,0;"))
        self.assertIn("travel", words)
        self.assertNotIn("0.00 mm", words)

    def test_a_job_with_nothing_to_draw(self):
        self.assertEqual(len(self.classed(self.svg(job="F5;"), "view")), 3)

    def test_150_000_commands(self):
        job = HEAD + "".join(f"PD{i % 6000},{i % 5000};" for i in range(150000)) + "PU;"
        root = self.svg(job=job)
        self.assertIn("150005 commands", self.words(root))
        self.assertGreater(sum(len(each.get("d")) for each in self.classed(root, "cut")), 10000)

    def test_refusals(self):
        job = self.file("job.rml", self.JOB)
        for name in ("job.pdf", "job.png", "job", "no/such/folder/job.svg"):
            with self.subTest(name):
                answer = mill("preview", job, "--profile", PROFILE, "-o", str(self.folder / name))
                self.assertEqual((answer.returncode, answer.stdout), (2, b""))
                self.assertIn(name, answer.stderr.decode())
        self.assertEqual(mill("preview", job, "--profile", PROFILE).returncode, 2)
        self.assertEqual(mill("preview", str(self.folder / "none"), "--profile", PROFILE, "-o", "x.svg").returncode, 2)

    def test_g_code_is_not_drawn(self):
        path = self.folder / "job.svg"
        answer = mill("preview", "-", "--profile", PROFILE, "-o", str(path), job="G21\nG0 X1\n")
        self.assertEqual((answer.returncode, path.exists()), (1, False))


if __name__ == "__main__":
    unittest.main()
