"""Axes as actuators of PyMoDAQ, with the real daemon. Skipped without PyMoDAQ and the plugin."""

import unittest

from axisgate import mm
from pymodaq_modules import DAQ_Move, PULSE_MM, PyMoDAQTest, until

if DAQ_Move is not None:
    from pymodaq.utils.data import DataActuator
    from pymodaq_utils.plugin_tools import checks


class ActuatorTest(PyMoDAQTest):
    def test_initialises(self):
        self.assertTrue(self.x.initialized)
        self.assertEqual((self.x.module.units, self.x.module.axis_name), ("mm", "x"))
        self.assertEqual(list(self.x.module.axis_names), ["x", "y", "3"])
        self.assertAlmostEqual(self.x.setting("epsilon"), PULSE_MM / 2)
        self.assertFalse(self.actuator("fourth", "4").initialized)

    def test_initialises_again(self):
        self.x.set("controller", "axis", "y")
        self.x.module.init_hardware(False)
        answers = []
        self.x.module.init_signal.connect(answers.append)
        self.x.module.init_hardware(True)
        until(lambda: answers, "the second initialisation")
        self.assertEqual(self.x.module.axis_name, "y")
        self.assertEqual(self.x.move(self.x.module.move_abs, 0.5), 0.5)
        self.assertEqual((self.at_stage(1), self.at_stage(2)), (0, 50000))

    def test_moves(self):
        module = self.x.module
        self.assertEqual(self.x.move(module.move_abs, 1.5), 1.5)
        self.assertEqual(self.at_stage(), 150000)
        self.assertEqual(self.x.move(module.move_rel, -0.25), 1.25)
        self.assertEqual(self.at_stage(), 125000)
        self.assertEqual(self.x.move(module.move_abs, DataActuator("x", data=500.0, units="um")), 0.5)
        self.assertEqual(self.x.move(module.move_home), 0)
        self.assertTrue(self.stage.status().axes["x"].homed)
        self.assertEqual(self.x.timeouts, [])

    def test_single_pulses(self):
        for pulse in range(1, 8):
            self.assertEqual(self.x.move(self.x.module.move_abs, pulse * PULSE_MM), round(pulse * PULSE_MM, 6))
            self.assertEqual(self.at_stage(), pulse)
        self.x.move(self.x.module.move_abs, 7.3 * PULSE_MM)  # the nearest pulse is the present one
        self.assertEqual(len(self.stage.motions()), 7)

    def test_scaling(self):
        self.x.set("scaling", "scaling", 2.0)
        self.x.set("scaling", "offset", 0.5)
        self.x.set("scaling", "use_scaling", True)
        self.assertEqual(self.x.move(self.x.module.move_abs, 1.0), 1.0)
        self.assertEqual(self.at_stage(), 100000)  # 1.0 / 2 + 0.5
        self.assertEqual(self.x.move(self.x.module.move_rel, 1.0), 2.0)
        self.assertEqual(self.at_stage(), 150000)

    def test_speed(self):
        for speed, least in ((0.0, 0.0), (0.5, 0.3)):
            self.x.set("speed", speed)
            self.x.move(self.x.module.move_rel, 1.0)
            self.assertGreater(self.stage.motions()[0].result.duration, least)

    def test_stop(self):
        self.begin(14)
        at = self.x.move(self.x.module.stop_motion)
        self.assertTrue(0 < at < 14)
        self.assertFalse(self.moving())
        self.assertEqual(round(at / PULSE_MM), self.at_stage())
        self.assertEqual(self.x.move(self.x.module.move_abs, 0), 0)

    def test_stop_of_homing(self):
        self.x.move(self.x.module.move_abs, 14)
        self.x.module.move_home()
        until(self.moving, "a moving axis")
        self.assertIsNotNone(self.x.move(self.x.module.stop_motion))
        self.assertFalse(self.moving())

    def test_stop_by_another_program(self):
        self.begin(14)
        self.assertIsNone(self.x.move(self.another().stop, "x"))
        self.assertIn("stopped by tcp", self.x.messages[-1])
        self.assertIsNone(self.x.move(self.x.module.move_abs, 0))
        self.assertIn("STOPPED_BY", self.x.messages[-1])
        self.x.set("rearm", True)
        until(lambda: not self.x.setting("rearm"), "rearming")
        self.assertEqual(self.x.move(self.x.module.move_abs, 0), 0)

    def test_refused_homing(self):
        with self.another().lease("x"):
            self.assertIsNone(self.x.move(self.x.module.move_home))
        self.assertIn("LEASE_HELD", self.x.messages[-1])
        self.assertEqual(self.x.done, [])

    def test_refusals(self):
        self.assertIsNone(self.x.move(self.x.module.move_abs, 20))
        self.assertIn("OUTSIDE_TRAVEL", self.x.messages[-1])
        self.assertEqual((self.x.done, self.at_stage(), self.stage.motions()), ([], 0, []))
        self.x.set("bounds", "is_bounds", True)
        self.assertIsNone(self.x.move(self.x.module.move_abs, 2))
        self.assertIn("2 mm is outside the bounds 0 to 1", self.x.messages[-1])
        self.assertEqual((self.x.bounds, self.at_stage()), ([True], 0))
        self.assertEqual(self.x.move(self.x.module.move_abs, 1), 1)
        self.assertIsNone(self.x.move(self.x.module.move_rel, 0.1))
        with self.another().lease("x"):
            self.assertIsNone(self.x.move(self.x.module.move_abs, 0.5))
        self.assertIn("LEASE_HELD", self.x.messages[-1])

    def test_killed_daemon(self):
        self.begin(14)
        self.daemon.kill()
        self.daemon.start()
        self.assertIsNone(self.x.move(lambda: None))
        self.assertIn("DAEMON", self.x.messages[-1].upper())

    def test_timeout(self):
        self.x.set("timeout", 1)
        self.x.set("speed", 0.5)
        self.assertIsNone(self.x.move(self.x.module.move_abs, 14))
        self.assertIn("has not arrived after 1 s", self.x.messages[-1])
        self.assertTrue(self.moving())

    def test_two_axes(self):
        y = self.actuator("y", "2", master=self.x)
        self.assertIs(y.module.controller_and_thread.controller, self.x.module.controller_and_thread.controller)
        self.assertEqual((y.initialized, y.module.axis_name), (True, "y"))
        self.x.module.move_abs(1)
        y.module.move_abs(-2)
        until(lambda: self.x.done and y.done, "both moves")
        self.assertEqual((self.x.done, y.done), ([1], [-2]))
        self.assertEqual((self.at_stage(1), self.at_stage(2)), (100000, -200000))
        y.module.init_hardware(False)
        self.assertEqual(self.x.move(self.x.module.move_abs, 0), 0)  # a slave does not close the controller

    def test_change_of_the_axis(self):
        self.stage.move_to(y=2 * mm)
        self.x.set("controller", "axis", "y")
        self.assertEqual(self.x.move(self.x.module.move_rel, 0.5), 2.5)
        self.assertEqual((self.at_stage(1), self.at_stage(2)), (0, 250000))
        self.x.set("controller", "axis", "x")
        self.x.module.move_abs(14)
        until(self.moving, "a moving axis")
        self.assertIsNone(self.x.move(self.x.set, "controller", "axis", "y"))
        self.assertIn("the axis was changed in mid-move", self.x.messages[-1])


@unittest.skipIf(DAQ_Move is None, "PyMoDAQ or the plugin is not installed")
class PackageTest(unittest.TestCase):
    """PyMoDAQ's own checks of a plugin."""

    def test_package(self):
        package = "pymodaq_plugins_axisgate"
        self.assertFalse(checks.check_package_layout(package))
        self.assertFalse(checks.check_package_sources(package).failing("todo"))
        modules = checks.find_plugin_modules(package)
        self.assertEqual(len(modules), 1)
        self.assertFalse(checks.check_plugin_module(modules[0]).failing("todo", True))


if __name__ == "__main__":
    unittest.main()
