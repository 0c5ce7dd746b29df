#!/usr/bin/env python3
"""Every way of asking for a stop at every fault of the line, over a pty, with real programs.

From the first line that the daemon receives after the fault, the stop is the next line that it writes, and the axes are
seen stationary soon. Prints a row of delays for each cell. AXISGATE_MATRIX=all runs each cell with one axis and with
three; AXISGATE_MATRIX=table only prints, so that another build may be compared.
"""

import concurrent.futures
import contextlib
import os
import pathlib
import select
import signal
import subprocess
import tempfile
import threading
import time
import tty
import unittest

from cables import Unit
from programs import LIMIT_S, Daemon

SERIAL_NUMBER, STRANGER = "2106001001", "9999999999"
WAY = 1_900_000  # pulses: 38 s at the simulator's F of 50,000
CUT_S = 2.5
# An axis that runs on would do so for more than 30 s. The gateway sees an axis stationary once its barrier has passed,
# after 0.5 to 1.1 s on an idle machine; the lines before the stop are counted exactly on any.
SEEN_MS_MAX = 5000
AT_ONCE = 12
CONFIG = """
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "{socket}"

[[device]]
name = "stage"
connection = "serial"
path = "TTY"
serial_number = "%s"
""" % SERIAL_NUMBER

WAYS = ["stop", "emergency", "cancel", "lease lost", "taken over", "jog killed", "at exit", "crash"]
FAULTS = ["cut before", "cut during", "cut after", "reply lost", "garbage", "reopened", "killed", "restarted",
          "another unit"]
RECEIVED = ["cut after", "reply lost", "garbage"]  # the unit has the stop before the first line is heard


def ms(value, never):
    return never if value is None else f"{value:.0f} ms"


def is_stop(line):
    return line.startswith((b"L:", b"P:E"))


class Wire:
    """A tty at one path that leads to a unit, and does to lines what the fault says."""

    def __init__(self, path, unit):
        self.path = path
        self.unit = unit
        self.dead = False
        self.on_stop = None    # called with the first stop that is written; returns whether it reaches the unit
        self.on_answer = None  # called with the answer to it; returns what reaches the daemon
        self.heard = None      # when the daemon received the first line after the fault
        self.after = []        # what it wrote from then on
        self.stationary = None
        self._back = False
        self._answers_stop = False
        self._ended = threading.Event()
        self._thread = None
        self.plug()

    def back(self):
        """The fault is over: what comes now counts."""
        self._back = True
        self.dead = False

    def plug(self, unit=None):
        self.unit = unit or self.unit
        self.unit.forget_unread()
        self._master, self._slave = os.openpty()
        tty.setraw(self._slave)
        self._ended.clear()
        self._thread = threading.Thread(target=self._carry)
        self._thread.start()
        os.symlink(os.ttyname(self._slave), self.path)

    def unplug(self):
        if self._thread is None:
            return
        os.unlink(self.path)
        self._ended.set()
        if self._thread is not threading.current_thread():
            self._thread.join()
        self._thread = None
        for descriptor in (self._master, self._slave):
            os.close(descriptor)

    def _carry(self):
        to_unit = from_unit = b""
        while not self._ended.is_set():
            unit = self.unit
            try:
                ready, _, _ = select.select([self._master, unit.tty], [], [], 0.02)
                if self._master in ready:
                    *lines, to_unit = (to_unit + os.read(self._master, 4096)).split(b"\r\n")
                    for line in lines:
                        self._to_unit(line)
                if unit.tty in ready and unit is self.unit:
                    *lines, from_unit = (from_unit + os.read(unit.tty, 4096)).split(b"\r\n")
                    for line in lines:
                        self._to_daemon(line)
            except OSError:  # the unit is being replaced
                to_unit = from_unit = b""
                self._ended.wait(0.01)

    def _to_unit(self, line):
        if self.heard:
            self.after.append(line.decode())
        reaches = not self.dead
        if is_stop(line):
            self._answers_stop = True
            if self.on_stop:
                act, self.on_stop = self.on_stop, None
                reaches = act() and reaches
        if reaches:
            self.unit.tell(line + b"\r\n")

    def _to_daemon(self, line):
        if self._answers_stop and line in (b"OK", b"NG") and self.on_answer:
            act, self.on_answer, self._answers_stop = self.on_answer, None, False
            line = act(line)
        if self.dead or line is None:
            return
        if self._back and not self.heard and self.unit.serial_number == SERIAL_NUMBER:
            self.heard = time.monotonic()
        axes = line.split(b",")[-3:]
        if self.heard and not self.stationary and axes == [b"R"] * 3:
            self.stationary = time.monotonic()
        os.write(self._master, line + b"\r\n")


