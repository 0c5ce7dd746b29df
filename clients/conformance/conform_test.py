"""Tests of the harness itself. They need the generated code of clients/python, whose runner they use.

usage, in this folder: /usr/bin/python3 -m unittest discover --pattern '*_test.py'
"""

import dataclasses
import sys
import unittest

sys.dont_write_bytecode = True

from conform import verdict_of  # noqa: E402
from messages import METHODS  # noqa: E402
from mutations import MUTATIONS, UNKNOWN_REASON  # noqa: E402
from play import HERE, play_steps, read_scenario  # noqa: E402
from proxy import Proxy  # noqa: E402
from runner import Runner  # noqa: E402

PYTHON = HERE.parent / "python"
RUNNER = ["env", f"PYTHONPATH={PYTHON / 'src'}", sys.executable, str(PYTHON / "conformance" / "runner.py")]
SILENT = [sys.executable, "-c", "import sys; sys.stdin.read()"]


class TableTest(unittest.TestCase):
    def test_each_mutation_names_a_step_and_its_difference(self):
        steps = {step["step"] for step in read_scenario()}
        for mutation in MUTATIONS:
            with self.subTest(mutation.name):
                self.assertIn(mutation.step, steps)
                self.assertTrue(mutation.difference)

    def test_names_are_unique(self):
        self.assertEqual(len(MUTATIONS), len({mutation.name for mutation in MUTATIONS}))

    def test_each_mutation_is_of_a_method_of_the_api(self):
        for mutation in (*MUTATIONS, UNKNOWN_REASON):
            self.assertIn(mutation.path, METHODS, mutation.name)


class ScenarioTest(unittest.TestCase):
    def test_steps_are_numbered_from_1(self):
        steps = [step["step"] for step in read_scenario()]
        self.assertEqual(list(range(1, len(steps) + 1)), steps)


class VerdictTest(unittest.TestCase):
    def setUp(self):
        self.mutation = dataclasses.replace(MUTATIONS[0], difference="gaps is 0")

    def test_the_difference_of_the_table_is_noticed(self):
        self.assertEqual("noticed", verdict_of(self.mutation, ("act 1, succeeded", "gaps is 0, not 1")))

    def test_a_step_without_a_difference_is_not_enough(self):
        self.assertEqual("NOT NOTICED", verdict_of(self.mutation, None))

    def test_another_difference_is_not_enough(self):
        self.assertEqual("OTHERWISE", verdict_of(self.mutation, ("act 1, succeeded", "the runner ended")))


class RunnerTest(unittest.TestCase):
    def test_a_runner_without_a_reply_is_ended_and_can_be_started_again(self):
        with Runner(SILENT) as runner:
            for _ in range(2):
                runner.start()
                self.assertTrue(runner.runs)
                with self.assertRaisesRegex(AssertionError, "no reply within 0.1 s"):
                    runner.say({"say": "axes"}, 0.1)
                self.assertFalse(runner.runs)


class ProxyTest(unittest.TestCase):
    def test_without_a_mutation_no_step_of_the_table_has_another_outcome(self):
        of_table = {mutation.step for mutation in MUTATIONS}
        steps = [step for step in read_scenario() if step["step"] in of_table]
        for step, difference, _ in play_steps(steps, "unix", RUNNER, Proxy):
            with self.subTest(step["title"]):
                self.assertIsNone(difference)


if __name__ == "__main__":
    unittest.main()
