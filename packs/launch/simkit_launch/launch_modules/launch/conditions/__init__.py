"""Conditions of actions."""

from __future__ import annotations

from typing import TYPE_CHECKING

from simkit_launch.launch_modules.launch.condition import Condition
from simkit_launch.launch_modules.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

if TYPE_CHECKING:
    from simkit_launch.launch_modules.launch.launch_context import LaunchContext
    from simkit_launch.launch_modules.launch.some_substitutions_type import SomeSubstitutionsType
    from simkit_launch.launch_modules.launch.substitution import Substitution

__all__ = [
    "IfCondition",
    "InvalidConditionExpressionError",
    "LaunchConfigurationEquals",
    "LaunchConfigurationNotEquals",
    "UnlessCondition",
    "evaluate_condition_expression",
]

_TRUE, _FALSE = ("true", "1"), ("false", "0")


class InvalidConditionExpressionError(ValueError):
    """The expression of a condition is neither true nor false."""

    def __init__(self, expanded_expression: str, expression: object = None, valid_expressions: object = None) -> None:
        del expression, valid_expressions
        super().__init__(
            f"invalid condition expression {expanded_expression!r}: expected one of {', '.join((*_TRUE, *_FALSE))}"
        )


def evaluate_condition_expression(context: LaunchContext, expression: list[Substitution]) -> bool:
    """Return whether an expression is true.

    Raises:
        InvalidConditionExpressionError: it is neither true nor false.
    """
    text = perform_substitutions(context, expression).strip().lower()
    if text not in (*_TRUE, *_FALSE):
        raise InvalidConditionExpressionError(text)
    return text in _TRUE


class IfCondition(Condition):
    """Condition that holds if an expression is true.

    Args:
        predicate_expression: expression.
    """

    def __init__(self, predicate_expression: SomeSubstitutionsType) -> None:
        self._expression = normalize_to_list_of_substitutions(predicate_expression)
        super().__init__(predicate=self._holds)

    def _holds(self, context: LaunchContext) -> bool:
        return evaluate_condition_expression(context, self._expression)

    def describe(self) -> str:
        """Return a description of the condition."""
        return f"{type(self).__name__}({' + '.join(sub.describe() for sub in self._expression)})"


class UnlessCondition(IfCondition):
    """Condition that holds if an expression is false.

    Args:
        predicate_expression: expression.
    """

    def _holds(self, context: LaunchContext) -> bool:
        return not super()._holds(context)


class LaunchConfigurationEquals(Condition):
    """Condition that holds if a launch configuration has a value.

    Args:
        launch_configuration_name: name of the launch configuration.
        expected_value: value; None for a launch configuration that is not set.
    """

    def __init__(self, launch_configuration_name: str, expected_value: SomeSubstitutionsType | None) -> None:
        self._name = launch_configuration_name
        self._value = None if expected_value is None else normalize_to_list_of_substitutions(expected_value)
        super().__init__(predicate=self._holds)

    def _holds(self, context: LaunchContext) -> bool:
        context.planner.used_names.add(self._name)
        expected = None if self._value is None else perform_substitutions(context, self._value)
        return bool(context.launch_configurations.get(self._name) == expected)


class LaunchConfigurationNotEquals(LaunchConfigurationEquals):
    """Condition that holds if a launch configuration does not have a value.

    Args:
        launch_configuration_name: name of the launch configuration.
        expected_value: value; None for a launch configuration that is not set.
    """

    def _holds(self, context: LaunchContext) -> bool:
        return not super()._holds(context)
