"""The choice of axes by a program."""

from __future__ import annotations

from typing import Any, Collection, Dict, Iterable, List, Mapping, Sequence, TypeVar, Union

from axisgate.state import Status, axis_in, known_axes
from axisgate.units import Distance

_Axis = TypeVar("_Axis", bound=Any)


def find_axis(axes: Mapping[str, _Axis], wanted: Union[str, int]) -> _Axis:
    """Returns an axis by its name or number. Raises KeyError."""
    for one in axes.values():
        if wanted in (one.name, one.number, str(one.number)):
            return one
    raise KeyError(f"{wanted}: the axes are {', '.join(axes)}")


def names_of(axes: Sequence[str], known: Collection[str]) -> List[str]:
    """Returns the names of axes: of one, or of each letter of a text such as "xy"."""
    return [axes] if isinstance(axes, str) and axes in known else list(axes)


def not_homed(status: Status, names: Sequence[str]) -> List[str]:
    """Returns the axes with these names, or without names all, that the daemon has not homed. Raises Unavailable while
    the daemon does not know the axes."""
    return [name for name in names or known_axes(status) if not axis_in(status, name).homed]


def targets_of(names: Sequence[str], point: Iterable[Distance]) -> Dict[str, Distance]:
    """Returns the targets of a move to a point. Raises ValueError if the point has other axes."""
    distances: List[Distance] = [point] if isinstance(point, Distance) else [*point]
    if len(distances) != len(names):
        raise ValueError(f"a point has {len(distances)} distances for {len(names)} axes")
    return dict(zip(names, distances))
