"""An RML-1 mill in a few lines, for well-formed jobs: where the tool really is, and where it has been.

It follows the RML-1 Programming Guideline (its sections are cited) and shares nothing with the programs under test.
All coordinates are steps of the workpiece system: X and Y from the work origin, Z from Z0, upward positive.

Where Z0 lies between two steps, plot and space commands go to whole steps above or below Z0, !ZM to whole steps of the
machine, and a Z2 that is the top exactly to the top. Nothing is decided, and the answer here is no authority, where

- !ZO is relative and the commanded height is between two steps of the machine (is the new Z0 rounded?);
- a relative !ZM has a fraction, or its sum is less than a step from an end of travel (is the sum judged, or its target?);
- a height is half way between two steps of the machine, or of the workpiece below Z0;
- Z0 is moved, or !ZM relative, without an origin: where Z0 lies is not known then.
"""

import dataclasses
import math
import re

SAME_PLACE = 1e-6  # steps: two crossings of a side by the same line differ by rounding alone

NEAR = 0.01  # steps: how far apart two answers may be

NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)"
BETWEEN = r"(?:[ \t]*,[ \t]*|[ \t]+)"
NAME = r"![ \t]*[A-Z][ \t]*[A-Z]|P[ \t]*[ADRU]|D[ \t]*F|I[ \t]*N|V[ \t]*S|[DFHIMRVWZ@]"
COMMAND = re.compile(rf"({NAME})[ \t]*((?:{NUMBER}(?:{BETWEEN}{NUMBER})*)?)", re.IGNORECASE)
GROUPS_END = re.compile(r"[;\r\n]")
AXIS_VALUE = re.compile(rf"([A-Z])[ \t]*({NUMBER})", re.IGNORECASE)

LOWERING = ("D", "I", "PD")
RAISING = ("M", "R", "PU")
TO_ABSOLUTE = ("D", "M", "PA")
TO_RELATIVE = ("I", "R", "PR")


@dataclasses.dataclass
class Machine:
    """`top`, `up` and `default_z0` speak of machine coordinates; `origin` is X and Y of the work origin from the home
    corner and the distance of Z0 below the top, in mm: None if nothing of them is known. A `z2` or `default_z0` of None is
    the top of travel. With `hold`, plot commands stop at the edge of the area in X and Y."""

    step_mm: float = 0.025
    area: tuple = (203.2, 152.4, 60.5)
    top: int = 0
    up: int = 1
    z1: int = -100
    z2: int | None = None
    origin: tuple | None = (0.0, 0.0, 0.0)
    default_z0: int | None = None
    hold: bool = False


class Bounds:
    def __init__(self):
        self.places = None

    def add(self, place):
        ends = self.places or (place, place)
        self.places = tuple(tuple(map(choose, end, place)) for choose, end in zip((min, max), ends))


