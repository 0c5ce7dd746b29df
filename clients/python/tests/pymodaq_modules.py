"""Modules of PyMoDAQ for tests, with the real daemon. Tests are skipped without PyMoDAQ and the plugin."""

import atexit
import importlib.util
import os
import tempfile
import time
import unittest
from unittest import mock

from daemon import LIMIT_S, DaemonTest

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
if importlib.util.find_spec("pymodaq_plugins_axisgate") is not None:
    _home = tempfile.TemporaryDirectory(prefix="axisgate-pymodaq-")
    atexit.register(_home.cleanup)
    os.environ["HOME"] = _home.name  # PyMoDAQ writes its settings there
try:
    import pymodaq_plugins_axisgate  # noqa: F401
    from pymodaq.control_modules.daq_move import DAQ_Move
    from pymodaq_gui.qt_utils import mkQApp
    from qtpy.QtWidgets import QApplication, QWidget
except ImportError:
    DAQ_Move = None

PULSE_MM = 1e-5


def until(condition, what):
    """Runs Qt's event loop until `condition()` is true."""
    limit = time.monotonic() + LIMIT_S
    while not condition():
        if time.monotonic() > limit:
            raise AssertionError(f"waited in vain: {what}")
        QApplication.processEvents()
        time.sleep(0.005)


class Actuator:
    """A DAQ_Move module of PyMoDAQ with what it reports."""

    def __init__(self, title, axis, target, master=None):
        self.done, self.timeouts, self.messages, self.bounds = [], [], [], []
        self.module = DAQ_Move(QWidget(), title=title)
        self.module.actuator = "Axisgate"
        self.module.move_done_signal.connect(lambda value: self.done.append(round(float(value.value()), 6)))
        self.module.timeout_signal.connect(self.timeouts.append)
        self.module.status_sig.connect(self.messages.append)
        self.module.bounds_signal.connect(self.bounds.append)
        self.set("target", target)
        self.module.settings.child("actuator_settings", "controller", "axis").setValue(axis)
        if master is not None:
            self.module.master = False
            self.module.controller_and_thread.controller = master.module.controller_and_thread.controller
            self.module.controller_and_thread.thread = master.module.controller_and_thread.thread
        answers = []
        self.module.init_signal.connect(answers.append)
        self.module.init_hardware(True)
        until(lambda: answers, "the initialisation")
        self.initialized = answers[0]

    def set(self, *path_and_value):
        self.module.settings.child("actuator_settings", *path_and_value[:-1]).setValue(path_and_value[-1])

    def setting(self, *path):
        return self.module.settings["actuator_settings", *path]

    def move(self, action, *arguments):
        """Starts a move, and returns the position at its end, or None if PyMoDAQ gave up."""
        done, timeouts = len(self.done), len(self.timeouts)
        action(*arguments)
        until(lambda: len(self.done) > done or len(self.timeouts) > timeouts, "the end of the move")
        until(lambda: len(self.timeouts) == timeouts or self.messages[-1] != "Timeout occurred", "the message")
        return self.done[-1] if len(self.done) > done else None

    def quit(self):
        self.module.quit_fun()


@unittest.skipIf(DAQ_Move is None, "PyMoDAQ or the plugin is not installed")
class PyMoDAQTest(DaemonTest):
    """A test with an actuator for axis x."""

    @classmethod
    def setUpClass(cls):
        cls.application = mkQApp("test")

    def setUp(self):
        super().setUp()
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.folder)  # the default folder of PyMoDAQ's data is relative
        self.stage = self.open()
        self.x = self.actuator("x", "1")

    def actuator(self, title, axis, **arguments):
        made = Actuator(title, axis, self.daemon.socket, **arguments)
        self.addCleanup(made.quit)
        return made

    def another(self):
        with mock.patch("axisgate._target.SESSION", "another-program"):
            return self.open(self.daemon.address())

    def at_stage(self, axis=1):
        """Position in pulses, as the simulator records it."""
        return int(self.daemon.at_stage(f"position {axis}").split()[-1])

    def moving(self, axis="x"):
        return self.stage.status(max_age=0).axes[axis].moving

    def begin(self, target):
        """Starts a long move of x, and returns once the axis moves."""
        self.x.module.move_abs(target)
        until(self.moving, "a moving axis")
        self.assertEqual(self.x.done, [])
