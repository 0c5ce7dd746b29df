"""Points of paths and of series."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Iterable, List, Tuple

from axisgate.units import Distance


@dataclass(frozen=True)
class Arc:
    """An Arc is a point of a path that is reached along a circle, through another point::

        Arc((0 * mm, 1 * mm), (-1 * mm, 0 * mm))

    A full circle is two arcs. The path has two axes of the same resolution.
    """

    through: Iterable[Distance]
    end: Iterable[Distance]


def raster(x: Iterable[Distance], y: Iterable[Distance]) -> List[Tuple[Distance, Distance]]:
    """Returns the points of a grid, row by row, to and fro: ``raster(columns * um, rows * um)``."""
    there, points = list(x), []
    back = there[::-1]
    for number, row in enumerate(y):
        points += [(column, row) for column in (there if number % 2 == 0 else back)]
    return points
