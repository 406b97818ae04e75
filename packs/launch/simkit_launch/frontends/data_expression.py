"""Expression `$(eval …)` of a launch file in XML or YAML, which is data: it runs no code."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from simkit.loaders.xacro.expansion_limits import Budget, ExpansionError
from simkit.loaders.xacro.expression import Evaluator
from simkit.loaders.xacro.expression_functions import math_functions, python_functions
from simkit_launch.launch_modules.launch.substitutions import PythonExpression
from simkit_launch.launch_modules.launch.utilities import perform_substitutions
from simkit_launch.planner import LaunchFileError

if TYPE_CHECKING:
    from simkit_launch.launch_modules.launch.launch_context import LaunchContext

INVALID_EXPRESSION: Final = "SK-LAUNCH-024"


class DataExpression(PythonExpression):
    """Result of an expression as a text: arithmetic, comparisons, texts, and the functions of `math`.

    ROS evaluates it as Python, so that a file in XML could run any code. Here it is evaluated as in a xacro file.
    """

    def perform(self, context: LaunchContext) -> str:
        """Return the result as a text.

        Raises:
            LaunchFileError: SK-LAUNCH-024 the expression is invalid or uses more than arithmetic and texts.
        """
        where = context.planner.place
        text = perform_substitutions(context, self.expression)
        for name in (context.perform_substitution(module) for module in self.python_modules):
            if name and name != "math":
                problem = f"$(eval …) of a file in XML or YAML cannot use the module {name!r}, only 'math'"
                raise LaunchFileError(
                    INVALID_EXPRESSION, problem, where, "compute the value in a launch file in Python"
                )
        if "__" in text:
            problem = f"found $(eval {text!r:.100}); an expression has no double underscore"
            raise LaunchFileError(INVALID_EXPRESSION, problem, where)
        evaluator = Evaluator({}, Budget())
        functions: dict[str, Any] = math_functions()
        evaluator.names = {**functions, "math": functions, **python_functions(evaluator)}
        try:
            return str(evaluator.run(text))
        except ExpansionError as error:
            raise LaunchFileError(INVALID_EXPRESSION, f"$(eval {text!r:.100}): {error}", where) from None
