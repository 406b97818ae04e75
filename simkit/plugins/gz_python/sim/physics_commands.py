"""Commands of systems to the physics, carried out before each step by the rules of gz-sim's physics system.

Commands to joints and velocities of links stay, as zeros, once they were given: gz-sim empties them after each step but
does not take them back, so a joint that was given a velocity once is held at rest from the next step on, and one that
was given a force no longer takes velocities.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from simkit.plugins.gz_python.math.simkit_conversion import cross_product
from simkit.plugins.gz_python.sim.entity_table import Handle
from simkit.pose import Pose, Vector, quat_conjugate, quat_rotate

if TYPE_CHECKING:
    from simkit.runtime import Joint, Link, Simulation

Numbers = tuple[float, ...]
FindHandle = Callable[[int, str], Handle]
"""Gives simkit's handle of an entity that is of a kind; None where it is not."""


class PhysicsCommands:
    """The commands that wait for the next step, by entity.

    Attributes:
        force, velocity: of joints [N·m, N; rad/s, m/s]; kept as zeros after a step.
        position_reset, velocity_reset: the state of joints, once.
        wrench: of links: force [N] and torque [N·m] in world axes, at the link's origin.
        pose: of models in the world.
        linear, angular: velocity of models [m/s, rad/s] and links in their own axes; kept as zeros after a step.
        limits: of joints: what is limited, and (lower, upper) for each axis.
    """

    def __init__(self) -> None:
        self.force: dict[int, Numbers] = {}
        self.velocity: dict[int, Numbers] = {}
        self.position_reset: dict[int, Numbers] = {}
        self.velocity_reset: dict[int, Numbers] = {}
        self.wrench: dict[int, tuple[Numbers, Numbers]] = {}
        self.pose: dict[int, Pose] = {}
        self.linear: dict[int, Numbers] = {}
        self.angular: dict[int, Numbers] = {}
        self.limits: dict[tuple[int, str], tuple[Numbers, ...]] = {}

    def copy(self) -> PhysicsCommands:
        other = PhysicsCommands()
        for name, values in vars(self).items():
            setattr(other, name, dict(values))
        return other

    def add_wrench(self, entity: int, force: Sequence[float], torque: Sequence[float]) -> None:
        """Adds to what pushes a link in the next step."""
        before = self.wrench.get(entity)
        if before is None:
            self.wrench[entity] = (tuple(force), tuple(torque))
        else:
            both = zip(before, (force, torque), strict=True)
            pushed, turned = (tuple(a + b for a, b in zip(old, new, strict=True)) for old, new in both)
            self.wrench[entity] = (pushed, turned)

    @property
    def is_empty(self) -> bool:
        return not any(vars(self).values())

    def carry_out(self, sim: Simulation, handle: FindHandle) -> None:
        """Carry out all commands; those for an entity that was removed are dropped."""
        for (entity, what), bounds in self.limits.items():
            if joint := handle(entity, "joint"):
                _set_limit(joint, what, bounds)
        for entity, position in self.position_reset.items():
            if joint := handle(entity, "joint"):
                joint.set_position(_first_numbers(position, joint.dof, joint.position))
        for entity, velocity in self.velocity_reset.items():
            if joint := handle(entity, "joint"):
                joint.set_velocity(_first_numbers(velocity, joint.dof, joint.velocity))
        for entity, (force, torque) in self.wrench.items():
            if link := handle(entity, "link"):
                com = link.scene.inertial.com
                about = cross_product(link.pose.rotate(com).tolist(), force) if any(com) else (0.0, 0.0, 0.0)
                link.apply_wrench(force, [t - a for t, a in zip(torque, about, strict=True)])
        for entity, pose in self.pose.items():
            if model := handle(entity, "model"):
                model.set_pose(pose)
        for part, velocities in (("angular", self.angular), ("linear", self.linear)):
            for entity, velocity in velocities.items():
                root = _free_root(sim, entity, handle)
                if root is not None:
                    _set_link_velocity(sim, *root, part, velocity)
        for entity, effort in self.force.items():
            # a zero is what is left of an earlier command, and must not undo what another plugin asks of the joint
            if any(effort) and (joint := handle(entity, "joint")):
                joint.set_effort(_first_numbers(effort, joint.dof, 0.0))
        held = [e for e in self.velocity if e not in self.force and e not in self.velocity_reset]
        turned = [(joint, self.velocity[e]) for e in held if (joint := handle(e, "joint"))]
        if turned:
            _set_angular_velocities(sim, turned)
        self._clear_after_step()

    def _clear_after_step(self) -> None:
        """After a step's commands: what stays becomes zero, the rest goes."""
        for once in (self.position_reset, self.velocity_reset, self.wrench, self.pose, self.limits):
            once.clear()
        for kept in (self.force, self.velocity, self.linear, self.angular):
            for entity, values in kept.items():
                kept[entity] = (0.0,) * len(values)


