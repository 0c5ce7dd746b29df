"""Amounts and their messages."""

import os
import tempfile
import unittest
from decimal import Decimal

from axisgate import _requests as requests
from axisgate import Arc, Position, Result, Scan, deg, mm, nm, pulses, raster, s, um
from axisgate.v1 import common_pb2

try:
    import numpy
except ImportError:
    numpy = None


class Distances(unittest.TestCase):
    def test_exact_amounts_stay_text(self):
        for amount, field, text in ((2 * mm, "mm", "2"), (Decimal("0.10") * um, "um", "0.10"),
                                    (mm("1.5"), "mm", "1.5"), (nm(" -1e3 "), "nm", "-1000"),
                                    (-5 * deg, "degrees", "-5"),
                                    (-(2 * mm), "mm", "-2")):
            message = requests.distance(amount)
            self.assertEqual((message.WhichOneof("amount"), getattr(message, field)), (field, text))

    def test_pulses_are_whole(self):
        self.assertEqual(requests.distance(-7 * pulses).pulses, -7)
        self.assertEqual(requests.distance(Decimal(7) * pulses).pulses, 7)
        self.assertRaises(ValueError, requests.distance, Decimal("7.5") * pulses)

    def test_floats_are_rounded_by_the_daemon(self):
        message = requests.distance((0.1 + 0.2) * mm).floating
        self.assertEqual((message.value, message.unit, message.rounding),
                         (0.1 + 0.2, common_pb2.UNIT_MILLIMETERS, common_pb2.ROUNDING_NEAREST))
        self.assertEqual(requests.distance(1.0 * pulses).floating.unit, common_pb2.UNIT_PULSES)

    def test_what_is_no_amount(self):
        for value in (float("nan"), float("inf"), Decimal("nan")):
            self.assertRaises(ValueError, lambda value=value: value * mm)
        for value in (True, "1", None, [1]):
            self.assertRaises(TypeError, lambda value=value: value * mm)
        for text in ("", "1 mm", "nan", "infinity"):
            self.assertRaises(ValueError, mm, text)
        with self.assertRaisesRegex(TypeError, "1.5 is not a distance: write a number with its unit"):
            requests.distance(1.5)
        self.assertRaises(TypeError, requests.distance, 1 * mm / s)
        self.assertRaises(TypeError, requests.move, "devices/stage", {}, relative=False)

    def test_speeds(self):
        for amount in (2 * mm / s, 2 * (mm / s), (mm / s)("2")):
            self.assertEqual(requests.speed(amount).mm_per_s, "2")
        self.assertEqual(requests.speed(0.5 * um / s).floating.value, 0.5)
        self.assertEqual(requests.speed(100 * pulses / s).pulses_per_s, 100)
        for amount in (2 * mm, 2):
            self.assertRaises(TypeError, requests.speed, amount)
        jog = requests.axis_jog("x", -2 * mm / s)
        self.assertEqual((jog.direction, jog.speed.mm_per_s), (jog.DIRECTION_MINUS, "2"))

    def test_text(self):
        self.assertEqual(str(1.5 * mm), "1.5 mm")
        self.assertEqual(str(-2 * um / s), "-2 um/s")

    def test_segments(self):
        line = requests.segment(["x", "y"], (1 * mm, 2 * mm), 1 * mm / s)
        self.assertEqual([(one.axis, one.distance.mm) for one in line.line.distances], [("x", "1"), ("y", "2")])
        self.assertEqual(requests.segment(["x"], 1 * mm, None).single.distance.mm, "1")
        self.assertRaises(ValueError, requests.segment, ["x", "y"], (1 * mm,), None)
        arc = requests.segment(["x", "y"], Arc((1 * mm, 2 * mm), (3 * mm, 4 * mm)), 1 * mm / s)
        self.assertEqual([one.distance.mm for one in arc.arc.through.end], ["3", "4"])
        self.assertRaises(ValueError, requests.segment, ["x", "y"], Arc((1 * mm,), (3 * mm, 4 * mm)), None)

    def test_raster(self):
        points = raster([1 * mm, 2 * mm, 3 * mm], (y * um for y in (0, 5)))
        self.assertEqual([(x.value, y.value) for x, y in points], [(1, 0), (2, 0), (3, 0), (3, 5), (2, 5), (1, 5)])

    def test_results_as_files_and_tables(self):
        position = Position("x", Decimal("1.50"), mm, 150000)
        scan = Result("m", {"x": position}, 1.0, Scan(2, 2, 2, (Decimal("0.1"), Decimal("1E-5"))))
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "a.csv")
            for result, lines in ((scan, ["pulse,x (mm)", "1,0.1", "2,0.00001"]),
                                  (Result("m", {"x": position}, 1.0), ["axis,position,unit,pulses",
                                                                       "x,1.50,mm,150000"])):
                result.to_csv(path)
                with open(path, encoding="utf-8") as file:
                    self.assertEqual(file.read().splitlines(), lines)
        self.assertIn("<td>1.50 mm</td><td>150000</td>", scan._repr_html_())
        self.assertIn("&lt;b&gt;", Result("m", {"x": Position("<b>", None, mm, None)}, 1.0)._repr_html_())


@unittest.skipIf(numpy is None, "NumPy is not installed")
class Arrays(unittest.TestCase):
    def test_rows(self):
        grid = numpy.array([[1.5, 2.5], [3.5, 4.5]]) * um
        self.assertEqual([list(row) for row in grid], [[1.5 * um, 2.5 * um], [3.5 * um, 4.5 * um]])
        self.assertEqual(len(grid), 2)
        self.assertEqual(list(numpy.array([1, 2]) * mm), [1 * mm, 2 * mm])

    def test_scalars(self):
        self.assertEqual(requests.distance(numpy.float64(1.5) * mm).floating.value, 1.5)
        self.assertEqual(requests.distance(numpy.float32(1.5) * mm).floating.value, 1.5)
        self.assertEqual(requests.distance(numpy.int64(3) * mm).mm, "3")
        self.assertRaises(ValueError, list, numpy.array([numpy.nan]) * mm)


if __name__ == "__main__":
    unittest.main()
