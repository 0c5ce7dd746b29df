"""Configuration of this plugin, as PyMoDAQ looks for it."""

from pathlib import Path

from pymodaq_utils.config import BaseConfig


class Config(BaseConfig):
    """The configuration file of this plugin. It has no settings yet."""

    config_template_path = Path(__file__).parent / "resources" / "config_template.toml"
    config_name = "config_axisgate"
