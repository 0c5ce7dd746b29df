#!/usr/bin/env python3
"""Random RML-1 jobs: what `axisctl mill check` says of the tool's way, against the independent model of mill_oracle.

A quarter of the jobs has no origin; of the others some have Z0 between two steps, some a mill that holds plot commands at
the edge. Avoided is what mill_oracle.py has no answer for: !ZO and relative !ZM without an origin, relative !ZO where
heights may be between two steps, fractions in relative !ZM and !ZO. Sums near the end of travel, and half steps of Z, are
too rare to be met.
"""

import concurrent.futures
import json
import math
import pathlib
import random
import subprocess
import tempfile
import unittest

from mill_oracle import Machine, agree, near, play
from programs import BIN, LIMIT_S

JOBS = 1000
WITHOUT_MOTION = 97  # every so many seeds

PROFILE = """name = "Test mill"
step_mm = {step}
area = {{ x_mm = {x}, y_mm = {y}, z_mm = {z} }}
z = {{ top = {top}, up = {up}, default_z0 = {default_z0} }}
acceleration = {{ best = 200, worst = 100 }}
spindle = {{ speeds = "fixed", minimum_rpm = 6500, maximum_rpm = 6500, spin_up_s = 2 }}
axes = {{ letters = "XYZ" }}
clipping = {{ flat_commands = "{flat}" }}
tool = {{ default_z1 = {z1}{z2} }}
speed = {{ travel = 15, travel_z = 15, cutting_minimum = 0.5, cutting_maximum = 15, cutting_default = 2, \
z_minimum = 0.5, z_maximum = 15, z_default = 2 }}
"""


def profile_of(machine):
    x, y, z = machine.area
    z2 = "" if machine.z2 is None else f", default_z2 = {machine.z2}"
    return PROFILE.format(step=machine.step_mm, x=x, y=y, z=z, top=machine.top, up=machine.up, z1=machine.z1,
                          default_z0=machine.default_z0, z2=z2, flat="hold" if machine.hold else "raise")


def random_machine(chance):
    """The sides and the bottom lie between steps, each at another fraction: no whole target is on one, and no straight
    line of whole targets through a corner is likely."""
    step = chance.choice((0.01, 0.0125, 0.025, 0.05))
    sizes = [chance.randint(400, 8000), chance.randint(400, 6000), chance.randint(200, 3000)]
    area = tuple(round((size + part) * step, 8) for size, part in zip(sizes, (0.23, 0.19, 0.31)))
    parts = (0.37, 0.41, chance.choice((0, 0, 0.43)))
    places = (chance.randint(1, sizes[0] - 2), chance.randint(1, sizes[1] - 2), chance.randint(0, sizes[2] - 1))
    origin = tuple(round((place + part) * step, 8) for place, part in zip(places, parts))
    hold = chance.random() < 0.3
    if chance.random() < 0.25:
        origin, hold = None, False
    top, up = chance.choice((0, 0, chance.randint(-3000, 3000))), chance.choice((1, -1))
    return Machine(step_mm=step, area=area, top=top, up=up, z1=-chance.randint(0, sizes[2]),
                   z2=chance.choice((None, chance.randint(0, sizes[2]))), origin=origin,
                   default_z0=top - up * chance.choice((0, chance.randint(0, sizes[2]))), hold=hold)


class Writer:
    """Well-formed text, in all the ways the guideline allows."""

    def __init__(self, chance):
        self.chance = chance
        self.text = ""

    def command(self, name, numbers=()):
        spelled = name.lower() if self.chance.random() < 0.2 else name
        if len(name) > 1 and self.chance.random() < 0.1:
            spelled = self.chance.choice((" ", "\t", "  ")).join(spelled)
        if name[0].isalpha() and len(name) == 2 and self.chance.random() < 0.1:
            spelled = "^" + spelled
        between = self.chance.choice((",", ",", " ", " , ", "\t"))
        blank = self.chance.choice(("", "", " "))
        self._add(spelled + blank + between.join(self.number(value) for value in numbers), bare=not numbers)

    def extension(self, groups):
        blank = self.chance.choice(("", "", " "))
        texts = [blank.join(axis + blank + self.number(value) for axis, value in group) for group in groups]
        end = self.chance.choice((";", "\n", "\r\n"))
        self.text += "!ZE" + blank + ":".join(texts) + end

    def number(self, value):
        text = str(value) if isinstance(value, int) else f"{value:.4f}"
        return "+" + text if value >= 0 and self.chance.random() < 0.05 else text

    def _add(self, text, bare):
        """A bare D before F would be DF (guideline 2-3), so a bare command gets its terminator."""
        ends = (";", "\n", "\r\n", ";;") if bare else ("", "", ";", "\n", " ", ";\n")
        self.text += text + self.chance.choice(ends)


