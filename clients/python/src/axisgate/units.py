"""Distances and speeds with their units.

``1.5 * mm`` is a distance, ``200 * um / s`` a speed. A whole number, a ``Decimal`` or a text, as in ``mm("1.5")``, is
exact: the daemon refuses an amount that is not a whole number of pulses. A ``float`` becomes the nearest whole number
of pulses, and the result of the motion says which. ``array * um`` gives the rows of a NumPy array as distances.

All objects of this module are immutable, so threads can share them.
"""

from __future__ import annotations

import math
import numbers
from decimal import Decimal, InvalidOperation
from typing import Any, Iterator, Union, overload

Number = Union[int, float, Decimal]
"""A whole number or a ``Decimal``, which are exact, or a ``float``, which is rounded to pulses."""


def checked_number(value: object) -> Number:
    """Returns `value` as an ``int``, a ``Decimal`` or a ``float``.

    Raises TypeError if it is not a number, and ValueError if it is infinite or not a number (nan).
    """
    if isinstance(value, bool):
        raise TypeError(f"{value} is not a number")
    if isinstance(value, numbers.Integral):
        return int(value)
    if not isinstance(value, (Decimal, numbers.Real)):
        raise TypeError(f"{value!r} is not a number")
    number: Number = value if isinstance(value, Decimal) else float(value)
    if not math.isfinite(number):
        raise ValueError(f"{value} is not an amount: it must be a finite number")
    return number


def _parsed(text: str) -> Decimal:
    try:
        number = Decimal(text.strip())
    except InvalidOperation:
        raise ValueError(f'"{text}" is not a decimal number') from None
    checked_number(number)
    return number


def _shown(value: Number) -> str:
    return format(value, "f") if isinstance(value, Decimal) else str(value)


class Distance:
    """A Distance is a position or a displacement: a number with its unit."""

    __slots__ = ("value", "unit")
    __array_ufunc__ = None

    def __init__(self, value: Number, unit: Unit) -> None:
        self.value = value
        self.unit = unit

    def __truediv__(self, time: _Second) -> Speed:
        if not isinstance(time, _Second):
            return NotImplemented
        return Speed(self.value, self.unit)

    def __neg__(self) -> Distance:
        return Distance(-self.value, self.unit)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Distance) and (self.value, self.unit) == (other.value, other.unit)

    def __hash__(self) -> int:
        return hash((self.value, self.unit.symbol))

    def __repr__(self) -> str:
        return f"{_shown(self.value)} {self.unit.symbol}"


class Speed:
    """A Speed is a distance for each second. A jog in the minus direction has a negative speed."""

    __slots__ = ("value", "unit")
    __array_ufunc__ = None

    def __init__(self, value: Number, unit: Unit) -> None:
        self.value = value
        self.unit = unit

    def __neg__(self) -> Speed:
        return Speed(-self.value, self.unit)

    def __abs__(self) -> Speed:
        return -self if self.value < 0 else self

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Speed) and (self.value, self.unit) == (other.value, other.unit)

    def __hash__(self) -> int:
        return hash((self.value, self.unit.symbol, "speed"))

    def __repr__(self) -> str:
        return f"{_shown(self.value)} {self.unit.symbol}/s"


class Distances:
    """A Distances object is an array of numbers with a unit. Iterating gives a Distance for each number of a
    one-dimensional array, and a Distances object for each row of others."""

    __slots__ = ("values", "unit")
    __array_ufunc__ = None

    def __init__(self, values: Any, unit: Unit) -> None:
        self.values = values
        self.unit = unit

    def __len__(self) -> int:
        return len(self.values)

    def __getitem__(self, index: int) -> Union[Distance, Distances]:
        return _with_unit(self.values[index], self.unit)

    def __iter__(self) -> Iterator[Union[Distance, Distances]]:
        return (_with_unit(value, self.unit) for value in self.values)

    def __repr__(self) -> str:
        return f"{self.values!r} {self.unit.symbol}"


def _with_unit(value: Any, unit: Unit) -> Union[Distance, Distances]:
    if getattr(value, "ndim", 0) > 0:
        return Distances(value, unit)
    return Distance(checked_number(value.item() if hasattr(value, "item") else value), unit)


class _Second:
    """The second, which divides a distance to give a speed."""

    __slots__ = ()
    __array_ufunc__ = None

    def __repr__(self) -> str:
        return "s"


class Unit:
    """A unit of distances. ``1.5 * mm`` and ``mm("1.5")`` are distances, and ``mm / s`` is a unit of speeds."""

    __slots__ = ("symbol",)
    __array_ufunc__ = None

    def __init__(self, symbol: str) -> None:
        self.symbol = symbol

    def __call__(self, text: str) -> Distance:
        """Returns the exact distance of a decimal text. Raises ValueError if the text is not a decimal."""
        return Distance(_parsed(text), self)

    @overload
    def __rmul__(self, value: Number) -> Distance: ...

    @overload
    def __rmul__(self, value: Any) -> Any: ...

    def __rmul__(self, value: Any) -> Any:
        return _with_unit(value, self)

    def __truediv__(self, time: _Second) -> SpeedUnit:
        return SpeedUnit(self) if isinstance(time, _Second) else NotImplemented

    def __repr__(self) -> str:
        return self.symbol


class SpeedUnit:
    """A unit of speeds, such as ``mm / s``."""

    __slots__ = ("unit",)
    __array_ufunc__ = None

    def __init__(self, unit: Unit) -> None:
        self.unit = unit

    def __call__(self, text: str) -> Speed:
        """Returns the exact speed of a decimal text. Raises ValueError if the text is not a decimal."""
        return Speed(_parsed(text), self.unit)

    def __rmul__(self, value: Number) -> Speed:
        return Speed(checked_number(value), self.unit)

    def __repr__(self) -> str:
        return f"{self.unit.symbol}/s"


nm = Unit("nm")
"""Nanometre."""
um = Unit("um")
"""Micrometre."""
mm = Unit("mm")
"""Millimetre."""
deg = Unit("deg")
"""Degree, for rotary axes."""
pulses = Unit("pulses")
"""Drive pulse, the smallest step of an axis."""
s = _Second()
"""Second, for speeds: ``mm / s``."""
