#!/usr/bin/env python3
"""Jogs whose caller falls silent, dies, is cut off or says stop, at a controller on a paced line."""

import json
import os
import re
import shlex
import signal
import subprocess
import tempfile
import time
import unittest

from cut_off import Namespaces, NotHere
from message_relay import MessageRelay
from programs import BIN, LIMIT_S, Daemon, Lines

CONFIG = """
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "{socket}"

[[device]]
name = "stage"
connection = "serial"
path = "TTY"
baud = BAUD
flow_control = "none"

[[device.axis]]
number = 1
name = "x"
unit = "mm"
travel_maximum = "0.3mm"
maximum_speed = "0.5mm/s"
"""
TRAVEL_PULSES = 30_000  # travel_maximum, at 10 nm a pulse

NETWORK = """
[network]
listen = "192.0.2.1:0"
certificate = "FOLDER/gateway.crt"
key = "FOLDER/gateway.key"
client_ca = "FOLDER/lab.crt"
"""

SILENCE_S = 0.5
CYCLE_BYTES = 80  # Q: and its answer for three axes, at most
LOADED_HOST_S = 1.0  # how late this host may let the daemon run

OUTCOMES = ("MOTION_STATE_SUCCEEDED", "MOTION_STATE_STOPPED", "MOTION_STATE_FAILED", "MOTION_STATE_UNKNOWN")
QUESTION = re.compile(r'^(\d+\.\d+) #\d+ \w+ "unix [^>\n]*> "\?:N\\r\\n" ', re.MULTILINE)
STOP = re.compile(r'^(\d+\.\d+) #\d+ stop "((?:[^"\\]|\\.)*)"[^>\n]*> "L:1\\r\\n"', re.MULTILINE)