class Tool:
    """The tool inside the work area (guideline 5-1): `path` is where it is told to be, `real` where it is."""

    def __init__(self, machine):
        self.up = machine.up
        self.machine_top = machine.top
        self.travel = self.depth = machine.area[2] / machine.step_mm
        if machine.origin is None:
            self._lie_anywhere()
        else:
            self.low = [-machine.origin[axis] / machine.step_mm for axis in (0, 1)]
            self.high = [self.low[axis] + machine.area[axis] / machine.step_mm for axis in (0, 1)]
            self.zero = machine.top - machine.up * machine.origin[2] / machine.step_mm
        self.real = self.path = self.held((0.0, 0.0, self.top()))
        self.bounds = Bounds()
        self.course = []  # the ends of all moves: X and Y from the home corner, Z from the top

    def _lie_anywhere(self):
        """Z0 may be at either end of its travel: the top is as far above it as can be, and the bottom as far below."""
        self.low, self.high = [-math.inf] * 2, [math.inf] * 2
        self.zero = self.machine_top - self.up * self.travel
        self.depth = 2 * self.travel

    def top(self):
        return (self.machine_top - self.zero) * self.up

    def bottom(self):
        return self.top() - self.depth

    def held(self, place):
        x, y = (min(max(place[axis], self.low[axis]), self.high[axis]) for axis in (0, 1))
        return x, y, min(max(place[2], self.bottom()), self.top())

    def follow(self, goal):
        """The path to `goal`: what lies inside the rectangle is driven, nothing moves for the rest."""
        part = self._inside(goal)
        if part is not None:
            entry, leaving = (self.held(tuple(a + t * (b - a) for a, b in zip(self.path, goal))) for t in part)
            self._come_back(entry)
            self.move(leaving)
        self.path = goal

    def _inside(self, goal):
        first, last = 0.0, 1.0
        for axis in (0, 1):
            start, way = self.path[axis], goal[axis] - self.path[axis]
            if way == 0:
                if not self.low[axis] <= start <= self.high[axis]:
                    return None
                continue
            crossings = sorted(((self.low[axis] - start) / way, (self.high[axis] - start) / way))
            first, last = max(first, crossings[0]), min(last, crossings[1])
        return (first, last) if first <= last else None

    def _come_back(self, entry):
        """Guideline 5-1 B 1: Z alone at the place where the tool has waited; else B 2: over the top."""
        if math.dist(self.real[:2], entry[:2]) > SAME_PLACE:
            self.move((*self.real[:2], self.top()))
            self.move((*entry[:2], self.top()))
        self.move(entry)

    def move(self, place):
        alone = math.dist(self.real[:2], place[:2]) <= SAME_PLACE
        if not alone or abs(self.real[2] - place[2]) > SAME_PLACE:
            # The height at which a job begins is none that it drives to (README: bounds).
            first_height = alone and self.bounds.places is None
            self.bounds.add((*self.real[:2], place[2]) if first_height else self.real)
            self.bounds.add(place)
            self.course.append((place[0] - self.low[0], place[1] - self.low[1], place[2] - self.top()))
        self.real = place

    def home(self):
        self.move((*self.real[:2], self.top()))
        self.move(self.held((0.0, 0.0, self.top())))
        self.path = self.real

    def move_zero(self, machine_z):
        """The tool stays where it is, so its coordinate changes."""
        shift = (self.zero - machine_z) * self.up
        self.real, self.path = ((*place[:2], place[2] + shift) for place in (self.real, self.path))
        self.zero = machine_z
        return shift

    def reaches(self, machine_z):
        depth = (self.machine_top - machine_z) * self.up
        return -SAME_PLACE <= depth <= self.travel + SAME_PLACE


