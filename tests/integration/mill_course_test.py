#!/usr/bin/env python3
"""Jobs that the daemon sends to mills behind pseudo-terminals: what each mill did by its own record, beside what `axisctl
mill check` says of the job, and beside the model of mill_oracle.py. Path, final place and duration are compared.

Random jobs are those of mill_oracle_test.py; the others are all under tests/: the files, the guideline's examples and its
cases of clipping. A job that the check finds an error in is refused by the daemon, and counted. AXISGATE_MILL_JOBS=1000
sends so many random jobs and all others; the ordinary run sends 10 of each kind. AXISGATE_COURSE_SEED repeats a failure.

The mills run 10,000 times as fast, and the gateway's time does not. So the duration is what the mill's own movements and
waits add up to; the time in which it waited for bytes is left out, and the profiles need no time to accelerate, so that
both ends of the check's range are the same. When a mill has executed its job an abort ends what the gateway still awaits.
"""

import concurrent.futures
import dataclasses
import json
import math
import os
import pathlib
import random
import re
import subprocess
import tempfile
import unittest

from mill_oracle import Machine, agree, tool_after
from mill_oracle_test import JobMaker, places_of, profile_of, random_machine
from mill_pty import CONFIG, Gateway, PtyMill, commands
from programs import BIN, LIMIT_S, ROOT, Daemon

JOBS = int(os.environ.get("AXISGATE_MILL_JOBS", "10"))
SEED = int(os.environ.get("AXISGATE_COURSE_SEED", random.randrange(1_000_000)))
ALL_FROM = 1000  # so many random jobs mean all the others, too
MILLS = 3
SPEED = 10_000
PART, INSTANT_S = 0.05, 0.01  # by which durations may differ
SAME_STEPS = 0.01
BEFORE = "H;"  # the tool may be where the last job has left it
SETTINGS = """streaming = "full"
converter = 20480
[[device.origin]]
name = "here"
x = {}
y = {}
"""
EPILOGUE = ["PA", "!VZ", "!ZM", "!MC", "DF", "!MC"]


def without_acceleration(profile):
    text, count = re.subn(r"(?m)^acceleration = .*$",
                          "acceleration = { best = 1000000, worst = 1000000 }", profile)
    if count != 1:
        raise AssertionError("the profile has no acceleration")
    return text


def whole_machine(chance):
    """With whole steps as its sides and as its origin, and Z0 as the daemon takes it of an origin with a name. Where the area
    ends between two steps, the model drives to its very end, the simulated mill to the last whole step, and no source
    says what a mill does. And none that holds plot commands at the edge: the two differ in where such a command begins
    after a three-axis one that has left the area."""
    while (machine := random_machine(chance)).origin is None:
        pass
    area, origin = (tuple(round(math.floor(length / machine.step_mm) * machine.step_mm, 8) for length in lengths)
                    for lengths in (machine.area, machine.origin))
    zero = machine.top - machine.up * round(origin[2] / machine.step_mm)
    return dataclasses.replace(machine, area=area, origin=origin, default_z0=zero, z2=None, hold=False)


class SoundJobs(JobMaker):
    """With fewer errors, for which the daemon refuses a job: no cuts larger than the machine, though some leave it. And
    without half steps, which may be rounded either way, and without a Z2 above the top, where the check may count a
    difference by rounding as the first height of a job."""

    def _value(self, axis):
        value = super()._value(axis)
        if axis < 2:
            value = self.low[axis] + (value - self.low[axis]) / 1.9 if self.absolute else value / 6.1
        rounded = round(value, 4) if self.chance.random() < 0.2 else int(value)
        return int(rounded) if rounded % 1 == 0.5 else rounded

    def _values(self, axes, least):
        values = super()._values(axes, least)
        return values[:len(values) - len(values) % len(axes)]

    def _heights(self):
        z1 = -self.chance.randint(0, int(-self.low[2]))
        z2 = self.chance.randint(0, max(0, int(self.low[2] + self.travel) - 1))
        self.writer.command(self.chance.choice(("@", "!PZ")), self.chance.choice(((), (z1,), (z1, z2))))

    def _machine_value(self):
        if not self.absolute:
            return super()._machine_value()
        return int(self.machine.top - self.machine.up * self.chance.uniform(0, 1) * self.travel)


class Checked:
    """What `axisctl mill check` says."""

    def __init__(self, profile, job, *options):
        answer = subprocess.run([BIN / "axisctl", "mill", "check", "-", "--profile", profile, "--json", *options],
                                input=job, capture_output=True, timeout=LIMIT_S, check=False)
        *_, self.summary = map(json.loads, answer.stdout.decode().splitlines())
        self.errors = self.summary["errors"]


