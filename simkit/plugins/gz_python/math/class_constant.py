"""Constants of classes that are instances of the class itself, such as `Vector3d.ZERO`."""

from __future__ import annotations

from typing import Any, TypeVar, cast

T = TypeVar("T")


# Argument of a function that C++ overloads; its class tells which overload is meant.
CppArgument = Any


class ClassConstant:
    """An instance of the class that it is read from, made once for each class.

    Args:
        values: arguments of the instance.
    """

    def __init__(self, *values: float) -> None:
        self._values = values
        self._instances: dict[type, object] = {}

    def __get__(self, instance: object, owner: type[T]) -> T:
        if owner not in self._instances:
            self._instances[owner] = owner(*self._values)
        return cast(T, self._instances[owner])
