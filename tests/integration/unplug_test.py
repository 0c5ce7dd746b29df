#!/usr/bin/env python3
"""A hundred cables pulled in mid-move, every second time to be put into another unit before the right one comes back."""

import concurrent.futures
import datetime
import json
import os
import pathlib
import re
import tempfile
import threading
import time
import unittest

from cables import Cable, Unit
from programs import LIMIT_S, Daemon

STAGES = 10
ROUNDS = int(os.environ.get("AXISGATE_ROUNDS", "10"))
WAY = 60_000  # pulses
FASTEST = 50_000  # pulses/s: F of the simulator; a move of WAY takes 1.2 s at least
PROBES = {"*IDN?", "?:CMD"}  # all that may be sent to a unit which has not said who it is

HEAD = """
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "{socket}"
"""
# The daemon keeps its newest 10,000 facts, each device's newest 1,000 motions and what 20,000 requests came to: a dozen
# facts, a motion and a request a pull until there are so many: 10 KiB, as seen over 600 pulls, and a few more on a busy
# machine. Its allocator finds its size in the first rounds, and the journal fills its cache of 512 KiB.
KEPT_KIB = 13
ONCE_KIB = 1024
DEVICE = """
[[device]]
name = "NAME"
connection = "serial"
path = "TTY"
serial_number = "NUMBER"
"""


class Stage:
    """One device of the daemon with its cable, its own unit and a strange one."""

    def __init__(self, folder, number):
        self.name = f"stage{number}"
        self.unit = Unit(os.path.join(folder, f"{self.name}.unit"), str(21060000 + number))
        self.stranger = Unit(os.path.join(folder, f"{self.name}.stranger"), str(99000000 + number))
        self.cable = Cable(os.path.join(folder, self.name))
        self.cable.plug(self.unit)
        self.strange_times = []  # (from, to) on the wall clock
        self.looks_in_motion = 0
        self.moving_until = 0.0

    def config(self):
        config = DEVICE.replace("NAME", self.name).replace("TTY", self.cable.path)
        return config.replace("NUMBER", self.unit.serial_number)

    def end(self):
        self.cable.unplug()
        self.unit.end()
        self.stranger.end()


