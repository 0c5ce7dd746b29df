#!/usr/bin/env python3
"""All floods at once, for minutes, and Stops of an honest caller meanwhile: memory and descriptors before, at the peak and
afterwards.

    AXISGATE_BIN=build/bin tests/attack/mixed.py --seconds 600 --connections 40000
"""

import argparse
import contextlib
import os
import sys
import time

import floods
from honest import Caller, Failed
from target import Attackers, MemoryPeak, Target

WAYS = ("loopback", "tls", "unix")
PAUSE_S = 0.25  # between two Stops
AFTERWARDS_S = 30  # in which the daemon gives memory back
MEMORY_PEAK_MIB, MEMORY_LATER_MIB = 150, 20  # above what there was before


def descriptors(target):
    return len(os.listdir(f"/proc/{target.daemon.pid}/fd"))


class Honest:
    def __init__(self, target):
        self._target, self._caller = target, None
        self.milliseconds, self.failures = [], []

    def stop(self):
        try:
            self._caller = self._caller or Caller(self._target.door("unix"))
            self.milliseconds.append(1000 * self._caller.stop(5))
        except (Failed, OSError) as failure:
            self.failures.append(str(failure))
            self.close()

    def close(self):
        if self._caller:
            self._caller.close()
        self._caller = None

    def shown(self):
        ordered = sorted(self.milliseconds)
        p50, p99 = (ordered[int(part * (len(ordered) - 1))] for part in (0.5, 0.99))
        return f"{len(ordered)} Stops, {len(self.failures)} failed, p50 {p50:.1f} ms, p99 {p99:.1f} ms, max {ordered[-1]:.1f}"


def begin_all(target, seconds):
    """One attacker for each flood, and the ways in turn."""
    return {flood: Attackers(target, flood, WAYS[number % len(WAYS)], "none", 1, seconds)
            for number, flood in enumerate(floods.FLOODS)}


def run(seconds, connections):
    with contextlib.ExitStack() as ends:
        target = Target()
        ends.callback(target.end)
        honest = Honest(target)
        ends.callback(honest.close)
        honest.stop()
        before_kib, before, peak_descriptors = target.memory_kib(), descriptors(target), 0
        attackers = begin_all(target, seconds)
        for one in attackers.values():
            ends.callback(one.kill)
        with MemoryPeak(target, next(iter(attackers.values()))) as peak:
            until = time.monotonic() + seconds
            while time.monotonic() < until:
                honest.stop()
                peak_descriptors = max(peak_descriptors, descriptors(target))
                time.sleep(PAUSE_S)
            outcomes = {flood: one.outcomes()[0] for flood, one in attackers.items()}
        honest.close()
        time.sleep(AFTERWARDS_S)
        later_kib, later = target.memory_kib(), descriptors(target)
    made = sum(one["connections"] for one in outcomes.values())
    for flood, one in outcomes.items():
        print(f"{flood}: {one['connections']} connections, {one['frames']} frames, {one['closed']} closed")
    print(f"{made} connections in {seconds} s; {honest.shown()}")
    print(f"memory {before_kib // 1024}, {peak.kib // 1024}, {later_kib // 1024} MiB; "
          f"descriptors {before}, {peak_descriptors}, {later}")
    grew_mib, kept_mib = (peak.kib - before_kib) / 1024, (later_kib - before_kib) / 1024
    good = (made >= connections and not honest.failures and grew_mib <= MEMORY_PEAK_MIB and kept_mib <= MEMORY_LATER_MIB
            and later <= before)
    print("ok" if good else "FAIL")
    return 0 if good else 1


def main(words):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=600)
    parser.add_argument("--connections", type=int, default=40_000, help="so many at least")
    arguments = parser.parse_args(words)
    return run(arguments.seconds, arguments.connections)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
