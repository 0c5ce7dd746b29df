"""What bench.py does with figures: medians, ratios, judgement, and the table."""

import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import bench  # noqa: E402
import machine  # noqa: E402
from figures import Limit, Row, Series, ratios, shown, summary, table_of_goals  # noqa: E402


def row(*values, **others):
    return Row("G1", "a question", "now", list(values), **others)


class Judgement(unittest.TestCase):
    def test_the_median_is_judged(self):
        self.assertEqual(row(9, 1, 2).figure, 2)
        self.assertIs(row(9, 1, 2, limit=Limit(2)).met, True)
        self.assertIs(row(9, 1, 2, limit=Limit(1.9)).met, False)
        self.assertIs(row(0.98, limit=Limit(0.99, at_least=True)).met, False)
        self.assertIs(row(0.99, limit=Limit(0.99, at_least=True)).met, True)

    def test_what_has_no_limit_or_no_value_is_not_judged(self):
        self.assertIsNone(row(1).met)
        self.assertIsNone(row(limit=Limit(1)).met)
        self.assertIsNone(row().figure)

    def test_only_what_is_judged_is_counted(self):
        rows = [row(1, limit=Limit(1)), row(2, limit=Limit(1)), row(3), row(limit=Limit(1))]
        self.assertEqual(summary(rows), "1 of 2 judged figures meet their goal")


class Values(unittest.TestCase):
    def test_each_repetition_has_its_own_ratio(self):
        self.assertEqual(ratios([30, 40], [10, 30], [5, 10]), [2, 1])
        with self.assertRaises(ValueError):
            ratios([30, 40], [10])

    def test_values_are_kept_by_key(self):
        series = Series()
        for value in (5, 1, 3):
            series.add("now", "p50", value)
            series.add("now", 10 * value)
        self.assertEqual(series["now", "p50"], [5, 1, 3])
        self.assertEqual(series.median("now", "p50"), 3)
        self.assertEqual(series.median("now"), 30)

    def test_a_number_has_as_many_digits_as_it_deserves(self):
        for number, text in ((1.0996, "1.100"), (0.36, "0.360"), (2.345, "2.35"), (12.34, "12.3"), (401.2, "401"),
                             (15060.4, "15,060"), (3, "3"), (0, "0"), (20.0, "20")):
            self.assertEqual(shown(number), text)


class Table(unittest.TestCase):
    def test_goal_and_figure_stand_side_by_side(self):
        lines = table_of_goals([row(1.2, 1.1, 1.4, limit=Limit(1.15), absolute="170 µs"), row()]).splitlines()
        self.assertEqual([cell.strip() for cell in lines[2].split("|")[1:-1]],
                         ["G1", "a question", "now", "1.200 (1.100 to 1.400)", "≤ 1.150", "no", "170 µs"])
        self.assertEqual([cell.strip() for cell in lines[3].split("|")[1:-1]],
                         ["G1", "a question", "now", "–", "", "–", ""])
        self.assertEqual(len({len(line) for line in lines}), 1)

    def test_a_p99_on_a_loaded_machine_is_advisory(self):
        for tail, load, text in ((True, 1.6, "no, advisory at load 1.6"), (True, 1.5, "no"), (False, 1.6, "no")):
            self.assertEqual(row(2, limit=Limit(1), tail=tail, load=load).cells()[5], text)

    def test_units(self):
        self.assertEqual(row(7, unit="ms").cells()[3], "7 ms")


class Costs(unittest.TestCase):
    def test_between_two_samples(self):
        before = machine.Sample(10, 1, 100, {"70": ("1 line", 0.5)}, 0, 0)
        after = machine.Sample(12, 2, 150, {"70": ("1 line", 0.75), "71": ("2 grpc", 0.75)}, 0, 0)
        cost = machine.cost(before, after)
        self.assertEqual((cost.cpu_s, cost.cores, cost.switches), (1, 0.5, 50))
        self.assertEqual(list(cost.shares.items()), [("2 grpc", 0.75), ("1 line", 0.25)])


class CommandLine(unittest.TestCase):
    def test_other_builds(self):
        arguments = bench.parsed(["--compare", "before=/a/bin", "older=/b=c/bin"])
        self.assertEqual([(name, folder) for name, _, folder in arguments.compare],
                         [("before", "/a/bin"), ("older", "/b=c/bin")])

    def test_a_short_run_measures_less(self):
        plan = bench.Plan([], 2, 0.3)
        self.assertEqual((plan.seconds(10), plan.count(60), plan.count(1)), (3, 18, 1))


if __name__ == "__main__":
    unittest.main()
