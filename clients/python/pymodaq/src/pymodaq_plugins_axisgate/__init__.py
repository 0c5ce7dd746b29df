"""Stages behind Axisgate as actuators of PyMoDAQ."""

from pymodaq_utils.config import GlobalConfig
from pymodaq_utils.utils import get_version

from pymodaq_plugins_axisgate.utils import Config

__all__ = ["Config", "config"]
config = GlobalConfig()
__version__ = get_version(__package__)
