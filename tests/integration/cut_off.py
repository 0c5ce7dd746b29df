"""A daemon and a caller as on two machines, with a cable between them that can be pulled: no packet passes any more, and
neither side is told."""

import itertools
import os
import shutil
import subprocess

from programs import LIMIT_S

_numbers = itertools.count()


class NotHere(Exception):
    """This system does not let us have network namespaces."""


class Namespaces:
    """Two: "daemon" at 192.0.2.1, and "caller". Nothing of them is seen outside, so that any number may be there at once.
    `clean_up` takes what is to be done when the test ends, however it ends; processes inside must have ended before."""

    def __init__(self, clean_up):
        # Not everybody's PATH has it.
        self._ip = shutil.which("ip", path=os.pathsep.join((os.environ.get("PATH", ""), "/usr/sbin", "/sbin")))
        if self._ip is None:
            raise NotHere("iproute2's `ip` is not installed")
        number = f"{os.getpid()}-{next(_numbers)}"
        self._names = {side: f"axisgate-{number}-{side}" for side in ("daemon", "caller")}
        for name in self._names.values():
            self._make("netns", "add", name)
            clean_up(self._run, "netns", "del", name)  # and with it its end of the cable
        daemon, caller = self._names.values()
        self._make("link", "add", "cable", "netns", daemon, "type", "veth", "peer", "name", "cable", "netns", caller)
        for name, address in ((daemon, "192.0.2.1/24"), (caller, "192.0.2.2/24")):
            self._make("-n", name, "address", "add", address, "dev", "cable")
            self._make("-n", name, "link", "set", "lo", "up")
            self._make("-n", name, "link", "set", "cable", "up")

    def _run(self, *words):
        return subprocess.run([self._ip, *words], capture_output=True, text=True, timeout=LIMIT_S, check=False)

    def _make(self, *words):
        made = self._run(*words)
        if made.returncode != 0:
            raise NotHere(f"`ip {' '.join(words)}` says: {made.stderr.strip()}")

    def inside(self, side, *command):
        """The command that runs the command there."""
        return [self._ip, "netns", "exec", self._names[side], *map(str, command)]

    def unplug(self):
        self._set_cable("down")

    def plug(self):
        self._set_cable("up")

    def _set_cable(self, state):
        self._run("-n", self._names["caller"], "link", "set", "cable", state).check_returncode()