class Unplugs(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-unplug-")
        self.addCleanup(folder.cleanup)
        self.stages = []
        for number in range(STAGES):
            self.stages.append(Stage(folder.name, number))
            self.addCleanup(self.stages[-1].end)
        self.daemon = Daemon(folder.name, HEAD + "".join(stage.config() for stage in self.stages))
        self.addCleanup(self.daemon.stop)
        self.watch = self.daemon.start("--json", "watch", "--from", "1")
        self.addCleanup(self.watch.kill)
        for stage in self.stages:
            self.look_until(stage, lambda status: status["link"] == "LINK_STATE_UP")
        self.descriptors = []
        self.memory_kib = []
        self.round_over = threading.Barrier(STAGES, action=self.sample)

    def look(self, stage):
        """The status, which never says idle when the stage moves."""
        answer = self.daemon.run("--json", "--device", stage.name, "status")
        status = json.loads(answer.stdout)
        if time.monotonic() < stage.moving_until:
            stage.looks_in_motion += 1
            busy = status["axes"][0].get("busy")
            self.assertIsNot(busy, False, answer.stdout)
            self.assertTrue(busy or status["moving_unknown"], answer.stdout)
        return status

    def look_until(self, stage, wanted):
        limit = time.monotonic() + LIMIT_S
        while not wanted(status := self.look(stage)):
            self.assertLess(time.monotonic(), limit, status)
            time.sleep(0.01)  # between two looks; the limit above decides
        return status

    def pull_in_motion(self, stage, target):
        told = len(stage.unit.told)
        move = self.daemon.start("--device", stage.name, "move", f"1={target}pulse")
        stage.moving_until = stage.unit.wait_until_told("G:1", told) + WAY / FASTEST
        move.until("RUNNING")
        stage.cable.unplug()
        self.assertEqual(move.end(), 1, move.errors)
        self.assertRegex(move.errors, r"\Aaxisctl: OUTCOME_UNKNOWN: [^\n]+\n\Z")
        self.assertNotEqual(self.look(stage)["link"], "LINK_STATE_UP")
        return told

    def try_stranger(self, stage):
        told = len(stage.stranger.told)
        begun = time.time()
        stage.cable.plug(stage.stranger)
        both = f"{stage.stranger.serial_number} answers, but SHRC-203 {stage.unit.serial_number} is configured"
        status = self.look_until(stage, lambda status: both in status["link_problem"])
        self.assertNotEqual(status["link"], "LINK_STATE_UP")
        stage.cable.unplug()
        stage.strange_times.append((begun, time.time()))
        self.assertLessEqual({line for _, line in stage.stranger.told[told:]}, PROBES)

    def pull_once(self, stage, number):
        target = WAY * (1 - number % 2)
        told = self.pull_in_motion(stage, target)
        if number % 2 == 1:
            self.try_stranger(stage)
        stage.cable.plug(stage.unit)
        status = self.look_until(stage, lambda status: status["link"] == "LINK_STATE_UP")
        # The unit went on without the daemon, and nobody moved it again.
        self.assertEqual(int(status["axes"][0]["position_pulses"]), target)
        self.assertEqual([line for _, line in stage.unit.told[told:]].count("G:1"), 1)

    def pull_many_times(self, stage):
        try:
            for number in range(ROUNDS):
                self.pull_once(stage, number)
                self.round_over.wait()
        except BaseException:
            self.round_over.abort()
            raise

    def sample(self):
        """Once all stages are up again. gRPC takes a moment to close the connection of a client that has gone."""
        process = pathlib.Path("/proc", str(self.daemon.pid))
        limit = time.monotonic() + 5
        while (count := len(os.listdir(process / "fd"))) > min(self.descriptors, default=0):
            if time.monotonic() > limit or not self.descriptors:
                break
            time.sleep(0.05)  # between two looks; the limit above decides
        self.descriptors.append(count)
        self.memory_kib.append(int(re.search(r"RssAnon:\s+(\d+)", (process / "status").read_text())[1]))

    def check_facts(self):
        """By the daemon's own record: up once at its start and once after each pull, never while a stranger was there."""
        ups = {stage.name: [] for stage in self.stages}
        while any(len(times) <= ROUNDS for times in ups.values()):
            event = json.loads(self.watch.next())
            if event.get("link", {}).get("state") == "LINK_STATE_UP":
                when = datetime.datetime.fromisoformat(event["time"][:26].rstrip("Z") + "+00:00").timestamp()
                ups[event["device"].split("/")[-1]].append(when)
        for stage in self.stages:
            self.assertEqual(len(ups[stage.name]), ROUNDS + 1)
            self.assertEqual(len(stage.strange_times), ROUNDS // 2)
            for begun, ended in stage.strange_times:
                self.assertFalse([up for up in ups[stage.name] if begun < up < ended], stage.name)

    def check_resources(self):
        third = len(self.descriptors) // 3
        self.assertLessEqual(max(self.descriptors[-third:]), max(self.descriptors[:third]), self.descriptors)
        pulls = STAGES * (ROUNDS - third)
        self.assertLess(self.memory_kib[-1] - self.memory_kib[third - 1], KEPT_KIB * pulls + ONCE_KIB, self.memory_kib)

    def test_a_hundred_cables_pulled_in_mid_move(self):
        with concurrent.futures.ThreadPoolExecutor(STAGES) as threads:
            for stage in [threads.submit(self.pull_many_times, stage) for stage in self.stages]:
                stage.result()
        self.check_facts()
        self.check_resources()
        looks = sum(stage.looks_in_motion for stage in self.stages)
        self.assertGreater(looks, STAGES * ROUNDS)
        print(f"{STAGES * ROUNDS} cables pulled in mid-move, {looks} looks at a stage that moved unseen; "
              f"descriptors {self.descriptors}, KiB of memory {self.memory_kib}")


if __name__ == "__main__":
    unittest.main()
