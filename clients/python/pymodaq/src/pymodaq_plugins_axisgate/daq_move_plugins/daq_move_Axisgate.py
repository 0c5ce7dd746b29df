"""An axis of a stage behind Axisgate as an actuator of PyMoDAQ."""

from __future__ import annotations

from time import perf_counter
from typing import Optional, Tuple

from axisgate import AxisgateError, Motion
from pymodaq.control_modules.move_utility_classes import (DAQ_Move_base, DataActuator, DataActuatorType,
                                                          comon_parameters_fun, main)
from pymodaq.control_modules.thread_commands import ThreadStatus, ThreadStatusMove
from pymodaq_gui.parameter import Parameter
from pymodaq_utils.utils import ThreadCommand

from pymodaq_plugins_axisgate.hardware.controller import Controller

_TIMEOUT_S = 600


def _settings(parameters: list) -> list:
    """Returns the settings of every actuator with a timeout that a slow stage needs."""
    return [dict(one, value=_TIMEOUT_S) if one["name"] == "timeout" else one for one in parameters]


class DAQ_Move_Axisgate(DAQ_Move_base):
    """An axis of a stage behind Axisgate.

    The axes of a stage share a Controller, which one actuator, the master, creates. The axis is chosen by its number.
    Once the stage is connected, the list of the axes has their names.
    """

    is_multiaxes = True
    _axis_names = ["1", "2", "3", "4"]
    _controller_units = "mm"
    _epsilons = 1e-6
    data_actuator_type = DataActuatorType.DataActuator
    params = [
        {"title": "Daemon:", "name": "target", "type": "str", "value": "",
         "tip": "Address of the daemon. Empty: AXISGATE_TARGET, or the local daemon"},
        {"title": "Stage:", "name": "device", "type": "str", "value": "",
         "tip": "Name of the stage. Empty: the only one"},
        {"title": "Speed:", "name": "speed", "type": "float", "value": 0.0, "min": 0.0,
         "tip": "Highest speed in the unit of the axis per second. 0: as the axis is set"},
        {"title": "Rearm:", "name": "rearm", "type": "bool_push", "value": False, "label": "Rearm",
         "tip": "Allows motion after a stop by another program"},
    ] + _settings(comon_parameters_fun(is_multiaxes, axis_names=_axis_names, epsilon=_epsilons))

    def ini_attributes(self) -> None:
        """Sets the attributes of this class. The base calls it before it connects."""
        self.controller: Optional[Controller] = None
        self._motion: Optional[Motion] = None

    def ini_stage(self, controller: Optional[Controller] = None) -> Tuple[str, bool]:
        """Connects to the stage, or takes the controller of the master. Returns a message, and True after success."""
        if self.is_master:
            controller = Controller(self.settings["target"], self.settings["device"])
        if controller is None:
            return "initialise the master of this controller first", False
        name = controller.name_of(self.settings["controller", "axis"])
        if name is None:
            if self.is_master:
                controller.close()
            return f"stage {controller.name} has no such axis: choose one of 1 to {len(controller.axes)}", False
        self.controller = controller
        if self.axis_names != controller.axes:
            self.axis_names = controller.axes
        self.axis_units = [controller.unit(axis) for axis in controller.axes]
        # PyMoDAQ omits a move by less than this. Half a pulse, because a step of one pulse must not be omitted.
        self.epsilons = [controller.pulse(axis) / 2 for axis in controller.axes]
        self.axis_name = name  # shows its unit and its epsilon
        return f"axis {name} of stage {controller.name}", True

    def close(self) -> None:
        """Closes the connection if this actuator is the master. Motions continue."""
        self.poll_timer.stop()
        controller, self.controller = self.controller, None
        if self.is_master and controller is not None:
            controller.close()

    def commit_settings(self, param: Parameter) -> None:
        """Applies a setting that the user has changed. The speed applies to the next move."""
        if param.name() == "axis" and self._motion is not None:
            self._give_up(RuntimeError("the axis was changed in mid-move: the motion of the axis before it continues"))
        elif param.name() == "rearm" and param.value() and self.controller is not None:
            self.controller.rearm()
            self.settings.child("rearm").setValue(False)

    def get_actuator_value(self) -> DataActuator:
        """Reads the position from the controller."""
        position = DataActuator(self._title, data=self.controller.position(self.axis_name), units=self.axis_unit)
        return self.get_position_with_scaling(position)

    def move_abs(self, value: DataActuator) -> None:
        """Starts a move to a position."""
        self._start(value, relative=False)

    def move_rel(self, value: DataActuator) -> None:
        """Starts a move by a distance."""
        self._start(value, relative=True)

    def move_home(self, value: object = None) -> None:
        """Starts homing the axis. PyMoDAQ leaves the polling to the plugin."""
        try:
            self._motion = self.controller.home(self.axis_name)
        except (AxisgateError, LookupError, RuntimeError) as error:
            return self._give_up(error)
        self.ispolling = True
        self.poll_moving()

    def stop_motion(self) -> None:
        """Stops the axis, also a motion of another program. The move ends at the present position."""
        self.poll_timer.stop()
        self._motion = None
        try:
            report = self.controller.stop(self.axis_name)
            if report.problem is not None or report.stays_open:
                raise RuntimeError(str(report))
            self.move_done()
        except (AxisgateError, LookupError, RuntimeError) as error:
            self._give_up(error)

    def user_condition_to_reach_target(self) -> bool:
        """Reports whether the motion has succeeded. Raises Stopped, MotionFailed or OutcomeUnknown."""
        if self._motion is not None:
            if not self._motion.done:
                return False
            motion, self._motion = self._motion, None
            motion.result  # raises the error of the motion
        return True

    def check_target_reached(self) -> None:
        """Polls the motion until the daemon reports its outcome.

        The base polls for a position near the target, so that it would wait for a motion that was stopped elsewhere.
        """
        try:
            if self.user_condition_to_reach_target():
                self.poll_timer.stop()
                return self.move_done()
        except (AxisgateError, LookupError, RuntimeError) as error:
            return self._give_up(error)
        try:
            self.current_value = self.get_actuator_value()
            self.emit_value(self.current_value)
        except (AxisgateError, LookupError, RuntimeError) as error:  # the motion may continue without a connection
            self.emit_status(ThreadCommand(ThreadStatus.UPDATE_STATUS, str(error)))
        if perf_counter() - self.start_time >= self.settings["timeout"]:
            self._give_up(TimeoutError(f"axis {self.axis_name} has not arrived after {self.settings['timeout']} s, and "
                                       "the motion continues: stop it, or raise the timeout"))

    def _start(self, value: DataActuator, relative: bool) -> None:
        """Starts a move. Raises an exception if it is refused, so that PyMoDAQ does not poll."""
        scaled = self.set_position_relative_with_scaling(value) if relative else self.set_position_with_scaling(value)
        try:
            target = self.get_actuator_value() + value if relative else value
            self._check_bounds(target.value(self.axis_unit))
            self._motion = self.controller.start(self.axis_name, scaled.value(self.axis_unit), relative,
                                                 self.settings["speed"])
        except Exception as error:
            self._give_up(error)
            raise
        self.target_value = target

    def _check_bounds(self, target: float) -> None:
        """Refuses a target outside the bounds of the settings. The base would shorten the move."""
        low, high = self.settings["bounds", "min_bound"], self.settings["bounds", "max_bound"]
        if self.settings["bounds", "is_bounds"] and not low <= target <= high:
            self.emit_status(ThreadCommand(ThreadStatusMove.OUT_OF_BOUNDS))
            raise ValueError(f"{target:g} {self.axis_unit} is outside the bounds {low:g} to {high:g} of the settings")

    def _give_up(self, error: Exception) -> None:
        """Ends the polling, and tells PyMoDAQ why the move is not done."""
        self.poll_timer.stop()
        self._motion = None
        self.emit_status(ThreadCommand(ThreadStatus.RAISE_TIMEOUT))
        self.emit_status(ThreadCommand(ThreadStatus.UPDATE_STATUS, str(error)))


if __name__ == "__main__":
    main(__file__)
