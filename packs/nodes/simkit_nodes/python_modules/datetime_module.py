"""Module `datetime` of a program: `now` and `today` follow simulated time, from 1970-01-01 in UTC."""

from __future__ import annotations

import datetime as _python
from typing import Any

from simkit_nodes.python_modules.time_module import time

__all__ = ["date", "datetime"]


class _Facade(type):
    """Class of the classes below: their instances are those of Python, also for modules in C."""

    def __call__(cls, *args: object, **kwargs: object) -> Any:
        original = cls.__dict__.get("_original")
        return type.__call__(cls, *args, **kwargs) if original is None else original(*args, **kwargs)

    def __instancecheck__(cls, instance: object) -> bool:
        return isinstance(instance, cls.__dict__.get("_original", ())) or type.__instancecheck__(cls, instance)

    def __subclasscheck__(cls, subclass: type) -> bool:
        return issubclass(subclass, cls.__dict__.get("_original", ())) or type.__subclasscheck__(cls, subclass)


class date(_python.date, metaclass=_Facade):
    """Date whose `today` follows simulated time."""

    _original = _python.date

    @classmethod
    def today(cls) -> Any:
        """Return the date of the simulated time."""
        return datetime.now().date()


class datetime(_python.datetime, metaclass=_Facade):
    """Date and time whose `now` follows simulated time."""

    _original = _python.datetime

    @classmethod
    def now(cls, tz: _python.tzinfo | None = None) -> Any:
        """Return the simulated time, in UTC or in a time zone."""
        present = _python.datetime.fromtimestamp(time(), _python.UTC)
        return present.replace(tzinfo=None) if tz is None else present.astimezone(tz)

    @classmethod
    def utcnow(cls) -> Any:
        """Return the simulated time in UTC, without a time zone."""
        return cls.now()

    today = utcnow
