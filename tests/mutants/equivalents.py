"""Mutants of which nothing can tell the original: which, and why."""

import dataclasses
import pathlib

from drawing import CannotRun

FILE = pathlib.Path(__file__).resolve().parent / "equivalent.txt"


@dataclasses.dataclass(frozen=True)
class Equivalent:
    path: str
    line: int  # when it was written down; not looked at
    column: int
    kind: str
    text: str
    reason: str

    def is_of(self, mutation):
        """The column distinguishes mutations of one kind on one line."""
        return (self.path, self.text, self.column, self.kind) == (
            mutation.path, without_comment(mutation.text), mutation.column, mutation.kind)


def without_comment(line):
    """The line's code: a comment may be reworded."""
    return line.partition("  //")[0].rstrip()


def parse(content):
    """Entries of an id, the line of the source, and a reason on one line or more; blank lines part them."""
    entries, block = [], []
    for number, line in enumerate([*content.split("\n"), ""], start=1):
        if line.startswith("#"):
            continue
        if line.strip():
            block.append(line.strip())
        elif block:
            entries.append(_entry(block, number))
            block = []
    return entries


def _entry(block, number):
    parts = block[0].split(":")
    if len(block) < 3 or len(parts) != 4 or not parts[1].isdigit() or not parts[2].isdigit():
        raise CannotRun(f"{FILE.name}: the entry before line {number} is not an id, a line of source, and a reason")
    return Equivalent(parts[0], int(parts[1]), int(parts[2]), parts[3], block[1], " ".join(block[2:]))


def load():
    return parse(FILE.read_text(encoding="utf-8"))


def reason_for(mutation, entries):
    """Why the mutant is equivalent, or None."""
    return next((entry.reason for entry in entries if entry.is_of(mutation)), None)
