"""Refuse with mypy: `@` and `**` of NumPy arrays are errors, because their bits depend on the processor.

`simkit.linear_algebra.matmul` and `simkit.elementary_functions.power` replace them. Only the types can tell an array
from a pose, so `tests/test_processor_independence.py`, which reads the syntax, cannot check these two operators.
"""

from __future__ import annotations

from collections.abc import Callable

from mypy.nodes import IntExpr
from mypy.plugin import MethodContext, Plugin
from mypy.types import Type

_ARRAYS = ("numpy.ndarray", "numpy._core.multiarray.ndarray")


def _refuse_product(context: MethodContext) -> Type:
    text = "`@` of arrays uses BLAS, whose bits depend on the processor; use linear_algebra.matmul"
    context.api.fail(text, context.context)
    return context.default_return_type


def _refuse_power(context: MethodContext) -> Type:
    exponents = context.args[0] if context.args else []
    if not (len(exponents) == 1 and isinstance(exponents[0], IntExpr) and exponents[0].value == 2):
        context.api.fail(
            "`**` of arrays depends on the processor, except `** 2`; use elementary_functions.power", context.context
        )
    return context.default_return_type


class ArrayOperators(Plugin):
    """Refuse the operators of arrays that depend on the processor."""

    def get_method_hook(self, fullname: str) -> Callable[[MethodContext], Type] | None:
        owner, _, method = fullname.rpartition(".")
        if owner not in _ARRAYS:
            return None
        if method in ("__matmul__", "__rmatmul__", "__imatmul__"):
            return _refuse_product
        return _refuse_power if method in ("__pow__", "__rpow__", "__ipow__") else None


def plugin(version: str) -> type[Plugin]:  # noqa: ARG001 (mypy passes its version)
    """Return the plugin class; mypy calls this."""
    return ArrayOperators
