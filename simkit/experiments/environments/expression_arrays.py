"""Expressions of the condition language for all environments of a batch, as functions of arrays.

The environment that resets all others has bound each expression already, so that types and names are right here.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from simkit.elementary_functions import arctan2, exp, power, tan
from simkit.experiments.environments.array_view import ArrayView
from simkit.experiments.environments.cannot_batch import CannotBatchError
from simkit.testing.conditions import syntax_tree as syntax
from simkit.testing.conditions.parser import parse

if TYPE_CHECKING:
    from simkit.testing.conditions.world_view import WorldView

Get = Callable[[], Any]

_CONSTANTS: Final = {"pi": math.pi, "inf": math.inf, "nan": math.nan, "true": True, "True": True}
_CONSTANTS.update({"false": False, "False": False})
_COMPARISONS: Final[dict[str, Callable[[Any, Any], Any]]] = {
    "<": np.less, "<=": np.less_equal, ">": np.greater, ">=": np.greater_equal, "==": np.equal, "!=": np.not_equal,
}  # fmt: skip
_OPERATORS: Final[dict[str, Callable[[Any, Any], Any]]] = {
    "+": np.add, "-": np.subtract, "*": np.multiply, "/": np.divide, "%": np.mod, "**": power,
}  # fmt: skip
_FUNCTIONS: Final[dict[str, Callable[..., Any]]] = {
    "abs": np.abs, "sqrt": np.sqrt, "exp": exp, "sin": np.sin, "cos": np.cos, "tan": tan, "atan2": arctan2,
    "clamp": lambda value, low, high: np.minimum(np.maximum(value, low), high),
}  # fmt: skip
_AXES: Final = {"x": 0, "y": 1, "z": 2}


def array_expression(source: str, view: ArrayView, world: WorldView) -> Get:
    """Return the function that computes an expression for all environments.

    Args:
        source: text of the expression.
        view: state of all environments.
        world: view of the world of the environment that resets all others.

    Raises:
        CannotBatchError: the expression has a part that needs Python for each environment.
    """
    return _Arrays(source, view, world).part(parse(source).root)


class _Pose:
    """Pose of a model or link in all environments."""

    def __init__(self, view: ArrayView, name: str) -> None:
        self.position: Get = lambda: view.position(name)
        self.yaw: Get = lambda: view.yaw(name)


class _Arrays:
    """Conversion of a syntax tree to functions of arrays."""

    def __init__(self, source: str, view: ArrayView, world: WorldView) -> None:
        self._source, self._view, self._world = source, view, world

    def part(self, node: syntax.Node) -> Get:
        """Return the function of a node: numbers have the shape (count,), vectors (count, n)."""
        match node:
            case syntax.Number(value=value):
                return lambda: value
            case syntax.Name(name=name) if name in _CONSTANTS:
                return lambda: _CONSTANTS[name]
            case syntax.Name(name="time"):
                return lambda: self._view.sim_time
            case syntax.Numbers(items=items):
                gets, count = [self.part(item) for item in items], self._view.count
                return lambda: np.stack([np.broadcast_to(get(), (count,)) for get in gets], axis=1)
            case syntax.Sign(sign=sign, operand=operand):
                get = self.part(operand)
                return (lambda: np.negative(get())) if sign == "-" else get
            case syntax.Not(operand=operand):
                get = self.part(operand)
                return lambda: np.logical_not(get())
            case syntax.Arithmetic(sign=sign, left=left, right=right):
                act, a, b = _OPERATORS[sign], self.part(left), self.part(right)
                return lambda: act(*_aligned(a(), b()))
            case syntax.Comparison(signs=signs, operands=operands):
                gets = [self.part(operand) for operand in operands]
                return lambda: _compared(signs, [get() for get in gets])
            case syntax.Junction(word=word, operands=operands):
                gets = [self.part(operand) for operand in operands]
                join: Any = np.logical_or if word == "or" else np.logical_and
                return lambda: join.reduce(np.broadcast_arrays(*(get() for get in gets)))
            case syntax.Attribute():
                return self._attribute(node)
            case syntax.Call():
                return self._call(node)
        raise self._obstacle(node)

    def _obstacle(self, node: syntax.Node) -> CannotBatchError:
        text = node.span.text(self._source)
        return CannotBatchError(f"{text} in the expression {self._source!r}; simkit.gym.Batched has one for arrays")

    def _entity(self, call: syntax.Call) -> str:
        """Return the scoped name of the model or link that is the only argument."""
        (node,) = call.arguments if len(call.arguments) == 1 else (None,)
        if not isinstance(node, syntax.Text):
            raise self._obstacle(call)
        return self._checked(str(self._world.entity(node.value, self._source, node.span).name), call)

    def _checked(self, name: str, node: syntax.Node) -> str:
        try:
            self._view.place(name)
        except (KeyError, AttributeError):
            raise self._obstacle(node) from None
        return name

    def _attribute(self, node: syntax.Attribute) -> Get:
        of, name = node.of, node.name
        if isinstance(of, syntax.Call) and of.name == "pose":
            pose = _Pose(self._view, self._entity(of))
            if name in ("position", "yaw"):
                return pose.position if name == "position" else pose.yaw
            if name in _AXES:
                return lambda: pose.position()[:, _AXES[name]]
        elif isinstance(of, syntax.Call) and of.name == "joint" and isinstance(of.arguments[0], syntax.Text):
            text = of.arguments[0]
            joint = self._world.joint(text.value, self._source, text.span)
            if joint.dof == 1 and name in ("position", "velocity"):
                read = getattr(self._view, f"joint_{name}")
                return lambda: read(joint.scoped)
        elif name in _AXES:
            get = self.part(of)
            return lambda: get()[:, _AXES[name]]
        raise self._obstacle(node)

    def _call(self, node: syntax.Call) -> Get:
        view, name = self._view, node.name
        if name in _FUNCTIONS:
            act, gets = _FUNCTIONS[name], [self.part(one) for one in node.arguments]
            return lambda: act(*(get() for get in gets))
        if name in ("min", "max") and len(node.arguments) > 1:
            gets = [self.part(one) for one in node.arguments]
            least: Any = np.minimum if name == "min" else np.maximum
            return lambda: least.reduce(np.broadcast_arrays(*(get() for get in gets)))
        if name == "norm":
            get = self.part(node.arguments[0])
            return lambda: np.sqrt(np.square(get()).sum(axis=1))
        if name == "distance":
            first, second = (self._point(one) for one in node.arguments)
            return lambda: np.sqrt(np.square(first() - second()).sum(axis=1))
        if name == "contact":
            entity = self._entity(node)
            return lambda: view.contact(entity)
        if name == "velocity":
            entity = self._entity(node)
            return lambda: view.velocity(entity)
        raise self._obstacle(node)

    def _point(self, node: syntax.Node) -> Get:
        if isinstance(node, syntax.Text):
            name = self._checked(str(self._world.entity(node.value, self._source, node.span).name), node)
            return lambda: self._view.position(name)
        if isinstance(node, syntax.Call) and node.name == "pose":
            return _Pose(self._view, self._entity(node)).position
        return self.part(node)


def _aligned(a: Any, b: Any) -> tuple[Any, Any]:
    """Give numbers a second axis where the other operand is a vector."""
    a, b = np.asarray(a, np.float64), np.asarray(b, np.float64)
    if a.ndim == 2 and b.ndim == 1:
        return a, b[:, None]
    return (a[:, None], b) if b.ndim == 2 and a.ndim == 1 else (a, b)


def _compared(signs: tuple[str, ...], values: list[Any]) -> Any:
    found: Any = True
    for sign, (left, right) in zip(signs, pairwise(values), strict=True):
        found = np.logical_and(found, _COMPARISONS[sign](left, right))
    return found
