"""Constraints between bodies and between joints: welds, gearboxes, mimics, threads."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import mujoco
import numpy as np

from simkit.compiler.name_map import Follower, JointBinding, ModelRecord
from simkit.diagnostics import Diagnostics, did_you_mean
from simkit.linear_algebra import dot
from simkit.pose import Vector
from simkit.scene import Mimic, SceneJoint
from simkit.scene.model import MOST_LEADERS

STIFF_SOLIMP: Final = (0.9999, 0.9999, 0.001, 0.5, 2.0)
"""Impedance of equality constraints for mechanisms: the hardest that the solver supports."""

LOOP_DAMPING: Final = 0.5
"""Damping ratio of the weld that closes a loop.

With a time constant of two steps the weld corrects a gap within one step. A step of the engine moves a body along a
chord of its circular path. On a circle of radius R at the angular velocity omega, this opens the joint by omega² R ·
step · time constant · damping ratio².
"""

_ONE_NUMBER: Final = ("revolute", "continuous", "prismatic", "universal", "revolute2", "screw", "planar")
_ALONG: Final = 1.0 - 1e-6


class Couplings:
    """Writer of equality constraints. The record of the model receives their names."""

    def __init__(self, spec: mujoco.MjSpec, record: ModelRecord, timestep: float, diagnostics: Diagnostics) -> None:
        self.spec, self.record, self.timestep, self.diagnostics = spec, record, timestep, diagnostics

    def couple(self, name: str, follower: str, leader: str, offset: float, ratio: float) -> None:
        """Couple one MuJoCo joint to another: follower = offset + ratio · leader."""
        equality = self._equality(name, mujoco.mjtEq.mjEQ_JOINT, mujoco.mjtObj.mjOBJ_JOINT, follower, leader)
        data = np.zeros(len(equality.data))
        data[:2] = offset, ratio
        equality.data = data

    def weld(
        self, name: str, body: str, other: str, anchor_in_other: Vector, active: bool = True, damping: float = 1.0
    ) -> None:
        """Hold two MuJoCo bodies at their relative pose in the specification, with a damping ratio."""
        equality = self._equality(name, mujoco.mjtEq.mjEQ_WELD, mujoco.mjtObj.mjOBJ_BODY, body, other)
        data = np.zeros(len(equality.data))
        # if the relative pose is all zeros, MuJoCo uses the relative pose of the specification
        data[:3] = anchor_in_other
        data[10] = 1.0
        equality.data = data
        equality.solref = (equality.solref[0], damping)
        equality.active = active

    def _equality(
        self, name: str, kind: mujoco.mjtEq, object_type: mujoco.mjtObj, first: str, second: str
    ) -> mujoco.MjsEquality:
        equality = self.spec.add_equality(name=name)
        equality.type, equality.objtype = kind, object_type
        equality.name1, equality.name2 = first, second
        equality.solref = (max(2.0 * self.timestep, 0.002), 1.0)
        equality.solimp = STIFF_SOLIMP
        self.record.equalities.append(name)
        return equality

    # ------------------------------------------------------------------ gearboxes

    def gear(self, joint: SceneJoint) -> tuple[str, ...]:
        """Add a gearbox: theta_2 = −ratio · theta_1, both measured from the reference link (SDF's definition).

        Returns:
            Names of the gearbox's constraints.
        """
        first = self._gear_hinge(joint, joint.parent_link, 0)
        second = self._gear_hinge(joint, joint.child_link, 1)
        if first is None or second is None:
            message = (
                f"gearbox {joint.scoped} is ignored: its links need a revolute joint to the reference link "
                f"{joint.gearbox_reference or '(none)'} along its axes"
            )
            self.diagnostics.warning("SK-PHYS-021", message, joint.where)
            return ()
        name = f"{joint.scoped}#gear"
        ratio = -joint.gearbox_ratio * first[1] * second[1]
        self.couple(name, second[0], first[0], 0.0, ratio)
        self._add_follower(first[2], Follower(second[0], ratio))
        message = f"gearbox {joint.scoped} is a stiff constraint between two joints"
        self.diagnostics.note("SK-PHYS-009", message, joint.where)
        return (name,)

    def _gear_hinge(self, joint: SceneJoint, link: str, axis: int) -> tuple[str, float, JointBinding] | None:
        """Return the hinge between the reference and `link`.

        Returns:
            MuJoCo joint, sign of its angle on the gearbox axis, and its binding; None without a hinge.
        """
        for other in self.record.joints.values():
            ends = {other.scene.parent_link, other.scene.child_link}
            turns = other.type in ("revolute", "continuous") and bool(other.joint_names)
            if not turns or ends != {joint.gearbox_reference, link}:
                continue
            other_axis = other.scene.axes[0].xyz_world
            along = dot(joint.axes[axis].xyz_world, other_axis) if axis < len(joint.axes) else 1.0
            if abs(along) < _ALONG:
                continue
            sign = 1.0 if along > 0.0 else -1.0
            return other.joint_names[0], (sign if other.scene.child_link == link else -sign), other
        return None

    # ------------------------------------------------------------------ mimics

    def mimics(self, joints: list[SceneJoint]) -> None:
        """Couple every axis with a `<mimic>` to the axis at the end of its chain of leaders."""
        mimics = {(j.scoped, i): (j, a.mimic) for j in joints for i, a in enumerate(j.axes) if a.mimic is not None}
        for (scoped, axis), (joint, _) in mimics.items():
            law = self._first_leader(joint, axis, mimics)
            if law is None:
                continue
            leader, leader_axis, ratio, offset = law
            follower = self.record.joints[scoped].joint_names[axis]
            self.couple(f"{scoped}#mimic{axis}", follower, leader.joint_names[leader_axis], offset, ratio)
            self._add_follower(leader, Follower(follower, ratio, offset=offset, axis=leader_axis))

    def tie(self, follower: str, leader: str, ratio: float, offset: float) -> bool:
        """Make the first axis of a joint follow the first axis of another joint: follower = offset + ratio · leader.

        Both joints are scoped names.

        Returns:
            False if the joint follows another one already; nothing changes then.
        """
        if f"{follower}#mimic0" in self.record.equalities:
            return False
        binding, follower_name = self.record.joints[leader], self.record.joints[follower].joint_names[0]
        self.couple(f"{follower}#mimic0", follower_name, binding.joint_names[0], offset, ratio)
        self._add_follower(binding, Follower(follower_name, ratio, offset=offset))
        return True

    def _first_leader(
        self, joint: SceneJoint, axis: int, mimics: dict[tuple[str, int], tuple[SceneJoint, Mimic]]
    ) -> tuple[JointBinding, int, float, float] | None:
        """Return the leader at the end of a mimic chain, its axis, and the ratio and the offset of the whole chain.

        Return None and report an error or a warning if the chain has no valid leader.
        """
        ratio, offset = 1.0, 0.0
        at, seen = (joint.scoped, axis), {(joint.scoped, axis)}
        while at in mimics:
            follower, law = mimics[at]
            leader = self._leader(follower, at[1], law)
            if leader is None:
                return None
            offset += ratio * (law.offset - law.multiplier * law.reference)
            ratio *= law.multiplier
            at = (leader.scoped, law.axis)
            if at in seen:
                ring = " -> ".join(name for name, _ in sorted(seen))
                message = f"joint {joint.scoped} mimics itself in a cycle: {ring}"
                self.diagnostics.error("SK-JOINT-001", message, joint.where)
                return None
            seen.add(at)
            if len(seen) > MOST_LEADERS + 1:  # with the joint itself
                message = f"joint {joint.scoped} follows a chain of more than {MOST_LEADERS} mimics"
                hint = "let each follower mimic the first joint of the chain"
                self.diagnostics.error("SK-JOINT-017", message, joint.where, hint)
                return None
        if not (np.isfinite(ratio) and np.isfinite(offset)):
            message = f"joint {joint.scoped}: multiplier, offset or reference is NaN or infinite"
            self.diagnostics.error("SK-JOINT-003", message, joint.where)
            return None
        return self.record.joints[at[0]], at[1], ratio, offset

    def _leader(self, joint: SceneJoint, axis: int, law: Mimic) -> JointBinding | None:
        known = self.record.joints
        leader = known.get(law.joint) or known.get(joint.scoped.removesuffix(joint.name) + law.joint)
        follower = known.get(joint.scoped)
        if follower is not None and leader is not None and _has_axis(follower, axis) and _has_axis(leader, law.axis):
            return leader
        hint = did_you_mean(law.joint, [j.name for j in (b.scene for b in known.values())]) if leader is None else ""
        message = f"joint {joint.scoped}: its mimic of {law.joint} is ignored: the joint or its axis does not exist"
        self.diagnostics.warning("SK-PHYS-022", message, joint.where, hint)
        return None

    def _add_follower(self, leader: JointBinding, follower: Follower) -> None:
        current = self.record.joints[leader.scoped]
        self.record.joints[leader.scoped] = replace(current, followers=(*current.followers, follower))


def _has_axis(binding: JointBinding, axis: int) -> bool:
    return binding.type in _ONE_NUMBER and 0 <= axis < len(binding.joint_names)
