"""Simulated controllers that go on while the cable between them and the daemon is pulled and put in again."""

import contextlib
import os
import select
import threading
import time
import tty

from programs import BIN, LIMIT_S, Lines


class Unit:
    """One shrc203-sim, and what it was told: it runs whether a cable is plugged in or not."""

    def __init__(self, path, serial_number, *options):
        self._program = Lines([BIN / "shrc203-sim", "--pty", path, "--serial-number", serial_number, *options])
        self._program.until("simulator on")
        self.tty = os.open(path, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
        self.serial_number = serial_number
        self.told = []  # (when, line)
        self._partial = b""
        self._more = threading.Condition()

    def tell(self, data):
        now = time.monotonic()
        *lines, self._partial = (self._partial + data).split(b"\r\n")
        with self._more:
            self.told += [(now, line.decode()) for line in lines]
            self._more.notify_all()
        os.write(self.tty, data)

    def wait_until_told(self, line, first):
        """When the unit was first told `line`, of what it was told from number `first` on."""
        found = []

        def look():
            found[:] = [when for when, told in self.told[first:] if told == line]
            return bool(found)

        with self._more:
            if not self._more.wait_for(look, LIMIT_S):
                raise AssertionError(f"{line} was not sent; sent were {self.told[first:]}")
        return found[0]

    def forget_unread(self):
        """What it said while nobody was there is lost, as on a UART, and so is the half of a line that it was told."""
        self._partial = b""
        with contextlib.suppress(BlockingIOError):
            while os.read(self.tty, 4096):
                pass

    def switch_off(self):
        """Its end of the line stays, so that nothing else gets its number."""
        if self._program:
            self._program.kill()
        self._program = None

    def end(self):
        os.close(self.tty)
        self.switch_off()


class Cable:
    """A tty that comes and goes at one path, and leads to the unit that it is plugged into."""

    def __init__(self, path):
        self.path = path
        self._thread = None

    def plug(self, unit):
        unit.forget_unread()
        self._master, self._far_end = os.openpty()
        tty.setraw(self._far_end)
        self._unplugged, self._unplug = os.pipe()
        self._thread = threading.Thread(target=self._carry, args=(unit,))
        self._thread.start()
        os.symlink(os.ttyname(self._far_end), self.path)

    def _carry(self, unit):
        while True:
            ready, _, _ = select.select([self._master, unit.tty, self._unplugged], [], [])
            if self._unplugged in ready:
                return
            if self._master in ready:
                unit.tell(os.read(self._master, 4096))
            if unit.tty in ready:
                os.write(self._master, os.read(unit.tty, 4096))

    def unplug(self):
        if self._thread is None:
            return
        os.write(self._unplug, b"!")
        self._thread.join()
        self._thread = None
        os.unlink(self.path)
        for descriptor in (self._master, self._far_end, self._unplugged, self._unplug):
            os.close(descriptor)
