"""Checks of the arguments of public functions. An error names the argument, what was found and what is allowed."""

from __future__ import annotations

import math
import numbers
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from simkit.errors import ArgumentTypeError, ArgumentValueError
from simkit.number_text import counted

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

_LARGEST_SEED: Final = 2**64 - 1
_LONGEST_SHOWN: Final = 80  # characters of a value in a message


def wrong_type(name: str, expected: str, value: object) -> ArgumentTypeError:
    """Return the error for an argument of a wrong kind."""
    return ArgumentTypeError(f"{name} must be {expected}, got {shown(value)} ({type(value).__name__})")


def wrong_value(name: str, expected: str, value: object) -> ArgumentValueError:
    """Return the error for an argument of the right kind with a value that is not allowed."""
    return ArgumentValueError(f"{name} must be {expected}, got {shown(value)}")


def shown(value: object) -> str:
    """Return the text of a value in a message: one line, shortened, also for a value without a text."""
    if isinstance(value, int) and not isinstance(value, bool) and abs(value) >= 10**20:
        return f"a whole number of {value.bit_length()} bits"  # the text of a large number may be refused by Python
    try:
        text = " ".join(repr(value).split())
    except Exception:  # noqa: BLE001 (Python refuses a text of large numbers, and an object of the caller may raise)
        return "a value that cannot be shown"
    return text if len(text) <= _LONGEST_SHOWN else f"{text[:_LONGEST_SHOWN]}..."


def check_kind(value: object, kinds: type | tuple[type, ...], name: str, expected: str) -> None:
    """Raise ArgumentTypeError if a value is not an instance of one of these classes."""
    if not isinstance(value, kinds):
        raise wrong_type(name, expected, value)


def check_text(value: object, name: str) -> None:
    """Raise an error if a value is not a text, or an empty text."""
    check_kind(value, str, name, "a text")
    if not value:
        raise wrong_value(name, "a text that is not empty", value)


def check_function(value: object, name: str) -> None:
    """Raise ArgumentTypeError if a value cannot be called."""
    if not callable(value):
        raise wrong_type(name, "a function", value)


def check_list(value: object, kinds: type | tuple[type, ...], name: str, expected: str) -> None:
    """Raise ArgumentTypeError if a value is not a list or tuple of items of these classes. A text is not a list."""
    if isinstance(value, (str, bytes, Mapping)) or not isinstance(value, Sequence):
        raise wrong_type(name, f"a list of {expected}", value)
    for number, item in enumerate(value):
        check_kind(item, kinds, f"{name}[{number}]", expected)


def check_paths(value: object, name: str) -> None:
    """Raise ArgumentTypeError if a value is not a list of paths."""
    check_list(value, (str, os.PathLike), name, "paths")


def check_folders(value: Sequence[str | os.PathLike[str]], name: str) -> None:
    """Raise ArgumentTypeError if a value is not a list of paths, and ArgumentValueError if one is no folder."""
    check_paths(value, name)
    for path in value:
        if not Path(path).is_dir():
            raise wrong_value(name, "paths of folders that exist", os.fspath(path))


def check_table(value: object, kinds: type | tuple[type, ...], name: str, expected: str) -> None:
    """Raise ArgumentTypeError if a value is neither None nor a mapping from names to items of these classes."""
    if value is None:
        return
    check_kind(value, Mapping, name, f"a dict from names to {expected}")
    for key, item in dict(value).items():  # type: ignore[call-overload]  # the line above checks the kind
        check_kind(key, str, f"a key of {name}", "a text")
        check_kind(item, kinds, f"{name}[{key!r}]", expected)


def checked_integer(value: object, name: str, low: int | None = None, high: int | None = None) -> int:
    """Return a whole number within bounds as an int. Whole floats such as 2.0 are accepted."""
    allowed = "a whole number" + (f" from {low} to {high}" if high is not None else f" of at least {low}" * (low == 0))
    real = _real(value, name, allowed)
    if isinstance(real, float) and not real.is_integer():  # also NaN and infinite
        raise wrong_value(name, allowed, value)
    number = int(real)
    if (low is not None and number < low) or (high is not None and number > high):
        raise wrong_value(name, allowed, value)
    return number


def checked_seed(value: object) -> int:
    """Return a seed as an int; files and other programs hold seeds in 64 bits."""
    return checked_integer(value, "seed", 0, _LARGEST_SEED)


def checked_number(
    value: object, name: str, low: float = -math.inf, high: float = math.inf, *, unit: str = "", finite: bool = True
) -> float:
    """Return a number within bounds as a float. NaN is never accepted, infinity only if `finite` is false."""
    allowed = ("a finite number" if finite else "a number") + (f" [{unit}]" if unit else "")
    if low > -math.inf:
        allowed += f" from {low:g} to {high:g}" if high < math.inf else f" of at least {low:g}"
    try:
        number = float(_real(value, name, allowed))
    except OverflowError:
        raise wrong_value(name, allowed, value) from None
    if not low <= number <= high or (finite and math.isinf(number)):
        raise wrong_value(name, allowed, value)
    return number


def _real(value: object, name: str, allowed: str) -> Any:
    """Return a number as an int, a float or a fraction."""
    if type(value).__module__ == "numpy" and getattr(value, "ndim", None) == 0:
        value = value.item()  # type: ignore[attr-defined]
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        raise wrong_type(name, allowed, value)
    return value


def checked_vector(value: object, name: str, count: int = 3) -> npt.NDArray[np.float64]:
    """Return finite numbers as an array of shape (count,)."""
    import numpy as np

    allowed = counted(count, "finite number")
    try:
        entries = np.asarray(value)
        if value is None or entries.dtype.kind not in "iufO":
            raise TypeError
        array: npt.NDArray[np.float64] = entries.astype(np.float64)
    except (ValueError, OverflowError):  # lists of different lengths, numbers beyond the floats
        raise wrong_value(name, allowed, value) from None
    except Exception:  # noqa: BLE001 (an object of the caller may raise any error)
        raise wrong_type(name, allowed, value) from None
    if array.shape != (count,) or not all(map(math.isfinite, array.tolist())):
        raise wrong_value(name, allowed, value)
    return array
