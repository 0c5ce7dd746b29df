"""Settings of a stage."""

from __future__ import annotations

from typing import Optional

from axisgate._methods import CHANGE_SETTINGS, GET_SETTINGS
from axisgate._requests import duration, speed
from axisgate._session import DeviceSession
from axisgate.units import Speed
from axisgate.v1 import common_pb2, settings_pb2

# Time for which a change may wait for running commands.
_WAIT_S = 20.0


class Settings:
    """Settings of a stage. Speeds, outputs and the trigger that are set under a lease return to their values after it.
    All functions are thread safe, and raise Refused."""

    def __init__(self, session: DeviceSession) -> None:
        self._session = session

    def read(self) -> settings_pb2.Settings:
        """Reads the settings from the controller, as the API's message."""
        answer = self._session.connection.ask(GET_SETTINGS, settings_pb2.GetSettingsRequest(
            device=self._session.device))
        settings: settings_pb2.Settings = answer.settings
        return settings

    def change(self, axis: str, *, motor_on: Optional[bool] = None, closed_loop: Optional[bool] = None,
               minimum_speed: Optional[Speed] = None, maximum_speed: Optional[Speed] = None,
               acceleration_s: Optional[float] = None) -> None:
        """Changes settings of an axis. None leaves a setting as it is.

        `acceleration_s` is the time from the minimum to the maximum speed, in whole milliseconds.
        """
        profile = common_pb2.Profile(
            minimum=None if minimum_speed is None else speed(minimum_speed),
            maximum=None if maximum_speed is None else speed(maximum_speed),
            acceleration_time=None if acceleration_s is None else duration(acceleration_s))
        changed = settings_pb2.AxisSettings(axis=axis, speeds=profile if profile.ByteSize() else None)
        if motor_on is not None:
            changed.excited = motor_on
        if closed_loop is not None:
            changed.closed_loop = closed_loop
        self.write(settings_pb2.Settings(axes=[changed]))

    def write(self, settings: settings_pb2.Settings) -> None:
        """Changes the settings that are set in the API's message, and no others."""
        self._session.act(CHANGE_SETTINGS, settings_pb2.ChangeSettingsRequest(device=self._session.device,
                                                                              settings=settings), _WAIT_S)
