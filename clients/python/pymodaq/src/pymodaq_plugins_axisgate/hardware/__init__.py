"""The stage, as the actuators of this plugin use it."""
