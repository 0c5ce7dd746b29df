"""Translates the acts of the conformance scenario into calls of this package, one JSON object on a line each way."""

import json
import signal
import sys
import threading
import time

import axisgate
from axisgate import AxisgateError, MotionFailed, OutcomeUnknown, Refused, Stage, Stopped
from axisgate.v1.motion_pb2 import MOTION_STATE_SUCCEEDED

OUTCOMES = ((Refused, "refused"), (Stopped, "stopped"), (MotionFailed, "failed"), (OutcomeUnknown, "unknown"))


class PointError(Exception):
    """What a program of a user raises while it computes a path."""


def amount(given):
    """A text is exact; a number without a unit is what a careless program passes."""
    if "unit" not in given:
        return given["number"]
    unit = getattr(axisgate, given["unit"])
    return unit(given["text"]) if "text" in given else float(given["number"]) * unit


def speed(act):
    return amount(act["speed"]) / axisgate.s if "speed" in act else None


def shown(result):
    return {"outcome": "done", "positions": {name: f"{one.value:f}" for name, one in result.positions.items()}}


class Acts:
    """One function for each verb of the scenario."""

    def __init__(self):
        self._stage = None
        self._motions = {}
        self._leases = {}
        self._events = None
        self._revisions = []

    def open(self, act):
        if self._stage is not None:
            self._stage.close()
        ways = {key: act[key] for key in ("target", "token", "ca", "certificate", "key") if key in act}
        self._stage = Stage(**ways)
        return {"outcome": "done"}

    def whoami(self, _):
        return {"outcome": "done", "role": self._stage.whoami()[1]}

    def axes(self, _):
        return {"outcome": "done", "axes": [[one.name, one.number] for one in self._stage.axes]}

    def home(self, act):
        return shown(self._stage.home(*act["axes"]))

    def move_to(self, act):
        if "interrupt_after" in act:
            threading.Timer(act["interrupt_after"], signal.raise_signal, (signal.SIGINT,)).start()
        return shown(self._stage[act["axis"]].move_to(amount(act["amount"]), speed=speed(act)))

    def move_by(self, act):
        return shown(self._stage[act["axis"]].move_by(amount(act["amount"])))

    def start(self, act):
        self._motions[act["motion"]] = self._stage[act["axis"]].start(amount(act["amount"]), speed=speed(act))
        return {"outcome": "started"}

    def wait(self, act):
        return shown(self._motions[act["motion"]].wait(act.get("timeout")))

    def cancel(self, act):
        self._motions[act["motion"]].cancel()
        return {"outcome": "done"}

    def stop(self, _):
        return {"outcome": "done", "stays_open": self._stage.stop().stays_open}

    def rearm(self, _):
        self._stage.rearm()
        return {"outcome": "done"}

    def lease(self, act):
        self._leases[act["lease"]] = self._stage.lease(*act["axes"], ttl=act["ttl"]).__enter__()
        return {"outcome": "done"}

    def lost(self, act):
        limit = time.monotonic() + act.get("within", 0)
        lease = self._leases[act["lease"]]
        while not lease.lost and time.monotonic() < limit:
            time.sleep(0.05)  # between two looks; the limit above decides
        return {"outcome": "done", "lost": lease.lost}

    def release(self, act):
        self._leases.pop(act["lease"]).__exit__(None, None, None)
        return {"outcome": "done"}

    def path(self, act):
        unit = getattr(axisgate, act["unit"])

        def points():
            for number in range(1, act["count"] + 1):
                if number > act.get("fails_after", act["count"]):
                    raise PointError
                yield [number * int(step) * unit for step in act["step"]]

        return shown(self._stage.path(points(), act["axes"], speed=speed(act)).wait())

    def scan(self, act):
        motion = self._stage.scan(act["axis"], amount(act["from"]), amount(act["to"]), every=amount(act["every"]),
                                  speed=speed(act))
        scan = motion.wait().scan
        return {"outcome": "done", "expected": scan.expected_in_range,
                "observed_equals_expected": scan.observed == scan.expected}

    def events(self, _):
        self._events = self._stage.events()
        return {"outcome": "done"}

    def succeeded(self, act):
        """Reads events until so many motions have succeeded."""
        gaps = ended = 0
        while ended < act["count"]:
            event = next(self._events)
            if isinstance(event, axisgate.Gap):
                gaps += 1
                continue
            self._revisions.append(event.revision)
            ended += event.kind == "motion" and event.fact.state == MOTION_STATE_SUCCEEDED
        ascending = self._revisions == sorted(set(self._revisions))
        return {"outcome": "done", "ascending": ascending, "gaps": gaps}

    def saturate(self, act):
        motion = self._motions[act["motion"]]
        for _ in range(act["calls"]):
            motion.add_done_callback(lambda _: None)
        return {"outcome": "done"}


def reply_to(acts, act):
    try:
        return getattr(acts, act["say"])(act)
    except KeyboardInterrupt:
        return {"outcome": "interrupted"}
    except Exception as error:
        return reply_to_error(error)


def reply_to_error(error):
    """Returns the reply to an error of the package. Raises any other error again."""
    if isinstance(error, TimeoutError):
        return {"outcome": "timeout"}
    if isinstance(error, AxisgateError):
        outcome = next(name for kind, name in OUTCOMES if isinstance(error, kind))
        return {"outcome": outcome, "reason": error.reason, "message": error.message, "hint": error.hint,
                "axis": error.axis}
    if isinstance(error, (TypeError, ValueError, PointError)):
        return {"outcome": "local", "message": str(error)}
    raise error


def main():
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background jobs ignore it
    acts = Acts()
    for line in sys.stdin:
        print(json.dumps(reply_to(acts, json.loads(line))), flush=True)


if __name__ == "__main__":
    main()