class JobMaker:
    """Random commands. Without an origin X and Y go as far as with one, and Z as far from Z0 as it may be."""

    def __init__(self, chance, machine):
        self.chance = chance
        self.machine = machine
        self.writer = Writer(chance)
        self.absolute = True
        self.placed = machine.origin is not None
        self.sizes = [length / machine.step_mm for length in machine.area]
        self.travel = self.sizes[2]
        origin = machine.origin or (0.4 * machine.area[0], 0.3 * machine.area[1], 0)
        self.low = [-length / machine.step_mm for length in origin[:2]] + [origin[2] / machine.step_mm - self.travel]
        self.sizes[2] *= 1 if self.placed else 2
        self.whole_heights = chance.random() < 0.7
        self.on_steps = self.whole_heights and abs(self.low[2] + self.travel - round(self.low[2] + self.travel)) < 1e-3

    def job(self):
        if self.chance.random() < 0.3:
            self._heights_only()
            if self.chance.random() < 0.3:
                return self._bytes()
        self.writer.command("!ZZ", self._inside_xy() + [self._above()])
        steps = [self._plot, self._plot, self._plot, self._space, self._space, self._extension, self._extension,
                 self._heights, self._there_and_back, self._speed, self._mode, self._reset, self._machine_z, self._zero]
        for _ in range(self.chance.randint(3, 40)):
            self.chance.choice(steps)()
        if self.placed and self.chance.random() < 0.3:
            self._mode(("I", "R"))
            self._machine_z()
        return self._bytes()

    def still_job(self):
        steps = [self._speed, self._mode, self._heights, self._zero]
        for _ in range(self.chance.randint(1, 10)):
            self.chance.choice(steps)()
        return self._bytes()

    def _bytes(self):
        return (self.writer.text + ";\n").encode("ascii")

    def _heights_only(self):
        self._heights()
        self.writer.command(self.chance.choice(("PD", "PU", "D", "M")))
        self._machine_z()

    def _inside_xy(self):
        return [int(self.low[axis] + self.chance.uniform(0.1, 0.9) * self.sizes[axis]) or 1 for axis in (0, 1)]

    def _above(self):
        return int(self.low[2] + self.sizes[2] * self.chance.uniform(1.1, 1.6)) + 2

    def _value(self, axis):
        size = self.sizes[axis]
        if self.absolute:
            value = self.low[axis] + self.chance.uniform(-0.4, 1.4) * size
        else:
            value = self.chance.uniform(-0.6, 0.6) * size
        if axis == 2 and self.whole_heights:
            return int(value)
        kind = self.chance.random()
        if kind < 0.05 and axis < 2:
            return int(value) + 0.5
        return round(value, 4) if kind < 0.3 else int(value)

    def _values(self, axes, least):
        """Now and then with a rest that is no whole set."""
        sets = self.chance.choice((least, 1, 1, 2, 3, 5))
        values = [self._value(axis) for _ in range(sets) for axis in axes]
        if values and self.chance.random() < 0.1:
            values += [self._value(axis) for axis in axes[:self.chance.randint(1, len(axes) - 1)]]
        return values

    def _set_mode(self, name):
        if name in ("D", "M", "PA", "H", "IN", "DF"):
            self.absolute = True
        elif name in ("I", "R", "PR"):
            self.absolute = False

    def _plot(self):
        name = self.chance.choice(("PU", "PD", "PD", "PA", "PR", "D", "D", "I", "M", "R"))
        self._set_mode(name)
        values = self._values((0, 1), least=0)
        if name in ("PU", "PD") and self.chance.random() < 0.03:
            values = [self._value(0)]  # guideline 2-5: one parameter; the tool moves, X and Y do not
        self.writer.command(name, values)

    def _space(self):
        self.writer.command(self.chance.choice(("Z", "!ZZ")), self._values((0, 1, 2), least=1))

    def _extension(self):
        groups = []
        for _ in range(self.chance.randint(1, 4)):
            axes = self.chance.sample((0, 1, 2), self.chance.randint(0, 3))
            groups.append([(self.chance.choice(("XYZ"[axis], "xyz"[axis])), self._value(axis)) for axis in axes])
        self.writer.extension(groups)

    def _heights(self):
        z1 = -self.chance.randint(0, int(self.travel)) if self.chance.random() < 0.9 else self.chance.randint(1, 50)
        z1 = int(self.low[2] * 2) - 9 if self.chance.random() < 0.05 else z1
        z2 = self.chance.randint(-20, int(self.travel * 1.3))
        self.writer.command(self.chance.choice(("@", "!PZ")), self.chance.choice(((), (z1,), (z1, z2), (z1, z2))))

    def _machine_value(self):
        """A fraction, which is ignored, only far from the ends of travel: it could make the difference there."""
        if not self.absolute:
            return self.chance.randint(-int(self.travel * 0.4), int(self.travel * 0.4))
        depth = self.chance.uniform(-0.1, 1.1) * self.travel
        if self.chance.random() < 0.15:
            depth = 0
        value = int(self.machine.top - self.machine.up * depth)
        far = 0.1 * self.travel < depth < 0.9 * self.travel
        return value + math.copysign(0.7, value) if far and self.chance.random() < 0.2 else value

    def _machine_z(self):
        if self.placed or self.absolute:
            self.writer.command("!ZM", [self._machine_value()] if self.chance.random() < 0.95 else [])

    def _zero(self):
        if self.placed and (self.absolute or self.on_steps):
            self.writer.command("!ZO", [self._machine_value()] if self.chance.random() < 0.8 else [])

    def _there_and_back(self):
        """Out of the area and back on the same line: only Z may move where the tool has waited (guideline 5-1 B 1)."""
        self._mode(("PA",))
        x, y = self._inside_xy()
        away = [x + self.chance.choice((-1, 1)) * int(self.sizes[0] * 1.5), y + self.chance.randint(-9, 9)]
        self.writer.command("Z", [x, y, self._value(2), *away, self._value(2)])
        if self.chance.random() < 0.5:
            self.writer.command("Z", [x, y, self._value(2)])
        else:
            self.writer.command(self.chance.choice(("PU", "PD")), [x, y])

    def _speed(self):
        name = self.chance.choice(("F", "VS", "V", "!VZ", "W", "!DW", "!MC", "!RC"))
        ranges = {"W": 900, "!DW": 900, "!MC": 1}
        value = self.chance.randint(0 if name in ranges else 1, ranges.get(name, 15))
        self.writer.command(name, [value] if self.chance.random() < 0.8 else [])

    def _mode(self, names=("PA", "PR", "DF")):
        name = self.chance.choice(names)
        self._set_mode(name)
        self.writer.command(name)

    def _reset(self):
        """IN may leave the tool on a side of the area, where Z alone would go along it: M leads away from there."""
        name = self.chance.choice(("H", "IN"))
        self._set_mode(name)
        self.writer.command(name)
        if name == "IN":
            self.writer.command("M", self._inside_xy())


