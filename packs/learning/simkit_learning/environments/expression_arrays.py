"""World of all environments of a batch for expressions of the condition language, which then compute with arrays."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from simkit import Joint
from simkit.testing.conditions.binder import bind_rows
from simkit.testing.conditions.bound_expression import NotInRows
from simkit.testing.conditions.parser import parse
from simkit.testing.conditions.syntax_tree import Span
from simkit.testing.conditions.world_view import WorldView
from simkit_learning.environments.array_view import ArrayView

Floats = npt.NDArray[np.float64]


def array_expression(source: str, view: ArrayView, world: WorldView) -> Callable[[], Any]:
    """Return the function that computes an expression for all environments.

    Args:
        source: text of the expression, which the environment that resets all others has bound already.
        view: state of all environments.
        world: view of the world of that environment.

    Raises:
        CannotBatchError: the expression has a part that needs Python for each environment.
    """
    return bind_rows(parse(source), _WorldOfRows(view, world)).get


class _WorldOfRows(WorldView):
    """World whose entities, joints, contacts and clock have the values of all environments."""

    def __init__(self, view: ArrayView, world: WorldView) -> None:
        super().__init__(world.sim)
        self._rows = view
        clock: Any = _ClockOfRows(view)  # its times are arrays
        self.clock = clock

    def entity(self, name: str, source: str, span: Span, *, moves: bool = False) -> Any:
        return _EntityOfRows(self._rows, super().entity(name, source, span, moves=moves).name)

    def joint(self, name: str, source: str, span: Span) -> Joint:
        joint = super().joint(name, source, span)
        if joint.dof != 1:
            raise NotInRows
        return joint

    def current_joint(self, joint: Joint) -> Any:
        return _JointOfRows(self._rows, joint)

    def contacts(self, first: str, second: str | None = None) -> Any:
        if second is not None:
            raise NotInRows
        return _ContactsOfRows(self._rows, _EntityOfRows(self._rows, first).name)


class _ClockOfRows:
    """Times of all environments."""

    def __init__(self, view: ArrayView) -> None:
        self._view = view

    @property
    def time(self) -> Floats:
        return self._view.sim_time


class _EntityOfRows:
    """Model or link of all environments, and its pose."""

    def __init__(self, view: ArrayView, name: str) -> None:
        self._view, self.name = view, name
        try:
            view.place(name)
        except KeyError:
            raise NotInRows from None

    def pose(self) -> _EntityOfRows:
        return self

    @property
    def position(self) -> Floats:
        return self._view.position(self.name)

    @property
    def quaternion(self) -> Floats:
        return self._view.quaternion(self.name)

    def twist(self) -> tuple[Floats, Floats]:
        return self._view.velocity(self.name), self._view.angular_velocity(self.name)


class _JointOfRows:
    """Joint with one degree of freedom of all environments."""

    dof = 1

    def __init__(self, view: ArrayView, joint: Joint) -> None:
        self._view, self.scoped = view, joint.scoped

    @property
    def position(self) -> Floats:
        return self._view.joint_position(self.scoped)

    @property
    def velocity(self) -> Floats:
        return self._view.joint_velocity(self.scoped)


class _ContactsOfRows:
    """Contacts of a model or link of all environments."""

    def __init__(self, view: ArrayView, name: str) -> None:
        self._view, self._name = view, name

    def now(self) -> npt.NDArray[np.bool_]:
        return self._view.contact(self._name)