class Course:
    """What the mill has done of one job, by the lines of its record."""

    def __init__(self, entries, start):
        self.places, self.seconds, self.steps = [tuple(map(float, start))], 0.0, 0.0
        for entry in entries:
            if "path" in entry:
                begin, end = entry["path"]
                self.places.append(tuple(map(float, end)))
                self.steps += math.dist(begin, end)
                self.seconds += entry["t"] - entry["began"]
            elif "wait" in entry:
                self.seconds += entry["seconds"]

    def passes(self, expected):
        """Whether all these places are on the path, in their order."""
        at = 0
        for place in expected:
            found = next((i for i in range(at, len(self.places)) if self._is_on_way_to(i, place)), None)
            if found is None:
                return False
            at = found
        return True

    def _is_on_way_to(self, number, place):
        end = self.places[number]
        begin = self.places[max(number - 1, 0)]
        return math.dist(begin, place) + math.dist(place, end) <= math.dist(begin, end) + SAME_STEPS


class CourseMill:
    """A mill with its machine. One job at a time."""

    def __init__(self, folder, name, machine):
        self.machine = machine
        self.place = [round(part / machine.step_mm) for part in machine.origin]
        settings = SETTINGS.format(*self.place)
        self.pty = PtyMill(folder, name, without_acceleration(profile_of(machine)), "xon", "--baud", 0, "--speed", SPEED,
                           settings=settings)
        self.refused = 0

    def run(self, gateway, job):
        """(check, course) of one job, or nothing where it is refused."""
        text = BEFORE.encode() + job + b";"
        checked = Checked(self.pty.profile, text, "--origin", ",".join(map(str, self.machine.origin)))
        if checked.errors:
            self.refused += 1
            return None
        self.pty.say(f"origin {self.place[0]} {self.place[1]}")
        self.pty.say(f"z0 {self.machine.top - self.machine.up * self.place[2]}")
        first = len(self.pty.read())
        number = gateway.start(text.decode("latin-1"), "--origin", "here")
        self.pty.await_true(lambda entries: has_ended(entries[first:]), "the job does not end", 2 * LIMIT_S)
        ended = gateway.run("mill", "abort")
        if ended.returncode != 0:
            raise AssertionError(ended.stderr)
        self.finish(gateway, number)
        return checked, Course(of_job(self.pty.read()[first:]), [self.place[0], self.place[1], 0])

    def finish(self, gateway, number):
        """A short job may be FED already."""
        gateway.run("mill", "done", number)
        self.pty.await_true(lambda entries: [one["command"] for one in commands(entries)[-3:]] == ["!VZ", "!ZM", "!MC"],
                            "the abort does not come")
        self.pty.person.await_state(moving="no", buffered="0", discarding="no")


def has_ended(entries):
    return [entry["command"] for entry in commands(entries)[-len(EPILOGUE):]] == EPILOGUE


def of_job(entries):
    """From the command behind BEFORE to the last one before the epilogue of the gateway."""
    begins = [i for i, entry in enumerate(entries) if "command" in entry]
    names = [entries[i]["command"] for i in begins]
    end = next(i for i in range(len(names) - len(EPILOGUE), -1, -1) if names[i:i + len(EPILOGUE)] == EPILOGUE)
    if names[:2] != ["DF", "H"]:
        raise AssertionError(f"the job begins with {names[:2]}")
    return entries[begins[2]:begins[end]]


def typed_jobs():
    """(where, job): of the files, and of the paragraphs of examples and clipping."""
    jobs = [(path.name, path.read_bytes()) for path in sorted((ROOT / "tests").rglob("*"))
            if path.suffix in (".rml", ".prn")]
    for path in sorted((ROOT / "tests" / "rml1").glob("*/*.txt")):
        for number, paragraph in enumerate(re.split(r"\n\n+", path.read_text(encoding="latin-1"))):
            for mark in ("<", "job"):
                lines = re.findall(rf"(?m)^{mark} (.*)$", paragraph)
                if lines:
                    text = "".join(lines) if mark == "job" else unescaped(lines[0])
                    jobs.append((f"{path.name}, paragraph {number}", text.encode("latin-1")))
    # !NR waits for a person, and half a step may be rounded either way.
    return [(where, re.sub(rb"(?i)!NR", b";", job)) for where, job in jobs if b".5" not in job]


