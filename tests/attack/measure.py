#!/usr/bin/env python3
"""What a flood costs honest callers: the time of their Stops, quiet and meanwhile, and the daemon's memory.

Each case has a daemon of its own, so that it does not begin with what the one before has left.

    AXISGATE_BIN=build/bin tests/attack/measure.py --floods rapid_reset ping --connections 1 4 --later 10
    AXISGATE_BIN=build/bin tests/attack/measure.py --pairwise --json
"""

import argparse
import concurrent.futures
import contextlib
import dataclasses
import itertools
import json
import sys
import time

import floods
import http2
from honest import Caller, Failed
from pairwise import pairwise
from target import Attackers, MemoryPeak, Target

STOP_PAUSE_S = 0.01  # between two Stops: 200 of them see more of a flood than its first moment
STOP_LIMIT_S = 5
AXISCTL_LIMIT_S = 10


@dataclasses.dataclass(frozen=True)
class Case:
    flood: str
    connections: int
    way: str
    credentials: str


@dataclasses.dataclass
class Times:
    """Of Stops or processes; milliseconds, of those that succeeded."""

    done: int
    failed: int
    p50: float | None
    p99: float | None
    max: float | None
    failure: str = ""  # the first


@dataclasses.dataclass
class Result:
    case: Case
    honest_way: str
    quiet_stops: Times
    quiet_axisctl: Times
    stops: Times
    axisctl: Times
    memory_before_mib: float
    memory_peak_mib: float
    memory_later_mib: float
    memory_limit_reached: bool
    answers_later: bool
    attackers: list


def _times(seconds, failures):
    ordered = sorted(round(1000 * one, 2) for one in seconds)

    def share(part):
        return ordered[min(len(ordered) - 1, int(part * len(ordered)))] if ordered else None

    return Times(len(ordered), len(failures), share(0.5), share(0.99), ordered[-1] if ordered else None,
                 failures[0] if failures else "")


class Honest:
    """A caller with a connection that has been there before the flood, and the same caller's new processes. It is
    another one than the attackers on each way."""

    def __init__(self, target, attacked, limit_s):
        self.way = "tls" if attacked == "unix" else "unix"
        self._target, self._limit_s = target, limit_s
        self._caller = self._connect()

    def _connect(self):
        return Caller(self._target.door(self.way), self._target.honest_token if self.way == "tls" else None)

    def stops(self, count, is_over=lambda: False):
        seconds, failures, until = [], [], time.monotonic() + self._limit_s
        for _ in range(count):
            if time.monotonic() > until or is_over():
                break
            try:
                self._caller = self._caller or self._connect()
                seconds.append(self._caller.stop(STOP_LIMIT_S))
            except (Failed, OSError) as failure:
                failures.append(str(failure))
                self.close()
            time.sleep(STOP_PAUSE_S)
        return _times(seconds, failures)

    def processes(self, count, is_over=lambda: False):
        seconds, failures, until = [], [], time.monotonic() + self._limit_s
        for _ in range(count):
            if time.monotonic() > until or is_over():
                break
            begun = time.monotonic()
            if self._target.axisctl(self.way, "stop", limit_s=AXISCTL_LIMIT_S):
                seconds.append(time.monotonic() - begun)
            else:
                failures.append("axisctl stop failed")
        return _times(seconds, failures)

    def close(self):
        if self._caller:
            self._caller.close()
        self._caller = None


class Measurement:
    """Of one case: flood() and result_later(), each once. The daemon lives on between them."""

    def __init__(self, case, arguments):
        self._case, self._arguments = case, arguments
        self._ends = contextlib.ExitStack()
        self._target = Target()
        self._ends.callback(self._target.end)

    def flood(self):
        try:
            self._flood()
        except BaseException:
            self._ends.close()
            raise

    def _flood(self):
        arguments = self._arguments
        self._honest = honest = Honest(self._target, self._case.way, arguments.limit)
        self._ends.callback(honest.close)
        self._quiet = honest.stops(arguments.stops), honest.processes(arguments.processes)
        self._before_kib = self._target.memory_kib()
        case = self._case
        attackers = Attackers(self._target, case.flood, case.way, case.credentials, case.connections,
                              arguments.seconds + 2 * arguments.limit + STOP_LIMIT_S + AXISCTL_LIMIT_S, arguments.deaf)
        self._peak = MemoryPeak(self._target, attackers, arguments.memory_limit * 1024)
        self._peak.begin()
        self._ends.callback(self._peak.end)
        try:
            attackers.await_begin()
            begun = time.monotonic()
            self._during = self._stops_and_processes()
            time.sleep(max(0, begun + arguments.seconds - time.monotonic()))
            attackers.terminate()
            self._outcomes = attackers.outcomes()
        finally:
            attackers.kill()

    def _stops_and_processes(self):
        """As long as the flood lasts."""
        def is_over():
            return self._peak.limit_reached

        return (self._honest.stops(self._arguments.stops, is_over),
                self._honest.processes(self._arguments.processes, is_over))

    def result_later(self):
        with self._ends:
            time.sleep(self._arguments.later)  # what the daemon has received already may cost memory still
            self._peak.end()
            return self._result()

    def _result(self):
        later = self._target.memory_kib()
        answers = self._target.axisctl(self._honest.way, "status", limit_s=AXISCTL_LIMIT_S)
        return Result(self._case, self._honest.way, *self._quiet, *self._during, _mib(self._before_kib),
                      _mib(self._peak.kib), _mib(later), self._peak.limit_reached, answers, self._outcomes)


