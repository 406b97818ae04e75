"""One degree of freedom of a joint, as plugins read and push it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from simkit.diagnostics import did_you_mean
from simkit.params import LARGEST, Params
from simkit.plugins.find_entities import find_joint
from simkit.pose import Vector
from simkit.scene import SceneJoint, SceneModel


class JointAxis:
    """An axis of a joint; positions rad or m, efforts N·m or N.

    Attributes:
        joint: the handle.
        name: the joint's name.
        index: which of the joint's axes.
        dof: its number among MuJoCo's degrees of freedom; another after a spawn or a removal, so it is asked for.
    """

    def __init__(self, joint: Any, index: int = 0) -> None:
        self.joint, self.index, self.name = joint, index, joint.name
        self._is_alone = len(joint.scene.axes) == 1

    @property
    def dof(self) -> int:
        dof: int = self.joint.mj_dofs[self.index]
        return dof

    @property
    def position(self) -> float:
        value = self.joint.position
        return float(value) if self._is_alone else float(value[self.index])

    @property
    def velocity(self) -> float:
        value = self.joint.velocity
        return float(value) if self._is_alone else float(value[self.index])

    @property
    def effort_limit(self) -> float:
        return self._limit(self.joint._effort_limit)

    @property
    def velocity_limit(self) -> float:
        return self._limit(self.joint._velocity_limit)

    def _limit(self, limits: Vector) -> float:
        # asked for at every step, and much cheaper than by the joint's property
        value: float = limits.item(self.index if len(limits) > 1 else 0)
        return value

    def is_meant(self, name: str) -> bool:
        """Whether a scoped name is that of the joint, or of the top-level model that it is in."""
        return name in (self.joint.scoped, self.joint.scoped.split("::")[0])

    def push(self, effort: float) -> None:
        """Sets the effort of the next step, in place of what was set before.

        What is no longer a number becomes so large a one that the physics diverges, and says so.
        """
        effort = max(-LARGEST, min(LARGEST, float(effort)))
        if self._is_alone:
            self.joint.set_effort(effort)
        else:
            efforts = self._pending()
            efforts[self.index] = effort
            self.joint.set_effort(efforts)

    def add(self, effort: float) -> None:
        """Adds to the effort of the next step."""
        self.push(effort + float(self._pending()[self.index]))

    def _pending(self) -> Vector:
        applied = self.joint._physics.data.qfrc_applied
        return np.array([applied[dof] for dof in self.joint.mj_dofs])

    def __deepcopy__(self, memo: dict[int, object]) -> JointAxis:
        return self


def find_joints(scene: SceneModel, params: Params, axis: int = 0, most: int | None = None) -> list[SceneJoint]:
    """The joints that the first `most` `<joint_name>` elements name, each with more than `axis` axes.

    Errors for the others, and where there is no such element.
    """
    found = []
    element = "joint_name"
    elements = params.all(element)[:most]
    if not elements:
        params.text(element, required=True)
    for one in elements:
        if not one.value:
            one.error("SK-PARAM-002", f"found an empty <{element}>, allowed is the name of a joint")
            continue
        joint = find_joint(scene, one.value, one)
        if joint is not None and has_axis(joint, axis, one):
            found.append(joint)
    return found


def has_axis(joint: SceneJoint, axis: int, params: Params) -> bool:
    """Whether a joint has that axis; an error says how many it has."""
    if axis < len(joint.axes):
        return True
    count = len(joint.axes) or "no"
    message = f"joint {joint.name!r} is {joint.type} and has {count} {'axis' if count == 1 else 'axes'}"
    params.error("SK-PLUGIN-003", f"{message}; one with axis number {axis} is needed")
    return False


def suggest_names(name: str, names: Sequence[str]) -> str:
    """What a message says where a joint is not known: the closest name, or all of them."""
    return did_you_mean(name, names) or "there is " + (", ".join(map(repr, names[:20])) or "none")