def _first_numbers(values: Numbers, count: int, otherwise: float | Vector) -> float | Numbers:
    """As many of the values as a joint has degrees of freedom; those missing are what they are."""
    if len(values) >= count:
        return float(values[0]) if count == 1 else values[:count]
    rest = np.broadcast_to(np.atleast_1d(np.asarray(otherwise, dtype=float)), (count,))
    return (*values, *rest[len(values) :].tolist())


def _set_limit(joint: Joint, what: str, bounds: tuple[Numbers, ...]) -> None:
    """Sets a joint's limits, of every axis the same as simkit's handle takes them: of the first."""
    if not bounds:
        return
    lower, upper = bounds[0]
    if what == "position":
        joint.lower, joint.upper = lower, upper
    elif what == "velocity":
        joint.velocity_limit = max(abs(lower), abs(upper))
    else:
        joint.effort_limit = max(abs(lower), abs(upper))


def _free_root(sim: Simulation, entity: int, handle: FindHandle) -> tuple[Link, Pose] | None:
    """The link that carries what a model or link moves with, and the frame its velocity is given in.

    None where nothing of it is free.
    """
    link, model = handle(entity, "link"), handle(entity, "model")
    if link is not None:
        start, frame = link, link.pose
    elif model is not None:
        links = model.scene.all_links()
        if not links:
            return None
        start, frame = sim.link(model.scene.canonical_link or links[0].scoped), model.pose
    else:
        return None
    names, mj_model = sim.engine.names, sim.mj_model
    root = int(mj_model.body_rootid[names.link(start.scoped).body])
    for scoped, binding in names.links.items():
        if int(binding.body) == root and binding.root_joint_qpos >= 0:
            return sim.link(scoped), frame
    return None


def _set_link_velocity(sim: Simulation, link: Link, frame: Pose, part: str, velocity: Numbers) -> None:
    """Gives a free link a linear or an angular velocity; the other part stays."""
    from simkit.runtime.engine.physics_step import VELOCITY

    binding, data = sim.engine.names.link(link.scoped), sim.mj_data
    start, dof = int(binding.root_joint_qpos), int(binding.root_joint_dof)
    quaternion = data.qpos[start + 3 : start + 7]
    wanted = frame.rotate(velocity)
    if part == "angular":
        kept = link.linear_velocity
        data.qvel[dof + 3 : dof + 6] = quat_rotate(quat_conjugate(quaternion), wanted)
        wanted = kept  # of the link's origin, which need not be where the engine measures
    spin = quat_rotate(quaternion, data.qvel[dof + 3 : dof + 6])
    arm = data.qpos[start : start + 3] - link.pose.position
    data.qvel[dof : dof + 3] = wanted + np.cross(spin, arm)
    sim.engine.physics.changed_body(VELOCITY, binding.body)


def _set_angular_velocities(sim: Simulation, turned: list[tuple[Joint, Numbers]]) -> None:
    """Applies the efforts, within their limits, that bring joints to velocities within one step, contacts aside.

    With the acceleration a without them, the inertia I that they feel at these degrees of freedom and the damping D,
    which the engine integrates implicitly: τ = (I + step·D) (v − q') / step − I a.
    """
    import mujoco

    targets: dict[int, float] = {}
    for joint, velocities in turned:
        limits = np.broadcast_to(np.atleast_1d(joint.velocity_limit), (max(joint.dof, 1),)).tolist()
        for dof, velocity, limit in zip(joint.mj_dofs, velocities, limits, strict=False):
            targets[dof] = max(-limit, min(limit, velocity))
    dofs = list(targets)
    if not dofs:
        return
    model, data = sim.mj_model, sim.engine.physics.fresh()
    units, solved = np.zeros((len(dofs), model.nv)), np.zeros((len(dofs), model.nv))
    units[range(len(dofs)), dofs] = 1.0
    mujoco.mj_solveM(model, data, solved, units)
    inertia = np.linalg.inv(solved[:, dofs])
    gained = (np.array([targets[d] for d in dofs]) - data.qvel[dofs]) / sim.timestep
    damped = sim.timestep * model.dof_damping[dofs] * gained
    efforts = dict(zip(dofs, (inertia @ (gained - data.qacc[dofs]) + damped).tolist(), strict=True))
    for joint, _ in turned:
        values = [efforts.get(dof, 0.0) for dof in joint.mj_dofs]
        if values:
            joint.set_effort(values[0] if len(values) == 1 else values)
