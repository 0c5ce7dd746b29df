#!/usr/bin/env python3
"""A watcher of events resumes over a restart of the daemon: each event once, ascending; and motions of before are known."""

import json
import os
import signal
import tempfile
import unittest

from programs import BIN, Daemon, Lines

CONFIG = """
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "{socket}"

[journal]
kept = KEPT

[[device]]
name = "stage"
connection = "serial"
path = "TTY"
baud = 38400
"""
UNWRITTEN = 100_000  # the gap that an end leaves that was not in order


class Resume(unittest.TestCase):
    kept = "true"

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-resume-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.tty = os.path.join(self.folder, "tty")
        simulator = Lines([BIN / "shrc203-sim", "--pty", self.tty, "--baud", "38400"])
        self.addCleanup(simulator.kill)
        simulator.until("simulator on")
        self.start()

    def start(self):
        self.daemon = Daemon(self.folder, CONFIG.replace("TTY", self.tty).replace("KEPT", self.kept))
        self.addCleanup(self.daemon.stop)

    def kill(self):
        self.daemon.signal(signal.SIGKILL)
        self.daemon.exit_code()

    def watch(self, *words):
        watcher = self.daemon.start("--json", "watch", *words)
        self.addCleanup(watcher.kill)
        return watcher

    def move(self, way="+100um"):
        done = self.daemon.run("move", f"1={way}", "--relative")
        self.assertEqual(done.returncode, 0, done.stderr)

    def read_until(self, watcher, wanted):
        """All events up to the first of which `wanted` is true."""
        events = [json.loads(watcher.next())]
        while not wanted(events[-1]):
            events.append(json.loads(watcher.next()))
        return events

    @staticmethod
    def is_end(motion):
        return lambda event: event.get("motion", {}).get("name") == motion and "end_time" in event["motion"]

    def assert_each_once(self, events):
        revisions = [int(event["revision"]) for event in events]
        self.assertEqual(revisions, sorted(set(revisions)))

    def starts(self, events):
        return [event["daemon_started"].get("after_unclean_end", False) for event in events if "daemon_started" in event]


class Kept(Resume):
    def test_over_a_restart_in_order(self):
        watcher = self.watch("--from", "1")
        self.move()
        seen = self.read_until(watcher, self.is_end("devices/stage/motions/1"))
        self.daemon.stop()
        self.start()
        self.move()
        seen += self.read_until(watcher, self.is_end("devices/stage/motions/2"))
        self.assertEqual([int(event["revision"]) for event in seen], list(range(1, len(seen) + 1)))
        self.assertEqual(self.starts(seen), [False, False])
        watcher.kill()
        self.assertNotIn("COMPACTED", watcher.errors)
        self.assertEqual(len({event["run"] for event in seen}), 2)
        again = self.read_until(self.watch("--from", "1"), self.is_end("devices/stage/motions/2"))
        self.assertEqual(again, seen, "what was published before the restart is the same after it")

    def test_killed_in_mid_move_the_outcome_is_an_event(self):
        watcher = self.watch("--from", "1")
        self.move()
        move = self.daemon.start("move", "1=+9mm", "--relative", "--no-wait")
        move.end()
        seen = self.read_until(watcher, lambda event: event.get("motion", {}).get("state") == "MOTION_STATE_RUNNING"
                               and event["motion"]["name"].endswith("/2"))
        self.kill()
        self.start()
        later = self.read_until(watcher, self.is_end("devices/stage/motions/2"))
        self.assert_each_once(seen + later)
        self.assertEqual(self.starts(later), [True])
        self.assertEqual(later[-1]["motion"]["state"], "MOTION_STATE_UNKNOWN")
        start = next(event for event in later if "daemon_started" in event)
        self.assertGreater(int(start["revision"]), int(seen[-1]["revision"]) + UNWRITTEN // 2)
        self.move()
        self.assert_each_once(seen + later + self.read_until(watcher, self.is_end("devices/stage/motions/3")))
        watcher.kill()
        self.assertNotIn("COMPACTED", watcher.errors)

    def test_killed_several_times(self):
        watcher = self.watch("--from", "1")
        seen = []
        for motion in range(1, 4):
            self.move()
            seen += self.read_until(watcher, self.is_end(f"devices/stage/motions/{motion}"))
            self.kill()
            self.start()
        self.move()
        seen += self.read_until(watcher, self.is_end("devices/stage/motions/4"))
        self.assert_each_once(seen)
        self.assertEqual(self.starts(seen), [False, True, True, True])
        # One that was received and not written comes again, under another revision.
        outcomes = {(event["motion"]["name"][-1], event["motion"]["state"]) for event in seen
                    if "end_time" in event.get("motion", {})}
        self.assertEqual(outcomes, {(str(motion), "MOTION_STATE_SUCCEEDED") for motion in range(1, 5)})

    def test_for_people(self):
        watcher = self.daemon.start("watch", "--from", "1")
        self.addCleanup(watcher.kill)
        self.assertRegex(watcher.next(), r"^1 \S+ daemon started$")
        self.kill()
        self.start()
        self.assertRegex(watcher.until("daemon started"), r"^\d+ \S+ daemon started; it had not ended in order, so ")
        watcher.until_error("the connection to the daemon was lost")


class NotKept(Resume):
    kept = "false"

    def test_revisions_begin_again_and_the_watcher_says_so(self):
        watcher = self.watch("--from", "1")
        self.read_until(watcher, lambda event: "link" in event)
        self.daemon.stop()
        self.start()
        start = self.read_until(watcher, lambda event: "daemon_started" in event)[-1]
        self.assertEqual(start["revision"], "1")
        watcher.until_error("axisctl: COMPACTED: ")


if __name__ == "__main__":
    unittest.main()
