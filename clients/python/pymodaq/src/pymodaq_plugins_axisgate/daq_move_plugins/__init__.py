"""Actuators of this plugin. PyMoDAQ needs `path`, and finds each module daq_move_*.py."""

from pathlib import Path

from pymodaq_plugins_axisgate.daq_move_plugins import daq_move_Axisgate

__all__ = ["daq_move_Axisgate", "path"]
path = Path(__file__)