class Mill:
    def __init__(self, machine):
        self.machine = machine
        self.tool = Tool(machine)
        self.commanded = list(self.tool.real)  # not rounded: relative sums lose nothing
        self.down = False
        self._defaults()

    def _defaults(self):
        self.absolute = True
        self.z1, self.z2 = self.machine.z1, self.machine.z2

    def execute(self, name, numbers):
        if name in LOWERING + RAISING + ("PA", "PR"):
            self._plot(name, numbers)
        elif name in ("Z", "!ZZ"):
            for place in sets(numbers, 3):
                self._go(dict(enumerate(place)))
        elif name in ("@", "!PZ"):
            self._set_heights(numbers)
        elif name == "!ZM" and numbers:
            self._move_to_machine_z(numbers[0])
        elif name == "!ZO":
            self._set_zero(numbers)
        elif name == "DF":
            self._defaults()
        elif name == "IN":
            self._initialize()
        elif name == "H":
            self.tool.home()
            self._reset()

    def extension(self, text):
        """!ZE: each group moves the axes that it names, from where the last group ended (guideline 3-3)."""
        for group in text.split(":"):
            values = {"XYZ".find(axis.upper()): float(value) for axis, value in AXIS_VALUE.findall(group)}
            values.pop(-1, None)
            self._go(values)

    def _plot(self, name, numbers):
        self.absolute = name in TO_ABSOLUTE or (self.absolute and name not in TO_RELATIVE)
        if name in LOWERING + RAISING:
            self.down = name in LOWERING
        pairs = sets(numbers, 2)
        if pairs or name not in ("PA", "PR"):
            self.commanded[2] = self._height()
            self.tool.follow((*self.tool.path[:2], self.commanded[2]))
        for pair in pairs:
            self._go(dict(enumerate(pair)), hold=self.machine.hold)

    def _height(self):
        if self.down:
            return self.z1
        return self.tool.top() if self.z2 is None else self.z2

    def _go(self, values, hold=False):
        """A held target is driven to; a relative way counts from the one that was asked for."""
        goal = list(self.tool.path)
        for axis, value in values.items():
            self.commanded[axis] = value + (0 if self.absolute else self.commanded[axis])
            goal[axis] = whole(self.commanded[axis])
        self.tool.follow((*self.tool.held(goal)[:2], goal[2]) if hold else tuple(goal))

    def _set_heights(self, numbers):
        if not numbers:
            self.z1, self.z2 = self.machine.z1, self.machine.z2
        if numbers and self.tool.bottom() - SAME_PLACE <= numbers[0] <= 0:
            self.z1 = math.trunc(numbers[0])
        if len(numbers) > 1 and numbers[1] >= 0:
            self.z2 = math.trunc(numbers[1])

    def _machine_z(self, value):
        """The value's fraction is ignored (guideline 3-3)."""
        return math.trunc(value) + (0 if self.absolute else self.tool.zero + self.tool.up * self.commanded[2])

    def _move_to_machine_z(self, value):
        machine_z = self._machine_z(value)
        if self.tool.reaches(whole(machine_z)):
            self.commanded[2], target = ((z - self.tool.zero) * self.tool.up for z in (machine_z, whole(machine_z)))
            self.tool.follow((*self.tool.path[:2], target))

    def _set_zero(self, numbers):
        default = self.machine.top if self.machine.default_z0 is None else self.machine.default_z0
        machine_z = self._machine_z(numbers[0]) if numbers else default
        if self.tool.reaches(machine_z):
            self.commanded[2] += self.tool.move_zero(machine_z)

    def _initialize(self):
        self._defaults()
        self.down = False
        self.tool.move(self.tool.held((*self.tool.real[:2], self._height())))
        self._reset()

    def _reset(self):
        self.absolute = True
        self.down = False
        self.tool.path = self.tool.real
        self.commanded = list(self.tool.real)


def whole(value):
    """Half a step goes away from zero."""
    return math.copysign(math.floor(abs(value) + 0.5), value)


def sets(numbers, size):
    """What is left of a set is not executed (guideline 3-1)."""
    return [numbers[first:first + size] for first in range(0, len(numbers) - size + 1, size)]


def near(place, other):
    return all(abs(a - b) <= NEAR for a, b in zip(place, other, strict=True))


def agree(said, expected):
    final, spread = said
    if not near(final, expected[0]) or (spread is None) != (expected[1] is None):
        return False
    return spread is None or all(near(a, b) for a, b in zip(spread, expected[1]))


def play(job, machine):
    """(final, bounds): bounds is (minimum, maximum), or None if nothing has moved."""
    tool = tool_after(job, machine)
    return tool.real, tool.bounds.places


def tool_after(job, machine):
    mill = Mill(machine)
    text = job.decode("ascii")
    place = 0
    while match := COMMAND.search(text, place):
        name = re.sub(r"[ \t]", "", match[1]).upper()
        place = match.end()
        if name == "!ZE":
            end = GROUPS_END.search(text, place).start()
            mill.extension(text[place:end])
            place = end
        else:
            mill.execute(name, [float(number) for number in re.findall(NUMBER, match[2])])
    return mill.tool
