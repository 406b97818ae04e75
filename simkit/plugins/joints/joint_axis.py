"""One degree of freedom of a joint, with methods to read its state and set its effort."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from simkit.diagnostics import did_you_mean
from simkit.number_text import counted
from simkit.params import LARGEST, Params
from simkit.plugins.find_entities import find_joint
from simkit.plugins.not_deep_copied import SharedByCopies
from simkit.pose import Vector
from simkit.scene import SceneJoint, SceneModel

if TYPE_CHECKING:
    from simkit.runtime import Joint


class JointAxis(SharedByCopies):
    """Axis of a joint; positions in rad or m, efforts in N·m or N.

    Attributes:
        joint: Handle of the joint.
        name: Name of the joint.
        index: Index of the axis in the joint.
        dof: Index among MuJoCo's degrees of freedom. The index changes when a model is spawned or removed, so it is
            looked up at each access.
    """

    def __init__(self, joint: Joint, index: int = 0) -> None:
        self.joint, self.index, self.name = joint, index, joint.name
        self._is_alone = len(joint.scene.axes) == 1

    @property
    def dof(self) -> int:
        """Index among MuJoCo's degrees of freedom."""
        return self.joint.mj_dofs[self.index]

    @property
    def position(self) -> float:
        """Position [rad or m]."""
        value = self.joint.position
        return value if isinstance(value, float) else float(value[self.index])

    @property
    def velocity(self) -> float:
        """Velocity [rad/s or m/s]."""
        value = self.joint.velocity
        return value if isinstance(value, float) else float(value[self.index])

    @property
    def effort_limit(self) -> float:
        """Effort limit [N·m or N]; infinite if unlimited."""
        return self._limit(self.joint._effort_limit)

    @property
    def velocity_limit(self) -> float:
        """Velocity limit [rad/s or m/s]; infinite if unlimited."""
        return self._limit(self.joint._velocity_limit)

    def _limit(self, limits: Vector) -> float:
        # read at every step, and much faster than the joint's property
        value: float = limits.item(self.index if len(limits) > 1 else 0)
        return value

    def is_meant(self, name: str) -> bool:
        """Check whether a scoped name is the name of this joint or of its top-level model."""
        return name in (self.joint.scoped, self.joint.scoped.split("::")[0])

    def push(self, effort: float) -> None:
        """Set the effort of the next step; an effort that was set earlier for this step is replaced.

        NaN and infinite values become a finite effort that is so large that the physics reports its divergence.
        """
        effort = max(-LARGEST, min(LARGEST, float(effort)))
        if self._is_alone:
            self.joint.set_effort(effort)
        else:
            efforts = self._pending()
            efforts[self.index] = effort
            self.joint.set_effort(efforts)

    def add(self, effort: float) -> None:
        """Add to the effort of the next step."""
        self.push(effort + float(self._pending()[self.index]))

    def _pending(self) -> Vector:
        applied = self.joint._physics.data.qfrc_applied
        return np.array([applied[dof] for dof in self.joint.mj_dofs])


def find_joints(scene: SceneModel, params: Params, axis: int = 0, most: int | None = None) -> list[SceneJoint]:
    """Find the joints that the `<joint_name>` elements name, and report the names that cannot be used.

    Args:
        scene: Model that contains the joints.
        params: Parameters of the plugin; a missing `<joint_name>` is an error.
        axis: Index of the required axis; joints with fewer axes are an error.
        most: Number of `<joint_name>` elements to read; None for all.
    """
    joints = []
    element = "joint_name"
    elements = params.all(element)[:most]
    if not elements:
        params.text(element, required=True)
    for joint_name in elements:
        if not joint_name.value:
            joint_name.error("SK-PARAM-002", f"found an empty <{element}>; expected the name of a joint")
            continue
        joint = find_joint(scene, joint_name.value, joint_name)
        if joint is not None and has_axis(joint, axis, joint_name):
            joints.append(joint)
    return joints


def has_axis(joint: SceneJoint, axis: int, params: Params) -> bool:
    """Check whether a joint has the axis with this index, and report an error if not."""
    if axis < len(joint.axes):
        return True
    axes = counted(len(joint.axes), "axis", "axes") if joint.axes else "no axes"
    message = f"joint {joint.name!r} is {joint.type} and has {axes}"
    params.error("SK-PLUGIN-003", f"{message}; the plugin needs a joint with axis number {axis}")
    return False


def suggest_names(name: str, names: Sequence[str]) -> str:
    """Return the end of a 'joint not found' message: the closest name, or all names."""
    return did_you_mean(name, names) or "there is " + (", ".join(map(repr, names[:20])) or "none")
