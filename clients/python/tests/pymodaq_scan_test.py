"""A scan of PyMoDAQ's dashboard over two axes, with the real daemon. Skipped without PyMoDAQ and the plugin."""

import os
import unittest

from pymodaq_modules import DAQ_Move, PyMoDAQTest, until

if DAQ_Move is not None:
    import h5py
    from pymodaq.control_modules.enums import DAQTypesEnum
    from pymodaq.dashboard import create_load_dashboard
    from pymodaq.extensions.scan.daq_scan import DAQScan
    from pymodaq.utils.gui_utils.loader_utils import create_extension

# Start, stop and step in mm.
X, Y = (0, 0.5, 0.25), (0, 0.2, 0.1)


class ScanTest(PyMoDAQTest):
    def setUp(self):
        super().setUp()
        self.y = self.actuator("y", "2", master=self.x)
        modules = [self.x.module, self.y.module]
        _, dashboard = create_load_dashboard(show_dashboard=False)
        detector = dashboard.add_det("detector", DAQTypesEnum.DAQ0D, "Mock")
        detector.init_hardware(True)
        until(lambda: detector.initialized_state, "the detector")
        dashboard.actuators_modules, dashboard.detector_modules = modules, [detector]
        _, self.scan = create_extension(dashboard, DAQScan, show_extension=False)
        self.addCleanup(dashboard.quit_fun)
        self.addCleanup(self.scan.quit_fun)
        self.scan.override_popups(False)
        self.scan.modules_manager.selected_actuators_name = ["x", "y"]
        self.scan.modules_manager.selected_detectors_name = ["detector"]
        self.scan.h5saver.settings.child("base_path").setValue(self.folder)
        scanner = self.scan.scanner
        scanner.actuators = modules
        scanner.set_scan_type_and_subtypes("Scan2D", "Linear")
        for axis, values in (("axis1", X), ("axis2", Y)):
            for name, value in zip(("start", "stop", "step"), values):
                scanner.scanner.settings.child(axis, f"{name}_{axis}").setValue(value)
        self.scan.settings.child("scan_options", "go_to_ini_positions").setValue(False)
        self.ended = []
        self.scan.scan_done_signal.connect(lambda: self.ended.append(True))

    def points(self):
        """Positions in mm at which both axes have ended, in the order of the motions."""
        at, points = {}, []
        for motion in reversed(self.stage.motions()):
            for position in motion.result.positions.values():
                at[position.axis] = float(position.value)
            points.append((at.get("x"), at.get("y")))
        return points

    def saved(self):
        path = self.scan.h5saver.settings["current_h5_file"]
        self.scan.h5saver.close_file()
        with h5py.File(path) as file:
            scan = file["RawData/Scan000"]
            return (scan["NavAxes/Axis00"][()].tolist(), scan["NavAxes/Axis01"][()].tolist(),
                    scan["Detector000/Data0D/CH00/Data00"][()])

    def test_scan(self):
        self.scan.start_scan()
        until(lambda: self.ended, "the end of the scan")
        wanted = [(x, y) for x in (0, 0.25, 0.5) for y in (0, 0.1, 0.2)]
        points = self.points()
        self.assertEqual([point for point in wanted if point not in points], [])
        self.assertEqual((self.at_stage(1), self.at_stage(2)), (50000, 20000))
        x, y, data = self.saved()
        self.assertEqual(([round(one, 6) for one in x], [round(one, 6) for one in y]), ([0, 0.25, 0.5], [0, 0.1, 0.2]))
        self.assertEqual(data.shape, (3, 3))

    def test_stop_by_another_program(self):
        other = self.another()
        self.scan.start_scan()
        until(lambda: self.scan.ind_scan == 4, "some points")
        other.stop()
        until(lambda: self.x.timeouts and self.y.timeouts, "refused moves")
        self.assertIn("STOPPED_BY", self.x.messages[-1])
        motions, position = self.stage.motions(), self.at_stage(1)
        self.scan.stop_scan()
        until(lambda: self.ended, "the end of the scan")
        self.assertEqual((len(self.stage.motions()), self.at_stage(1)), (len(motions), position))
        self.assertLess(self.scan.ind_scan, 8)


if __name__ == "__main__":
    unittest.main()