class Jogs(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-jog-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def serve(self, baud=38400, tables="", program="axisgated"):
        self.baud = baud
        tty = os.path.join(self.folder, "tty")
        simulator = Lines([BIN / "shrc203-sim", "--pty", tty, "--baud", str(baud)])
        self.addCleanup(simulator.kill)
        simulator.until("simulator on")
        config = CONFIG.replace("TTY", tty).replace("BAUD", str(baud)) + tables
        self.daemon = Daemon(self.folder, config, program=program)
        self.addCleanup(self.daemon.stop)
        self.watch = self.daemon.start("--json", "watch", "--from", "1")
        self.addCleanup(self.watch.kill)

    def jog(self, *arguments, command=None):
        """One that runs."""
        jog = Lines([*(command or self.daemon.command()), "jog", *arguments])
        self.addCleanup(jog.kill)
        jog.until("RUNNING")
        return jog

    def outcome(self):
        """Of the next jog to end, as the daemon tells it to others than its caller."""
        while True:
            motion = json.loads(self.watch.next()).get("motion", {})
            if motion.get("kind") == "MOTION_KIND_JOG" and motion["state"] in OUTCOMES:
                return motion

    def axes(self):
        shown = self.daemon.run("--json", "position")
        self.assertEqual((shown.returncode, shown.stderr), (0, ""))
        return {axis["number"]: axis for axis in map(json.loads, shown.stdout.splitlines())}

    def place(self, axis=1):
        return int(self.axes()[axis]["position_pulses"])

    def assert_stopped(self, why, reason="REASON_STOPPED"):
        """The jog has gone some way and ended for that, and all axes stand. The outcome."""
        motion = self.outcome()
        self.assertEqual(motion["state"], "MOTION_STATE_STOPPED", motion)
        self.assertEqual(motion["problem"]["reason"], reason, motion)
        self.assertIn(why, motion["problem"]["message"])
        self.assert_stands(motion)
        return motion

    def assert_stands(self, motion):
        for _ in range(2):
            axes = self.axes()
            self.assertNotIn(True, [axis["busy"] for axis in axes.values()])
            for result in motion["results"]:
                self.assertEqual(axes[result["axis"]]["position_pulses"], result["command_pulses"])
                self.assertNotEqual(int(result["command_pulses"]), 0)

    def recording(self):
        return self.daemon.run("record", "--no-follow").stdout

    def stop_written(self, why):
        """Between which two times of time.monotonic() the first L: was: the recording says when it was, and the same of
        questions that were asked between two looks at that clock."""
        asked = []
        for _ in range(5):
            before = time.monotonic()
            self.assertEqual(self.daemon.run("exec", "?:N").stdout, "SHRC-203\n")
            asked.append((before, time.monotonic()))
        text = self.recording()
        recorded = [float(when) for when in QUESTION.findall(text)][-len(asked):]
        self.assertEqual(len(recorded), len(asked), text)
        earliest = max(before - when for (before, _), when in zip(asked, recorded))
        latest = min(after - when for (_, after), when in zip(asked, recorded))
        self.assertLess(earliest, latest)
        when, who = STOP.search(text).groups()
        self.assertIn(why, who)
        return float(when) + earliest, float(when) + latest

    def limit_s(self):
        return SILENCE_S + 2 * CYCLE_BYTES * 10 / self.baud + LOADED_HOST_S

    def tell(self, since, earliest, latest, after):
        print(f"\n{self.baud} baud: L: written between {1000 * (earliest - since):.0f} and {1000 * (latest - since):.0f} ms "
              f"after {after}", flush=True)

    def assert_stops_a_halted_caller(self, baud):
        self.serve(baud)
        relay = MessageRelay(os.path.join(self.folder, "relay.sock"), self.daemon.socket)
        self.addCleanup(relay.stop)
        jog = self.jog("1=+", command=[BIN / "axisctl", "--target", relay.path])
        renewals = relay.until_stream_of(5)
        os.kill(jog.process.pid, signal.SIGSTOP)
        motion = self.assert_stopped("silent for 500 ms")
        earliest, latest = self.stop_written("silent for 500 ms")
        self.tell(renewals[-1], earliest, latest, "the last renewal")
        self.assertGreaterEqual(latest - renewals[-1], SILENCE_S)
        self.assertLess(earliest - renewals[-1], self.limit_s())
        os.kill(jog.process.pid, signal.SIGCONT)
        self.assertEqual(jog.end(), 1)
        self.assertRegex(jog.errors, r"\Aaxisctl: STOPPED: [^\n]*silent for 500 ms; now axis x at [^\n]*\n\Z")
        self.assertEqual(self.place(), int(motion["results"][0]["command_pulses"]))

    def test_a_halted_caller_at_9600_baud(self):
        self.assert_stops_a_halted_caller(9600)

    def test_a_halted_caller_at_38400_baud(self):
        self.assert_stops_a_halted_caller(38400)

    def test_a_killed_caller(self):
        self.serve()
        jog = self.jog("1=+")
        killed = time.monotonic()
        jog.kill()
        self.assert_stopped("broke off")
        earliest, latest = self.stop_written("broke off")
        self.tell(killed, earliest, latest, "the kill")
        self.assertLess(earliest - killed, self.limit_s() - SILENCE_S)

    def test_an_interrupted_caller_stops_in_order(self):
        self.serve()
        for number, axes in ((signal.SIGINT, ["1=+"]), (signal.SIGHUP, ["x=+"]), (signal.SIGTERM, ["2=-", "x=+"])):
            with self.subTest(number.name):
                jog = self.jog(*axes)
                jog.process.send_signal(number)
                self.assertRegex(jog.until("done"), "^done: .*axis x at ")
                self.assertEqual((jog.end(), jog.errors), (0, ""))
                motion = self.outcome()
                self.assertEqual(motion["state"], "MOTION_STATE_SUCCEEDED", motion)
        self.assertLess(self.place(2), 0)
        self.assert_stands(motion)

    def test_nohup_keeps_a_jog_running(self):
        self.serve()
        jog = self.jog("1=+", command=["nohup", *self.daemon.command()])
        with open(f"/proc/{jog.process.pid}/status", encoding="ascii") as file:
            ignored = int(re.search(r"^SigIgn:\s+(\S+)$", file.read(), re.MULTILINE)[1], 16)
        self.assertTrue(ignored & 1 << (signal.SIGHUP - 1))

    def test_so_many_seconds_as_json(self):
        self.serve()
        ran = self.daemon.run("--json", "jog", "1=+", "--seconds", "1")
        self.assertEqual((ran.returncode, ran.stderr), (0, ""))
        lines = [json.loads(line) for line in ran.stdout.splitlines()]
        states = [line["motion"]["state"] for line in lines if "motion" in line]
        self.assertIn("MOTION_STATE_RUNNING", states)
        self.assertEqual(lines[-1]["motion"]["state"], "MOTION_STATE_SUCCEEDED")
        self.assert_stands(self.outcome())

    def test_a_person_is_told_how_it_ends(self):
        self.serve()
        terminal, far_end = os.openpty()
        self.addCleanup(os.close, terminal)
        self.addCleanup(os.close, far_end)
        ran = subprocess.run(self.daemon.command("jog", "1=+", "2=-", "--seconds", "1"), stdin=far_end,
                             capture_output=True, text=True, timeout=LIMIT_S, check=False)
        self.assertEqual(ran.stderr, "axisctl: jogging axis 1 (x) +, axis 2 -; Ctrl-C stops them\n")
        self.assertEqual(ran.returncode, 0)

    def test_speeds(self):
        self.serve()
        too_fast = self.daemon.run("jog", "1=+", "--speed", "0.6mm/s")
        self.assertRegex(too_fast.stderr, r"\Aaxisctl: TOO_FAST: [^\n]+\n\Z")
        self.assertEqual(too_fast.returncode, 3)
        self.assertNotRegex(self.recording(), '> "(J|G|JD):')
        self.assertEqual(self.place(), 0)
        ran = self.daemon.run("jog", "1=-", "--speed", "0.2mm/s", "--seconds", "1")
        self.assertEqual((ran.returncode, ran.stderr), (0, ""))
        self.assertRegex(self.recording(), r'motion "unix [^>\n]*> "JD:1F20000\\r\\n"')
        self.assertLess(self.place(), -2000)  # twice as far as at S

    def test_what_is_no_direction(self):
        self.serve()
        for word in ("1", "1=", "1=+5mm", "1=++", "x"):
            with self.subTest(word):
                wrong = self.daemon.run("jog", word)
                self.assertEqual(wrong.returncode, 2)
                self.assertEqual(wrong.stderr, f'axisctl: INVALID_REQUEST: "{word}" is not AXIS=+ or AXIS=- (e.g. 1=+ 2=-; '
                                               "`axisctl move` moves by a distance)\n")
        self.assertEqual(self.daemon.run("jog", "w=+").returncode, 2)
        self.assertNotRegex(self.recording(), '> "(J|G):')

    def test_a_travel_limit(self):
        self.serve()
        jog = self.jog("1=+", "--speed", "0.2mm/s")
        motion = self.assert_stopped("came near its travel limit of 0.3mm", "REASON_OUTSIDE_TRAVEL")
        self.assertEqual(jog.end(), 1)
        self.assertRegex(jog.errors, r"\Aaxisctl: OUTSIDE_TRAVEL: [^\n]+\n\Z")
        place = int(motion["results"][0]["command_pulses"])
        print(f"\nthe jog ended {TRAVEL_PULSES - place} pulses before the limit", flush=True)
        self.assertLessEqual(place, TRAVEL_PULSES)
        self.assertGreater(place, 0)

    def test_a_caller_who_is_cut_off(self):
        try:
            namespaces = Namespaces(self.addCleanup)
        except NotHere as why:
            self.skipTest(str(why))
        subprocess.run([BIN / "axisgate-certificates", self.folder, "lab", "gateway", "anna"], check=True,
                       timeout=LIMIT_S)
        program = os.path.join(self.folder, "axisgated-in-its-namespace")
        with open(program, "w", encoding="utf-8") as file:
            file.write(f'#!/bin/sh\nexec {shlex.join(namespaces.inside("daemon", BIN / "axisgated"))} "$@"\n')
        os.chmod(program, 0o700)
        self.serve(tables=NETWORK.replace("FOLDER", self.folder), program=program)
        files = {option: os.path.join(self.folder, name) for option, name in
                 (("--ca", "lab.crt"), ("--certificate", "anna.crt"), ("--key", "anna.key"))}
        address = re.search(r"gRPC with TLS on (\S+)", self.daemon.log())[1]
        jog = self.jog("1=+", command=namespaces.inside("caller", BIN / "axisctl", "--target", address,
                                                        *(word for pair in files.items() for word in pair)))
        namespaces.unplug()
        cut_off = time.monotonic()
        self.assert_stopped("silent for 500 ms")
        earliest, latest = self.stop_written("silent for 500 ms")
        self.tell(cut_off, earliest, latest, "the last packet")
        self.assertLess(earliest - cut_off, self.limit_s())
        self.assertIsNone(jog.process.poll())
        namespaces.plug()
        self.assertEqual(jog.end(), 1)
        self.assertRegex(jog.errors, r"\Aaxisctl: STOPPED: [^\n]*silent for 500 ms[^\n]*\n\Z")


if __name__ == "__main__":
    unittest.main(verbosity=2)