def random_case(seed):
    chance = random.Random(seed)
    machine = random_machine(chance)
    maker = JobMaker(chance, machine)
    return machine, maker.still_job() if seed % WITHOUT_MOTION == 0 else maker.job()


def places_of(line):
    bounds = line.get("bounds")
    spread = None if bounds is None else tuple(tuple(bounds[end][axis] for axis in "xyz") for end in ("min", "max"))
    return tuple(line["final"][axis] for axis in "xyz"), spread


class RandomJobs(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axisctl-mill-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def check(self, seed):
        machine, job = random_case(seed)
        path, profile = self.folder / f"{seed}.rml", self.folder / f"{seed}.toml"
        path.write_bytes(job)
        profile.write_text(profile_of(machine), encoding="utf-8")
        origin = ["--origin", ",".join(map(str, machine.origin))] if machine.origin else []
        answer = subprocess.run([BIN / "axisctl", "mill", "check", path, "--profile", profile, *origin, "--json"],
                                capture_output=True, text=True, timeout=LIMIT_S, check=False)
        return machine, job, answer

    def test_the_tool_ends_and_has_been_where_the_model_says(self):
        with concurrent.futures.ThreadPoolExecutor(max_workers=2) as pool:
            for seed, (machine, job, answer) in enumerate(pool.map(self.check, range(JOBS))):
                with self.subTest(seed=seed):
                    case = f"seed {seed}\n{machine}\n{job!r}\n{answer.stderr}"
                    self.assertIn(answer.returncode, (0, 1), case)
                    self.assertTrue(answer.stdout.strip(), case)
                    said = places_of(json.loads(answer.stdout.strip().splitlines()[-1]))
                    expected = play(job, machine)
                    self.assertTrue(agree(said, expected), f"{case}\nexpected {expected}\nsaid     {said}")


class OracleByHand(unittest.TestCase):
    """400 by 320 by 200 steps: X from -100 to 300, Y from -100 to 220, Z from -150 to 50."""

    MACHINE = {"step_mm": 0.025, "area": (10, 8, 5), "origin": (2.5, 2.5, 1.25), "z1": -100}

    def plays(self, job, final, *bounds, **changes):
        said = play(job, Machine(**{**self.MACHINE, **changes}))
        self.assertTrue(near(said[0], final), said)
        if bounds:
            self.assertTrue(agree(said, (final, bounds)), said)
        return said

    def test_nothing_moves(self):
        self.assertEqual(play(b"F5;PR;@-5,5;!MC0;V 2;Z1,2;!ZE::;", Machine(**self.MACHINE)), ((0, 0, 50), None))

    def test_two_dimensions(self):
        self.plays(b"PU100,50;PD;PU;", (100, 50, 50), (0, 0, -100), (100, 50, 50))
        self.plays(b"PD100,50;", (100, 50, -100), (0, 0, -100), (100, 50, -100))
        self.plays(b"PD;", (0, 0, -100), (0, 0, -100), (0, 0, -100))
        self.plays(b"H;PD;", (0, 0, -100), (0, 0, -100), (0, 0, -100))
        self.plays(b"PA;PD5,5,7;PR1,1;DF;PA2,2", (2, 2, -100))
        self.plays(b"PU5,5;", (5, 5, 20), (0, 0, 20), (5, 5, 20), z2=20)

    def test_modes(self):
        self.plays(b"i10,20,1,2m5,5r1,1^pd 1 1", (7, 7, -100), (0, 0, -100), (11, 22, 50))
        self.plays(b"D;Z1,1,-5;PA9,9;", (9, 9, -100))
        self.plays(b"!ZE X10 z -20:y5X1;\nPR;!ZEZ1:Z1\n! Z M 7;", (1, 5, -11))
        self.plays(b"PR;P R 0.4,-.3;PR0.1,-.3", (1, -1, 50))
        self.plays(b"PA100.5,-2.5;PR0,0;", (101, -3, 50))

    def test_heights(self):
        self.plays(b"@-20,10;PD;PU;", (0, 0, 10))
        self.plays(b"@-200,10;PD1,1;", (1, 1, -100))
        self.plays(b"!PZ1,10;PU1,1;", (1, 1, 10))
        self.plays(b"!PZ-20,-1;PU1,1;PD;@;PD;", (1, 1, -100))
        self.plays(b"@-20,90;PU1,1;PR;Z0,0,-60;", (1, 1, 30))  # from the commanded 90, not from the top at 50

    def test_above_and_below(self):
        self.plays(b"Z100,0,500;", (100, 0, 50), (0, 0, 50), (100, 0, 50))
        self.plays(b"Z100,0,-500,120,0,-500;", (120, 0, -150), (0, 0, -150), (120, 0, 50))

    def test_the_tool_waits_and_comes_back(self):
        self.plays(b"D100,0,400,0;", (300, 0, -100), (0, 0, -100), (300, 0, -100))
        self.plays(b"D100,0,400,0,400,100,0,100", (0, 100, -100), (0, 0, -100), (300, 100, 50))
        self.plays(b"PD;!ZZ500,0,-100,100,0,-140;", (100, 0, -140), (0, 0, -140), (300, 0, -100))
        self.plays(b"PD;!ZZ500,0,-100;!ZM-190;PU", (300, 0, -100))
        self.plays(b"PD400,0,400,400,-400,-300;", (-100, -37.5, -100), (-100, -37.5, -100), (300, 220, 50))

    def test_a_reset_outside(self):
        self.plays(b"PD400,10;H;", (0, 0, 50))
        self.plays(b"PD400,8;IN;PR-10,0;", (290, 6, 50), (0, 0, -100), (300, 6, 50))
        self.plays(b"PD400,8;IN;", (300, 6, 30), z2=30)

    def test_machine_coordinates(self):
        self.plays(b"!ZM-60.9;", (0, 0, -10))
        self.plays(b"!ZM1;!ZM-201;", (0, 0, 50))
        self.plays(b"PR;!ZM-60;!ZM-10;", (0, 0, -20))
        self.plays(b"!ZM1060;PR;!ZM10;", (0, 0, -20), top=1000, up=-1)

    def test_the_origin_of_z(self):
        self.plays(b"!ZO-150;", (0, 0, 150))
        self.plays(b"!ZM-60;PR;!ZO-5;", (0, 0, 5))
        self.plays(b"!ZM-60;!ZO;", (0, 0, -60))
        self.plays(b"!ZO-150;PD;PU1,1;", (1, 1, 150), (0, 0, -50), (1, 1, 150))
        self.plays(b"!ZO1060;PR;Z1,1,-20;", (1, 1, 40), top=1000, up=-1)

    def test_an_origin_outside(self):
        self.plays(b"PU110,1;H;", (100, 0, 50), (100, 0, 50), (110, 1, 50), origin=(-2.5, 2.5, 1.25))

    def test_without_an_origin(self):
        """Z from -200 to 200, and 200 is machine coordinate 0."""
        self.assertEqual(play(b"H;IN;", Machine(origin=None, area=(10, 8, 5))), ((0, 0, 200), None))
        self.plays(b"PD;", (0, 0, -100), (0, 0, -100), (0, 0, -100), origin=None)
        self.plays(b"H;PD;PU;", (0, 0, 200), (0, 0, -100), (0, 0, 200), origin=None)
        self.plays(b"PD900,-900;", (900, -900, -100), (0, -900, -100), (900, 0, -100), origin=None)
        self.plays(b"Z1,1,-500;", (1, 1, -200), (0, 0, -200), (1, 1, 200), origin=None)
        self.plays(b"@-200,9;PD;@-201;PU;PD;", (0, 0, -200), (0, 0, -200), (0, 0, 9), origin=None)
        self.plays(b"!ZM-200;!ZM1;!ZM-201;", (0, 0, 0), (0, 0, 0), (0, 0, 0), origin=None)
        self.plays(b"!ZM1060;", (0, 0, 140.4), top=1000, up=-1, area=(10, 8, 5.01), origin=None)

    def test_z0_between_steps(self):
        """Z from -149.6 to 50.4: a whole machine coordinate is a step and 0.4."""
        between = {"origin": (2.5, 2.5, 1.26)}
        self.plays(b"PD;PU;", (0, 0, 50.4), (0, 0, -100), (0, 0, 50.4), **between)
        self.plays(b"!ZM-60.9;PR;!ZM-4;!ZE X1;", (1, 0, -13.6), (0, 0, -13.6), (1, 0, -9.6), **between)
        self.plays(b"!ZM1060;", (0, 0, -9.6), top=1000, up=-1, **between)
        self.plays(b"PD;PR;!ZM0;", (0, 0, -99.6), **between)
        self.plays(b"PD;PR;!ZM0;Z0,0,.2;", (0, 0, -100), **between)  # -100 + 0.2, not -99.6 + 0.2
        self.plays(b"!ZO-60;PR;Z0,0,-7.1;", (0, 0, 53), (0, 0, 53), (0, 0, 53), **between)

    def test_held_at_the_edge(self):
        for job, down in ((b"PD400,8;", 1), (b"D400,8;", 1), (b"I400,8;", 1), (b"PU400,8;", 0), (b"PA400,8;", 0)):
            height = -100 if down else 50
            self.plays(job, (300, 8, height), (0, 0, height), (300, 8, height), hold=True)
        self.plays(b"PD-150,230;PU;", (-100, 220, 50), (-100, 0, -100), (0, 220, 50), hold=True)
        self.plays(b"PD400,400;PR-50,-50,-100,-200;", (250, 150, -100), (0, 0, -100), (300, 220, -100), hold=True)
        self.plays(b"PD400,8;PR;Z-150,0,20;", (250, 8, -80), hold=True)
        self.plays(b"PD400,8;!ZEY20;", (300, 20, -100), hold=True)
        self.plays(b"PD;Z400,8,-100;", (300, 6, -100), hold=True)


if __name__ == "__main__":
    unittest.main()
