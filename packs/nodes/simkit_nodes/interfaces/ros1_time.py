"""Time and duration of ROS 1, with the names and the arithmetic of the package `genpy`."""

from __future__ import annotations

import numbers
from typing import Any, ClassVar, Self

_NS = 1_000_000_000


def _canonical(secs: int, nsecs: int) -> tuple[int, int]:
    """Return seconds and nanoseconds with 0 <= nanoseconds < 1 s."""
    over, nsecs = divmod(nsecs, _NS)
    return secs + over, nsecs


class TVal:
    """Base of `Time` and `Duration`.

    Args:
        secs: seconds; a fraction is allowed if there are no nanoseconds.
        nsecs: nanoseconds.

    Raises:
        ValueError: seconds with a fraction and nanoseconds are given.
    """

    __slots__ = ("nsecs", "secs")
    _slot_types: ClassVar[list[str]] = ["int32", "int32"]

    def __init__(self, secs: Any = 0, nsecs: Any = 0) -> None:
        if isinstance(secs, numbers.Integral):
            secs, nsecs = int(secs), int(nsecs)
        elif nsecs != 0:
            raise ValueError("if secs is a float, nsecs cannot be set")
        else:
            secs, nsecs = _split(secs)
        self.secs, self.nsecs = _canonical(secs, nsecs)

    @classmethod
    def from_sec(cls, float_secs: float) -> Self:
        """Return the value of a number of seconds."""
        return cls(*_split(float_secs))

    def is_zero(self) -> bool:
        """Check whether the value is zero."""
        return self.secs == 0 and self.nsecs == 0

    def set(self, secs: int, nsecs: int) -> None:
        """Set seconds and nanoseconds."""
        self.secs, self.nsecs = secs, nsecs

    def canon(self) -> None:
        """Move whole seconds from the nanoseconds to the seconds."""
        self.secs, self.nsecs = _canonical(self.secs, self.nsecs)

    def to_sec(self) -> float:
        """Return the value [s]."""
        return float(self.secs) + float(self.nsecs) / 1e9

    def to_nsec(self) -> int:
        """Return the value [ns]."""
        return self.secs * _NS + self.nsecs

    def __hash__(self) -> int:
        return hash((self.secs, self.nsecs))

    def __str__(self) -> str:
        return str(self.to_nsec())

    def __repr__(self) -> str:
        return f"genpy.{self._kind()}[{self.to_nsec()}]"

    def __bool__(self) -> bool:
        return not self.is_zero()

    def __eq__(self, other: object) -> bool:
        return isinstance(other, self._comparable()) and self.to_nsec() == other.to_nsec()

    def __lt__(self, other: object) -> bool:
        return self._difference(other) < 0

    def __le__(self, other: object) -> bool:
        return self._difference(other) <= 0

    def __gt__(self, other: object) -> bool:
        return self._difference(other) > 0

    def __ge__(self, other: object) -> bool:
        return self._difference(other) >= 0

    def _difference(self, other: object) -> int:
        kind = self._comparable()
        if not isinstance(other, kind):
            raise TypeError(f"cannot compare to non-{kind.__name__}")
        return self.to_nsec() - other.to_nsec()

    @classmethod
    def _comparable(cls) -> type[TVal]:
        """Return the class of the values that this value can be compared with."""
        return TVal

    @classmethod
    def _kind(cls) -> str:
        return cls._comparable().__name__

    def __getstate__(self) -> list[int]:
        return [self.secs, self.nsecs]

    def __setstate__(self, state: list[int]) -> None:
        self.secs, self.nsecs = state


def _split(seconds: float) -> tuple[int, int]:
    """Return whole seconds and the remaining nanoseconds, both rounded towards zero."""
    whole_seconds = int(seconds)
    return whole_seconds, int((seconds - whole_seconds) * _NS)


class Time(TVal):
    """Point of time, with `secs` [s] and `nsecs` [ns].

    Raises:
        TypeError: the time is negative.
    """

    __slots__ = ()

    def __init__(self, secs: Any = 0, nsecs: Any = 0) -> None:
        super().__init__(secs, nsecs)
        if self.secs < 0:
            raise TypeError("time values must be positive")

    @classmethod
    def _comparable(cls) -> type[TVal]:
        return Time

    def to_time(self) -> float:
        """Return the time [s]."""
        return self.to_sec()

    def __add__(self, other: object) -> Self:
        if not isinstance(other, Duration):
            return NotImplemented
        return type(self)(self.secs + other.secs, self.nsecs + other.nsecs)

    __radd__ = __add__

    def __sub__(self, other: object) -> Any:
        if isinstance(other, Time):
            return Duration(self.secs - other.secs, self.nsecs - other.nsecs)
        if isinstance(other, Duration):
            return type(self)(self.secs - other.secs, self.nsecs - other.nsecs)
        return NotImplemented


class Duration(TVal):
    """Length of time, with `secs` [s] and `nsecs` [ns]."""

    __slots__ = ()

    @classmethod
    def _comparable(cls) -> type[TVal]:
        return Duration

    def __neg__(self) -> Self:
        return type(self)(-self.secs, -self.nsecs)

    def __abs__(self) -> Self:
        return self if self.secs >= 0 else -self

    def __add__(self, other: object) -> Self:
        if not isinstance(other, Duration):
            return NotImplemented
        return type(self)(self.secs + other.secs, self.nsecs + other.nsecs)

    __radd__ = __add__

    def __sub__(self, other: object) -> Self:
        if not isinstance(other, Duration):
            return NotImplemented
        return type(self)(self.secs - other.secs, self.nsecs - other.nsecs)

    def __mul__(self, factor: Any) -> Self:
        if isinstance(factor, numbers.Integral):
            return type(self)(self.secs * int(factor), self.nsecs * int(factor))
        if isinstance(factor, numbers.Real):
            return self.from_sec(self.to_sec() * float(factor))
        return NotImplemented

    __rmul__ = __mul__

    def __floordiv__(self, divisor: Any) -> Any:
        if isinstance(divisor, numbers.Real):
            return self.from_sec(self.to_sec() // float(divisor))
        if isinstance(divisor, Duration):
            return int(self.to_sec() // divisor.to_sec())
        return NotImplemented

    def __truediv__(self, divisor: Any) -> Any:
        if isinstance(divisor, numbers.Real):
            return self.from_sec(self.to_sec() / float(divisor))
        if isinstance(divisor, Duration):
            return self.to_sec() / divisor.to_sec()
        return NotImplemented

    def __mod__(self, divisor: object) -> Self:
        if not isinstance(divisor, Duration):
            return NotImplemented
        return self.from_sec(self.to_sec() % divisor.to_sec())

    def __divmod__(self, divisor: object) -> tuple[int, Self]:
        if not isinstance(divisor, Duration):
            return NotImplemented
        quotient, rest = divmod(self.to_sec(), divisor.to_sec())
        return int(quotient), self.from_sec(rest)
