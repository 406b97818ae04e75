"""Substitution that is the result of a Python expression."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from simkit_launch.launch_modules.launch.substitution import Substitution
from simkit_launch.launch_modules.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

if TYPE_CHECKING:
    from simkit_launch.launch_modules.launch.launch_context import LaunchContext
    from simkit_launch.launch_modules.launch.some_substitutions_type import SomeSubstitutionsType

__all__ = ["PythonExpression"]


class PythonExpression(Substitution):
    """Result of a Python expression as a text.

    Args:
        expression: expression.
        python_modules: modules that the expression uses; the names of `math` need no prefix.
    """

    def __init__(self, expression: SomeSubstitutionsType, python_modules: SomeSubstitutionsType = ("math",)) -> None:
        self._expression = normalize_to_list_of_substitutions(expression)
        self._modules = normalize_to_list_of_substitutions(python_modules)

    @property
    def expression(self) -> list[Substitution]:
        """Expression."""
        return self._expression

    @property
    def python_modules(self) -> list[Substitution]:
        """Modules that the expression uses."""
        return self._modules

    def describe(self) -> str:
        """Return a description of the substitution."""
        return f"PythonExpr({' + '.join(sub.describe() for sub in self.expression)})"

    def perform(self, context: LaunchContext) -> str:
        """Return the result as a text."""
        names: dict[str, Any] = {}
        for name in (context.perform_substitution(module) for module in self.python_modules):
            module = importlib.import_module(name)
            if name == "math":
                names.update(vars(module))
            names[name] = module
        builtins = context.planner.program.builtins
        return str(eval(perform_substitutions(context, self.expression), {"__builtins__": builtins}, names))
