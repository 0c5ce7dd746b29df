"""Figures, the goals that they are judged by, and the table of both. Nothing here measures."""

import collections
import dataclasses
import statistics

ADVISORY_LOAD = 1.5  # above it a p99 is the machine's as much as the daemon's


@dataclasses.dataclass(frozen=True)
class Limit:
    value: float
    at_least: bool = False

    def admits(self, figure):
        return figure >= self.value if self.at_least else figure <= self.value

    def __str__(self):
        return f"{'≥' if self.at_least else '≤'} {shown(self.value)}"


@dataclasses.dataclass
class Row:
    goal: str
    what: str
    build: str
    values: list  # one a repetition; empty: not measured, and `absolute` says why
    limit: Limit | None = None
    absolute: str = ""
    unit: str = ""
    tail: bool = False  # a p99
    load: float = 0  # the load average when it was measured

    @property
    def figure(self):
        return statistics.median(self.values) if self.values else None

    @property
    def met(self):
        if self.limit is None or not self.values:
            return None
        return self.limit.admits(self.figure)

    def cells(self):
        return (self.goal, self.what, self.build, self._measured(), str(self.limit or ""), self._judgement(),
                self.absolute)

    def _measured(self):
        if not self.values:
            return "–"
        spread = f" ({shown(min(self.values))} to {shown(max(self.values))})" if len(self.values) > 1 else ""
        return shown(self.figure) + (f" {self.unit}" if self.unit else "") + spread

    def _judgement(self):
        if self.met is None:
            return "–"
        advisory = f", advisory at load {self.load:.1f}" if self.tail and self.load > ADVISORY_LOAD else ""
        return ("yes" if self.met else "no") + advisory


class Series(collections.defaultdict):
    """The values of each key, one a repetition."""

    def __init__(self):
        super().__init__(list)

    def median(self, *key):
        return statistics.median(self[key])

    def add(self, *key_and_value):
        *key, value = key_and_value
        self[tuple(key)].append(value)


def ratios(values, *parts):
    """Of each repetition: its value beside the sum of its parts."""
    return [value / sum(together) for value, *together in zip(values, *parts, strict=True)]


def shown(number):
    """With as many digits as it deserves."""
    if number == int(number):
        return f"{int(number):,}"
    digits = 0 if abs(number) >= 100 else 1 if abs(number) >= 10 else 2 if abs(number) >= 2 else 3
    return f"{number:,.{digits}f}"


def table(head, rows):
    """Markdown."""
    rows = [head, *rows]
    widths = [max(len(str(row[column])) for row in rows) for column in range(len(head))]
    lines = ["| " + " | ".join(str(cell).ljust(width) for cell, width in zip(row, widths)) + " |" for row in rows]
    lines.insert(1, "|" + "|".join("-" * (width + 2) for width in widths) + "|")
    return "\n".join(lines)


HEAD = ("goal", "what", "build", "measured (from to)", "limit", "met", "absolute")


def table_of_goals(rows):
    return table(HEAD, [row.cells() for row in rows])


def summary(rows):
    judged = [row for row in rows if row.met is not None]
    return f"{sum(row.met for row in judged)} of {len(judged)} judged figures meet their goal"
