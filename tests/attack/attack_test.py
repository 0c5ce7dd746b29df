#!/usr/bin/env python3
"""Floods by callers without credentials: Stops of others get through, memory stays bounded, and the flooding
connections are closed."""

import itertools
import time
import unittest

from honest import LIST_DEVICES, Caller, Failed
from pairwise import pairwise
from target import Attackers, MemoryPeak, Target

CONNECTIONS = 4
FLOOD_S = 3
STOPS = 20
STOP_PAUSE_S = 0.1
STOPS_WITHIN_S = 4  # the flood, and a moment
GROWTH_MIB = 150
AFTERWARDS_S = 3  # until an ordinary call is answered
PINGS = 10
PINGS_S = 5


class Flooded(unittest.TestCase):
    def setUp(self):
        self.target = Target()
        self.addCleanup(self.target.end)
        self.caller = Caller(self.target.door("unix"))
        self.addCleanup(self.caller.close)

    def stops(self):
        """What was wrong with each that failed."""
        failures, until = [], time.monotonic() + STOPS_WITHIN_S
        for number in range(STOPS):
            if time.monotonic() > until:
                return [*failures, f"only {number} of {STOPS} Stops within {STOPS_WITHIN_S} s"]
            try:
                self.caller.stop(until - time.monotonic())
            except Failed as failure:
                failures.append(f"Stop {number}: {failure}")
            time.sleep(STOP_PAUSE_S)
        return failures

    def assert_harmless(self, flood, closes=True):
        """`closes`: its connections; otherwise they are slowed down."""
        before = self.target.memory_kib()
        attackers = Attackers(self.target, flood, "loopback", "none", CONNECTIONS, FLOOD_S)
        self.addCleanup(attackers.kill)
        with MemoryPeak(self.target, attackers) as peak:
            attackers.await_begin()
            complaints = self.stops()
            outcomes = attackers.outcomes()
            complaints += self.afterwards()
        growth_mib = (peak.kib - before) / 1024
        if growth_mib > GROWTH_MIB:
            complaints.append(f"memory has grown by {growth_mib:.0f} MiB")
        not_closed = sum(outcome["closed"] == 0 for outcome in outcomes)
        if closes and not_closed:
            complaints.append(f"{not_closed} of {CONNECTIONS} attackers kept their connection for {FLOOD_S} s")
        self.assertTrue(all(outcome["frames"] for outcome in outcomes), outcomes)
        self.assertEqual(complaints, [], outcomes)

    def afterwards(self):
        """What was wrong with an ordinary call of a newcomer."""
        newcomer = Caller(self.target.door("unix"))
        self.addCleanup(newcomer.close)
        try:
            listed = newcomer.call(LIST_DEVICES, limit_s=AFTERWARDS_S)
            return [] if b"stage" in listed else ["afterwards no device is listed"]
        except Failed as failure:
            return [f"an ordinary call afterwards: {failure}"]

    def test_rapid_reset(self):
        self.assert_harmless("rapid_reset")

    def test_continuation(self):
        self.assert_harmless("continuation")

    def test_ping(self):
        self.assert_harmless("ping")

    def test_unknown_methods(self):
        self.assert_harmless("unknown_methods")

    def test_free_frames(self):
        self.assert_harmless("free_frames")

    def test_header_bomb(self):
        self.assert_harmless("header_bomb", closes=False)

    def test_gzip_bomb(self):
        self.assert_harmless("gzip_bomb", closes=False)

    def test_pings_of_an_honest_client_are_answered(self):
        self.caller.idle(0.1)
        for _ in range(PINGS):
            self.caller.ping()
            self.caller.idle(PINGS_S / PINGS)
        self.assertFalse(self.caller.closed)
        self.assertGreater(self.caller.stop(), 0)


class Pairwise(unittest.TestCase):
    def test_each_two_values_meet(self):
        factors = {"flood": list("abcdefg"), "connections": [1, 4], "way": ["unix", "tcp", "tls"], "token": [0, 1, 2]}
        rows = pairwise(factors)
        for one, other in itertools.combinations(factors, 2):
            met = {(row[one], row[other]) for row in rows}
            self.assertEqual(met, set(itertools.product(factors[one], factors[other])))
        self.assertLess(len(rows), 30)  # of 126; 21 at least


if __name__ == "__main__":
    unittest.main(verbosity=2)