def measure_all(chosen, arguments):
    """While one daemon is left alone to give back its memory, the next one is flooded."""
    with concurrent.futures.ThreadPoolExecutor(len(chosen)) as waiting:
        results = []
        for case in chosen:
            print(f"{case.flood}, {case.connections} by {case.way}, credentials {case.credentials}", file=sys.stderr)
            measurement = Measurement(case, arguments)
            measurement.flood()
            results.append(waiting.submit(measurement.result_later))
        return [one.result() for one in results]


def _mib(kib):
    return round(kib / 1024, 1)


# What is printed.

HEAD = ("flood", "way", "conn", "cred", "Stop quiet p50/p99", "Stop p50/p99", "ok/failed", "axisctl quiet p50/max",
        "axisctl p50/max", "ok/failed", "MiB before/peak/later", "frames/s", "closed", "first after s", "GOAWAY",
        "afterwards")


def _shown(*numbers):
    return "/".join("-" if number is None else f"{number:.{0 if number >= 100 else 1}f}" for number in numbers)


def _row(result):
    case, attackers = result.case, result.attackers
    per_second = sum(one["frames"] / max(one["seconds"], 0.001) for one in attackers)
    first = [one["closed_after_s"] for one in attackers if one["closed_after_s"] is not None]
    codes = sorted({str(one["goaway"]) for one in attackers if one["goaway"] is not None})
    memory = _shown(result.memory_before_mib, result.memory_peak_mib, result.memory_later_mib)
    return (case.flood, case.way, case.connections, case.credentials,
            _shown(result.quiet_stops.p50, result.quiet_stops.p99), _shown(result.stops.p50, result.stops.p99),
            f"{result.stops.done}/{result.stops.failed}", _shown(result.quiet_axisctl.p50, result.quiet_axisctl.max),
            _shown(result.axisctl.p50, result.axisctl.max), f"{result.axisctl.done}/{result.axisctl.failed}",
            memory + (" limit" if result.memory_limit_reached else ""), f"{per_second:.0f}",
            sum(one["closed"] for one in attackers), min(first) if first else None, ", ".join(codes) or None,
            "answers" if result.answers_later else "SILENT")


def table(results):
    """Markdown."""
    rows = [[("-" if cell is None else str(cell)) for cell in row] for row in (HEAD, *map(_row, results))]
    widths = [max(len(row[column]) for row in rows) for column in range(len(HEAD))]
    lines = ["| " + " | ".join(cell.ljust(width) for cell, width in zip(row, widths)) + " |" for row in rows]
    lines.insert(1, "|" + "|".join("-" * (width + 2) for width in widths) + "|")
    return "\n".join(lines)


def cases(arguments):
    factors = {"flood": arguments.floods, "connections": arguments.connections, "way": arguments.ways,
               "credentials": arguments.credentials}
    if arguments.pairwise:
        return [Case(**row) for row in pairwise(factors)]
    return [Case(*values) for values in itertools.product(*factors.values())]


def _parsed(words):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--floods", nargs="+", choices=floods.FLOODS, default=list(floods.FLOODS))
    parser.add_argument("--connections", nargs="+", type=int, default=[1, 4])
    parser.add_argument("--ways", nargs="+", choices=http2.WAYS, default=["loopback"])
    parser.add_argument("--credentials", nargs="+", choices=floods.CREDENTIALS, default=["none"])
    parser.add_argument("--all", action="store_true", help="all ways and credentials")
    parser.add_argument("--pairwise", action="store_true",
                        help="not all combinations: so many that each two values meet once")
    parser.add_argument("--deaf", action="store_true", help="the attackers read nothing")
    parser.add_argument("--stops", type=int, default=200)
    parser.add_argument("--processes", type=int, default=20, help="of `axisctl stop`")
    parser.add_argument("--seconds", type=float, default=5, help="of each flood, at least")
    parser.add_argument("--limit", type=float, default=20, help="seconds for all Stops, and for all processes")
    parser.add_argument("--later", type=float, default=60, help="seconds until memory is looked at again")
    parser.add_argument("--memory-limit", type=int, default=4096, help="MiB of the daemon that end a flood")
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args(words)
    if arguments.all:
        arguments.ways, arguments.credentials = list(http2.WAYS), list(floods.CREDENTIALS)
    return arguments


def main(words):
    arguments = _parsed(words)
    results = measure_all(cases(arguments), arguments)
    print(json.dumps([dataclasses.asdict(one) for one in results], indent=1) if arguments.json else table(results))


if __name__ == "__main__":
    main(sys.argv[1:])