def unescaped(text):
    meant = {"r": "\r", "n": "\n", "t": "\t", "e": "\x1b", "s": " ", "\\": "\\"}
    return re.sub(r"\\(?:x([0-9a-fA-F]{2})|(.))", lambda m: chr(int(m[1], 16)) if m[1] else meant[m[2]], text)


class Courses(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisgate-mill-courses-")
        self.addCleanup(folder.cleanup)
        folder = pathlib.Path(folder.name)
        self.chance = random.Random(SEED)
        mills = [CourseMill(folder, f"mill-{i}", whole_machine(random.Random(f"{SEED} {i}"))) for i in range(MILLS)]
        self.typed_mill = CourseMill(folder, "typed", Machine(
            step_mm=0.025, area=(203.2, 152.4, 60.5), origin=(100.0, 75.0, 30.0), default_z0=-1200, z2=300))
        self.mills = mills
        for mill in (*mills, self.typed_mill):
            self.addCleanup(mill.pty.end)
        tables = "".join(mill.pty.table for mill in (*mills, self.typed_mill))
        self.daemon = Daemon(str(folder), CONFIG + tables)
        self.addCleanup(self.daemon.stop)

    def expect_same(self, mill, checked, course, job):
        """The check and the mill: length, duration, and place in X and Y."""
        summary, step = checked.summary, mill.machine.step_mm
        where = f"{job!r}\n{mill.machine}\n{summary}\n{course.places}, {course.seconds} s"
        self.assertAlmostEqual(course.steps * step, summary["distance_mm"], delta=1e-3 + 1e-6 * course.steps, msg=where)
        low, high = summary["seconds"]["low"], summary["seconds"]["high"]
        self.assertGreaterEqual(course.seconds, low * (1 - PART) - INSTANT_S, where)
        self.assertLessEqual(course.seconds, high * (1 + PART) + INSTANT_S, where)
        for axis, name in enumerate("xy"):
            self.assertAlmostEqual(course.places[-1][axis] - mill.place[axis], summary["final"][name],
                                   delta=SAME_STEPS, msg=where)
        return abs(course.seconds / high - 1) if high > 1 else 0

    def run_random(self, mill, count, index):
        """The most by which a duration differed."""
        gateway, most, ran = Gateway(self.daemon, mill.pty), 0, 0
        for attempt in range(100 * count):
            if ran == count:
                break
            job = SoundJobs(random.Random(f"{SEED} {index} {attempt}"), mill.machine).job()
            done = mill.run(gateway, job)
            if done is None:
                continue
            ran += 1
            most = max(most, self.expect_same(mill, *done, job))
            checked, course = done
            tool = tool_after(BEFORE.encode() + job, mill.machine)
            where = f"{job!r}\n{mill.machine}\nexpected {tool.course}\nthe mill {course.places}"
            self.assertTrue(agree(places_of(checked.summary), (tool.real, tool.bounds.places)), where)
            self.assertTrue(course.passes(tool.course), where)
            end = tool.course[-1] if tool.course else course.places[0]
            self.assertLessEqual(math.dist(course.places[-1], end), SAME_STEPS, where)
        self.assertEqual(ran, count)
        return most

    def test_random_jobs(self):
        shares = [JOBS // MILLS + (i < JOBS % MILLS) for i in range(MILLS)]
        with concurrent.futures.ThreadPoolExecutor(max_workers=MILLS) as pool:
            results = [pool.submit(self.run_random, mill, share, i)
                       for i, (mill, share) in enumerate(zip(self.mills, shares))]
        for i, result in enumerate(results):
            with self.subTest(f"AXISGATE_COURSE_SEED={SEED} AXISGATE_MILL_JOBS={JOBS}, mill {i}"):
                most = result.result()
                print(f"mill {i}: {shares[i]} jobs, {self.mills[i].refused} more refused, durations differ by {most:.4%}")

    def test_typed_jobs(self):
        mill, jobs = self.typed_mill, typed_jobs()
        self.assertGreater(len(jobs), 600)
        gateway, most, ran = Gateway(self.daemon, mill.pty), 0, 0
        for where, job in jobs if JOBS >= ALL_FROM else self.chance.sample(jobs, 3 * JOBS):
            with self.subTest(f"{where}, AXISGATE_COURSE_SEED={SEED}"):
                done = mill.run(gateway, job)
                if done is not None:
                    ran, most = ran + 1, max(most, self.expect_same(mill, *done, job))
        print(f"{ran} typed jobs, {mill.refused} refused, durations differ by {most:.4%}")
        self.assertGreater(ran, 0)


if __name__ == "__main__":
    unittest.main()
