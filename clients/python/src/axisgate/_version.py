"""Version of this package, and its comparison with the daemon's."""

from __future__ import annotations

import logging

VERSION = "0.1.0"

_log = logging.getLogger("axisgate")


def compare(daemon: str) -> None:
    """Logs a warning if the daemon has another version. Fields that one of them does not know have no effect."""
    if daemon and daemon != VERSION:
        _log.warning("the daemon is axisgate %s, and this package %s", daemon, VERSION)