class First(Daemon):
    def end(self):
        """Waits until it has ended: somebody has told it to."""
        self.exit_code()
        self._log.close()


class Restarted(First):
    def _wait_until_ready(self):
        """Its line is dead yet."""


class Cell:
    def __init__(self, folder, way, fault, axes):
        self.folder = pathlib.Path(folder)
        self.way, self.fault, self.axes = way, fault, axes
        self.units = []
        self.wire = Wire(str(self.folder / "tty"), self._unit())
        self.config = CONFIG.replace("TTY", self.wire.path)
        self.daemon = First(folder, self.config)
        self.asked = []

    def _unit(self, serial_number=SERIAL_NUMBER):
        unit = Unit(str(self.folder / f"unit{len(self.units)}"), serial_number)
        self.units.append(unit)
        return unit

    def end(self):
        for process in self.asked:
            with contextlib.suppress(ProcessLookupError, PermissionError):
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()
        self.daemon.stop()
        self.wire.unplug()
        for unit in self.units:
            unit.end()

    def _start(self, *arguments):
        process = subprocess.Popen(self.daemon.command(*arguments), stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL, start_new_session=True)
        self.asked.append(process)
        return process

    def move(self):
        axes = range(1, self.axes + 1)
        if self.way == "jog killed":
            self.mover = self._start("jog", *[f"{axis}=+" for axis in axes], "--speed", "20000pulse/s")
        elif self.way == "lease lost":
            move = self.daemon.command("move", *[f"{axis}={WAY}pulse" for axis in axes], "--no-wait")
            self.mover = self._start("lease", "run", "--", "sh", "-c", '"$@"; sleep 60', "sh", *map(str, move))
        else:
            self.mover = self._start("move", *[f"{axis}={WAY}pulse" for axis in axes])
        limit = time.monotonic() + LIMIT_S
        while not any(line.startswith(("G:", "J:")) for _, line in self.wire.unit.told):
            assert time.monotonic() < limit, self.wire.unit.told[-20:]
            time.sleep(0.01)  # between two looks; the limit above decides
        time.sleep(1)  # of motion

    def ask(self):
        if self.way == "stop":
            self._start("stop", *[str(axis) for axis in range(1, self.axes + 1)])
        elif self.way == "emergency":
            self._start("estop")
        elif self.way == "cancel":
            self._start("cancel", "1")
        elif self.way == "taken over":
            self._start("lease", "run", "--take-over", "--", "true")
        elif self.way in ("lease lost", "jog killed"):
            os.killpg(self.mover.pid, signal.SIGKILL)
        elif self.way == "at exit":
            self.daemon.signal(signal.SIGTERM)
        elif self.way == "crash":
            self.daemon.signal(signal.SIGKILL)

    def _restart(self):
        if self.fault == "killed":
            self.daemon.signal(signal.SIGKILL)
        if self.fault == "killed" or self.way in ("at exit", "crash"):
            self.daemon.end()
            self.daemon = Restarted(self.folder, self.config)

    def fail_and_ask(self):
        wire = self.wire
        begun = time.monotonic()

        def cut(reaches):
            def act():
                wire.dead = not reaches
                if reaches:
                    threading.Timer(0.0005, lambda: setattr(wire, "dead", True)).start()
                return reaches
            return act

        if self.fault in ("cut before", "killed", "restarted"):
            wire.dead = True
            time.sleep(0.3)  # of the cut
        elif self.fault == "cut during":
            wire.on_stop = cut(reaches=False)
        elif self.fault == "cut after":
            wire.on_stop = cut(reaches=True)
        elif self.fault == "reply lost":
            wire.on_answer = lambda _: wire.back()
        elif self.fault == "garbage":
            wire.on_answer = lambda _: wire.back() or b"O\x83"
        elif self.fault == "another unit":
            wire.unplug()
            wire.plug(self._unit(STRANGER))
        elif self.fault == "reopened":
            wire.on_stop = lambda: setattr(wire, "dead", True) or False
        self.ask()
        if self.fault in ("reply lost", "garbage"):
            self._restart()
            return
        if self.fault == "reopened":
            time.sleep(0.3)  # of the cut
            wire.unplug()
            time.sleep(1)
            wire.plug(self.units[0])
        elif self.fault == "restarted":
            self.units[0].switch_off()
            wire.unit = self._unit()
        self._restart_later(begun)

    def _restart_later(self, begun):
        wire = self.wire
        restart = threading.Thread(target=self._restart)
        restart.start()
        time.sleep(max(0, begun + CUT_S - time.monotonic()))  # the cut lasts so long
        if self.fault == "another unit":
            wire.unplug()
            wire.plug(self.units[0])
        wire.back()
        restart.join()

    def run(self):
        """Lines before the stop, ms until it reached the unit, ms until the axes were seen stationary; None for never."""
        self.move()
        self.fail_and_ask()
        wire = self.wire
        limit = time.monotonic() + 16
        while not wire.stationary and time.monotonic() < limit:
            time.sleep(0.01)  # between two looks; the limit above decides
        stops = [number for number, line in enumerate(wire.after) if is_stop(line.encode())]
        told = [when for when, line in wire.unit.told if wire.heard and when > wire.heard and is_stop(line.encode())]
        seen = (wire.stationary - wire.heard) * 1000 if wire.stationary else None
        return (stops[0] if stops else None), ((told[0] - wire.heard) * 1000 if told else None), seen


