"""Substitutions that are `true` or `false`, and one that chooses."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from simkit_launch.launch_modules.launch.substitution import Substitution
from simkit_launch.launch_modules.launch.substitutions.substitution_failure import SubstitutionFailure
from simkit_launch.launch_modules.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from simkit_launch.launch_modules.launch.utilities.type_utils import perform_typed_substitution

if TYPE_CHECKING:
    from simkit_launch.launch_modules.launch.launch_context import LaunchContext
    from simkit_launch.launch_modules.launch.some_substitutions_type import SomeSubstitutionsType

__all__ = [
    "AllSubstitution",
    "AndSubstitution",
    "AnySubstitution",
    "EqualsSubstitution",
    "IfElseSubstitution",
    "NotEqualsSubstitution",
    "NotSubstitution",
    "OrSubstitution",
]


def _is_true(context: LaunchContext, value: list[Substitution]) -> bool:
    try:
        return bool(perform_typed_substitution(context, value, bool))
    except (TypeError, ValueError) as error:
        raise SubstitutionFailure(error) from None


class NotSubstitution(Substitution):
    """Opposite of a value.

    Args:
        value: value.
    """

    def __init__(self, value: SomeSubstitutionsType) -> None:
        self._value = normalize_to_list_of_substitutions(value)

    @property
    def value(self) -> list[Substitution]:
        """Value."""
        return self._value

    def perform(self, context: LaunchContext) -> str:
        """Return `true` or `false`."""
        return str(not _is_true(context, self.value)).lower()


class _PairSubstitution(Substitution):
    """Comparison of two values."""

    def __init__(self, left: SomeSubstitutionsType, right: SomeSubstitutionsType) -> None:
        self._left, self._right = normalize_to_list_of_substitutions(left), normalize_to_list_of_substitutions(right)

    @property
    def left(self) -> list[Substitution]:
        """First value."""
        return self._left

    @property
    def right(self) -> list[Substitution]:
        """Second value."""
        return self._right


class AndSubstitution(_PairSubstitution):
    """`true` if both values are true."""

    def perform(self, context: LaunchContext) -> str:
        """Return `true` or `false`."""
        left, right = _is_true(context, self.left), _is_true(context, self.right)
        return str(left and right).lower()


class OrSubstitution(_PairSubstitution):
    """`true` if one of two values is true."""

    def perform(self, context: LaunchContext) -> str:
        """Return `true` or `false`."""
        left, right = _is_true(context, self.left), _is_true(context, self.right)
        return str(left or right).lower()


class _ListSubstitution(Substitution):
    def __init__(self, *args: SomeSubstitutionsType) -> None:
        self._args = [normalize_to_list_of_substitutions(each) for each in args]

    @property
    def args(self) -> list[list[Substitution]]:
        """Values."""
        return self._args

    def _truths(self, context: LaunchContext) -> list[bool]:
        return [_is_true(context, each) for each in self.args]  # each must be true or false


class AnySubstitution(_ListSubstitution):
    """`true` if one of the values is true."""

    def perform(self, context: LaunchContext) -> str:
        """Return `true` or `false`."""
        return str(any(self._truths(context))).lower()


class AllSubstitution(_ListSubstitution):
    """`true` if all values are true."""

    def perform(self, context: LaunchContext) -> str:
        """Return `true` or `false`."""
        return str(all(self._truths(context))).lower()


class EqualsSubstitution(_PairSubstitution):
    """`true` if two values are equal as texts, truth values or numbers.

    Args:
        left: first value.
        right: second value.
    """

    def __init__(self, left: Any, right: Any) -> None:
        super().__init__(_normalised(left), _normalised(right))

    def _are_equal(self, context: LaunchContext) -> bool:
        left, right = perform_substitutions(context, self.left), perform_substitutions(context, self.right)
        truths = {"true": True, "1": True, "false": False, "0": False}
        if left.lower() in truths and right.lower() in truths:
            return truths[left.lower()] == truths[right.lower()]
        try:
            return math.isclose(float(left), float(right))
        except ValueError:
            return left == right

    def perform(self, context: LaunchContext) -> str:
        """Return `true` or `false`."""
        return str(self._are_equal(context)).lower()


class NotEqualsSubstitution(EqualsSubstitution):
    """`true` if two values differ as texts, truth values or numbers."""

    def perform(self, context: LaunchContext) -> str:
        """Return `true` or `false`."""
        return str(not self._are_equal(context)).lower()


def _normalised(value: Any) -> list[Substitution]:
    if value is None:
        return normalize_to_list_of_substitutions("")
    if isinstance(value, (bool, int, float)):
        return normalize_to_list_of_substitutions(str(value).lower())
    items = list(value) if isinstance(value, Iterable) and not isinstance(value, str) else [value]
    return normalize_to_list_of_substitutions(
        [str(item) if isinstance(item, (bool, int, float)) else item for item in items]
    )


class IfElseSubstitution(Substitution):
    """One of two values.

    Args:
        condition: condition.
        if_value: value if the condition is true.
        else_value: value if it is false.
    """

    def __init__(
        self,
        condition: SomeSubstitutionsType,
        if_value: SomeSubstitutionsType = "",
        else_value: SomeSubstitutionsType = "",
    ) -> None:
        if else_value == "" and if_value == "":
            raise RuntimeError("One of if_value and else_value must be specified")
        self._condition = normalize_to_list_of_substitutions(condition)
        self._if_value = normalize_to_list_of_substitutions(if_value)
        self._else_value = normalize_to_list_of_substitutions(else_value)

    @property
    def condition(self) -> list[Substitution]:
        """Condition."""
        return self._condition

    @property
    def if_value(self) -> list[Substitution]:
        """Value if the condition is true."""
        return self._if_value

    @property
    def else_value(self) -> list[Substitution]:
        """Value if the condition is false."""
        return self._else_value

    def perform(self, context: LaunchContext) -> str:
        """Return the chosen value."""
        return perform_substitutions(context, self.if_value if _is_true(context, self.condition) else self.else_value)
