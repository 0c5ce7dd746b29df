#!/usr/bin/env python3
"""The jobs of make.py are those of their table, read by a reader of their commands that shares nothing with the writers."""

import csv
import math
import pathlib
import re
import subprocess
import sys
import tempfile
import tomllib
import unittest

HERE = pathlib.Path(__file__).resolve().parent
MILLS = HERE.parents[1] / "deploy" / "mills"
KINDS = {"board": 24, "outline": 12, "holes": 6, "text": 4, "relief-rough": 8, "relief-fine": 6}
SIZE_MM, DEPTH_MM, SPEED = 0.3, 0.06, 0.05
BYTES_MAX = 5_000_000

COMMAND = re.compile(r"(!ZE[^;\r\n]*|![A-Z]{2}|! *\d|P[ADRU]|IN|DF|VS|[A-Z@])([-+\d., \t]*)")
NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)")
# Text between commands: ends of lines and of commands, and the mark of mode 2.
BETWEEN = re.compile(r"[;^\s]*")


class Reader:
    """Follows a job in steps, and keeps where the tool has been below the surface, and how far at which speed."""

    HIGH = 1e6  # a height above all, for a tool-up position that the panel sets

    def __init__(self, text):
        self.at, self.absolute, self.down, self.up = (0.0, 0.0, 0.0), True, -100.0, self.HIGH
        self.flat_speed = self.space_speed = None
        self.cut, self.driven, self.plunged, self.unread = [], {}, {}, ""
        end = 0
        for match in COMMAND.finditer(text):
            self.unread += BETWEEN.sub("", text[end:match.start()])
            end = match.end()
            self.execute(match[1], [float(number) for number in NUMBER.findall(match[2])])
        self.unread += BETWEEN.sub("", text[end:])

    def go(self, x, y, z, speed):
        flat = math.hypot(x - self.at[0], y - self.at[1])
        if z < 0:
            self.cut.append((x, y, z))
            book = self.driven if flat and self.at[2] < 0 else self.plunged
            book[speed] = book.get(speed, 0.0) + math.dist(self.at, (x, y, z))
        self.at = (x, y, z)

    def target(self, numbers):
        return [number + (0.0 if self.absolute else was) for number, was in zip(numbers, self.at)]

    def plot(self, numbers, height, speed):
        self.go(*self.at[:2], height, self.space_speed)
        for k in range(0, len(numbers), 2):
            self.go(*self.target(numbers[k:k + 2]), height, speed)

    def space(self, numbers):
        for k in range(0, len(numbers), 3):
            self.go(*self.target(numbers[k:k + 3]), self.space_speed)

    def axes(self, words):
        given = {axis: float(number) for axis, number in re.findall(r"([XYZ]) *([-+]?[\d.]+)", words)}
        stay = self.at if self.absolute else (0.0, 0.0, 0.0)
        self.space([given.get(axis, here) for axis, here in zip("XYZ", stay)])

    def execute(self, name, numbers):
        if name in ("PA", "DF", "IN", "M", "D", "H"):
            self.absolute = True
        if name == "PR":
            self.absolute = False
        elif name in ("PU", "M"):
            self.plot(numbers, self.up, None)
        elif name in ("PD", "D"):
            self.plot(numbers, self.down, self.flat_speed)
        elif name in ("Z", "!ZZ"):
            self.space(numbers)
        elif name.startswith("!ZE"):
            self.axes(name[3:])
        elif name in ("!PZ", "@"):
            self.down, self.up = numbers
        elif name in ("VS", "F"):
            self.flat_speed = numbers[0]
        elif name in ("V", "!VZ"):
            self.space_speed = numbers[0]
        elif name in ("H", "!ZM"):
            self.at = (*self.at[:2], self.HIGH)

    def size(self):
        """Returns width, height and depth of what is cut, in steps."""
        return [max(v) - min(v) for v in list(zip(*self.cut))[:2]] + [-min(z for _, _, z in self.cut)]

    def speed(self):
        """Returns the speed at which most is cut, or plunged if nothing is cut between."""
        book = self.driven or self.plunged
        return max(book, key=book.get)


def made(folder):
    subprocess.run([sys.executable, "-B", str(HERE / "make.py"), str(folder)], check=True)
    return {path.name: path.read_bytes() for path in sorted(pathlib.Path(folder).iterdir())}


class Jobs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.files = made(pathlib.Path(cls.folder.name) / "a" / "b")
        cls.rows = list(csv.DictReader(cls.files["jobs.tsv"].decode("ascii").splitlines(), delimiter="\t"))
        cls.readers = {row["file"]: Reader(cls.files[row["file"]].decode("ascii")) for row in cls.rows}
        cls.mills = {path.stem: tomllib.loads(path.read_text()) for path in MILLS.glob("*.toml")}

    def each(self, judge):
        """Calls `judge` with the row, the mill and the reader of each job."""
        for row in self.rows:
            with self.subTest(row["file"]):
                judge(row, self.mills[row["mill"]], self.readers[row["file"]])

    def test_the_table_names_every_file_once(self):
        names = [row["file"] for row in self.rows]
        self.assertEqual(sorted(names + ["jobs.tsv"]), sorted(self.files))
        self.assertEqual({kind: [row["kind"] for row in self.rows].count(kind) for kind in KINDS}, KINDS)

    def test_they_are_small(self):
        self.assertLess(sum(map(len, self.files.values())), BYTES_MAX)

    def test_the_same_bytes_come_again(self):
        self.assertEqual(self.files, made(pathlib.Path(self.folder.name) / "again"))

    def test_nothing_but_commands_is_in_them(self):
        self.each(lambda _row, _mill, reader: self.assertEqual(reader.unread, ""))

    def test_each_cuts_what_its_row_says(self):
        def judge(row, mill, reader):
            nearness = {"width_mm": SIZE_MM, "height_mm": SIZE_MM, "depth_mm": DEPTH_MM}
            for (column, near), steps in zip(nearness.items(), reader.size()):
                self.assertAlmostEqual(steps * mill["step_mm"], float(row[column]), delta=near, msg=column)
        self.each(judge)

    def test_each_cuts_as_fast_as_its_row_says(self):
        def judge(row, mill, reader):
            self.assertAlmostEqual(reader.speed(), float(row["speed_mm_s"]), delta=SPEED)
            self.assertLessEqual(reader.speed(), mill["speed"]["cutting_maximum"])
        self.each(judge)

    def test_each_fits_its_mill(self):
        def judge(_row, mill, reader):
            for axis, places in zip(("x_mm", "y_mm"), zip(*reader.cut)):
                self.assertGreater(min(places) * mill["step_mm"], -SIZE_MM)
                self.assertLess(max(places) * mill["step_mm"], mill["area"][axis])
            self.assertLess(reader.size()[2] * mill["step_mm"], mill["area"]["z_mm"])
        self.each(judge)


if __name__ == "__main__":
    unittest.main()