def run(cell):
    way, fault, axes = cell
    with tempfile.TemporaryDirectory(prefix="axisgate-matrix-") as folder:
        here = Cell(folder, way, fault, axes)
        try:
            return cell, *here.run()
        finally:
            here.end()


def cells():
    if os.environ.get("AXISGATE_MATRIX"):
        return [(way, fault, axes) for way in WAYS for fault in FAULTS for axes in (1, 3)]
    return ([("stop", fault, 1) for fault in FAULTS] + [(way, "cut before", 3) for way in WAYS] +
            [("emergency", fault, 3) for fault in ("reopened", "killed", "another unit")])


class StopMatrix(unittest.TestCase):
    def test_each_stop_is_obeyed(self):
        with concurrent.futures.ThreadPoolExecutor(AT_ONCE) as pool:
            rows = list(pool.map(run, cells()))
        print("| way | fault | axes | lines before the stop | it reached the unit after | seen stationary after |\n"
              "|---|---|---|---|---|---|")
        for (way, fault, axes), before, reached, seen in rows:
            print(f"| {way} | {fault} | {axes} | {'no stop' if before is None else before} | {ms(reached, '-')} | "
                  f"{ms(seen, 'it runs on')} |")
        if os.environ.get("AXISGATE_MATRIX") == "table":
            return
        for (way, fault, axes), before, _, seen in rows:
            with self.subTest(way=way, fault=fault, axes=axes):
                self.assertIsNotNone(seen, "it runs on")
                self.assertLess(seen, SEEN_MS_MAX)
                if fault not in RECEIVED:
                    self.assertEqual(before, 0)



if __name__ == "__main__":
    unittest.main()
