"""Commands of gz systems to the physics, applied before each step by the rules of gz-sim's physics system.

After each step, gz-sim sets velocity and force commands to zero, but does not remove them; simkit does the same. After
one velocity command, a joint is therefore held at rest in all later steps. After one force command, a joint ignores all
velocity commands.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from simkit import Pose
from simkit.extend import Vector
from simkit.linear_algebra import inverse, matmul
from simkit.pose import quat_conjugate, quat_rotate
from simkit_gz_python.math.simkit_conversion import cross_product
from simkit_gz_python.sim.entity_table import Handle

if TYPE_CHECKING:
    from simkit import Joint, Link, Simulation

Numbers = tuple[float, ...]
FindHandle = Callable[[int, str], Handle]
"""Function that returns simkit's handle of an entity; None if the entity is removed or is not of the given kind."""


class PhysicsCommands:
    """Commands for the next step, by number of the entity.

    Attributes:
        force, velocity: commanded efforts [N·m or N] and velocities [rad/s or m/s] of joints; set to zero after a step.
        position_reset, velocity_reset: positions [rad or m] and velocities [rad/s or m/s] of joints to be set once.
        wrench: force [N] and torque [N·m] on links, in world axes, at the link's origin.
        pose: poses of models in the world.
        linear, angular: velocities [m/s, rad/s] of models and links, in their own axes; set to zero after a step.
        limits: (lower, upper) for each axis of a joint, by entity and quantity ("position", "velocity" or "effort").
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
        """Add a force and a torque to the wrench on a link for the next step."""
        previous = self.wrench.get(entity)
        if previous is None:
            self.wrench[entity] = (tuple(force), tuple(torque))
        else:
            pairs = zip(previous, (force, torque), strict=True)
            total_force, total_torque = (tuple(a + b for a, b in zip(old, new, strict=True)) for old, new in pairs)
            self.wrench[entity] = (total_force, total_torque)

    @property
    def is_empty(self) -> bool:
        """True if there are no commands."""
        return not any(vars(self).values())

    def carry_out(self, sim: Simulation, handle: FindHandle) -> None:
        """Apply all commands; commands for a removed entity are ignored."""
        for (entity, quantity), bounds in self.limits.items():
            if joint := handle(entity, "joint"):
                _set_limit(joint, quantity, bounds)
        for entity, position in self.position_reset.items():
            if joint := handle(entity, "joint"):
                joint.set_position(_first_numbers(position, joint.dof, joint.position))
        for entity, velocity in self.velocity_reset.items():
            if joint := handle(entity, "joint"):
                joint.set_velocity(_first_numbers(velocity, joint.dof, joint.velocity))
        for entity, (force, torque) in self.wrench.items():
            if link := handle(entity, "link"):
                com = link.scene.inertial.com
                shift = cross_product(link.pose.rotate(com).tolist(), force) if any(com) else (0.0, 0.0, 0.0)
                link.apply_wrench(force, [t - s for t, s in zip(torque, shift, strict=True)])
        for entity, pose in self.pose.items():
            if model := handle(entity, "model"):
                model.set_pose(pose)
        for part, velocities in (("angular", self.angular), ("linear", self.linear)):
            for entity, velocity in velocities.items():
                root = _free_root(sim, entity, handle)
                if root is not None:
                    _set_link_velocity(sim, *root, part, velocity)
        for entity, effort in self.force.items():
            # zeros remain after an earlier command, and must not replace the command of another plugin
            if any(effort) and (joint := handle(entity, "joint")):
                joint.set_effort(_first_numbers(effort, joint.dof, 0.0))
        driven = [e for e in self.velocity if e not in self.force and e not in self.velocity_reset]
        commands = [(joint, self.velocity[e]) for e in driven if (joint := handle(e, "joint"))]
        if commands:
            _apply_joint_velocities(sim, commands)
        self._clear_after_step()

    def _clear_after_step(self) -> None:
        """Set force and velocity commands to zero, and remove all other commands."""
        for one_time in (self.position_reset, self.velocity_reset, self.wrench, self.pose, self.limits):
            one_time.clear()
        for lasting in (self.force, self.velocity, self.linear, self.angular):
            for entity, values in lasting.items():
                lasting[entity] = (0.0,) * len(values)


def _first_numbers(values: Numbers, count: int, default: float | Vector) -> float | Numbers:
    """Return the first `count` values; a missing value becomes the default."""
    if len(values) >= count:
        return float(values[0]) if count == 1 else values[:count]
    rest = np.broadcast_to(np.atleast_1d(np.asarray(default, dtype=float)), (count,))
    return (*values, *rest[len(values) :].tolist())


def _set_limit(joint: Joint, quantity: str, bounds: tuple[Numbers, ...]) -> None:
    """Set the limits of a joint to those of its first axis, because simkit has the same limits for all axes."""
    if not bounds:
        return
    lower, upper = bounds[0]
    if quantity == "position":
        joint.lower, joint.upper = lower, upper
    elif quantity == "velocity":
        joint.velocity_limit = max(abs(lower), abs(upper))
    else:
        joint.effort_limit = max(abs(lower), abs(upper))


def _free_root(sim: Simulation, entity: int, handle: FindHandle) -> tuple[Link, Pose] | None:
    """Return the root link of the free body that contains a model or link, and the frame of its velocity command.

    Returns None if the model or link is not part of a free body.
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
    """Set the "linear" or "angular" velocity of a free link; the other velocity stays the same."""
    from simkit.runtime.engine.physics_step import VELOCITY

    binding, data = sim.engine.names.link(link.scoped), sim.mj_data
    start, dof = int(binding.root_joint_qpos), int(binding.root_joint_dof)
    quaternion = data.qpos[start + 3 : start + 7]
    linear = target = frame.rotate(velocity)
    if part == "angular":
        linear = link.linear_velocity  # at the link's origin, which may differ from the origin of the engine's body
        data.qvel[dof + 3 : dof + 6] = quat_rotate(quat_conjugate(quaternion), target)
    spin = quat_rotate(quaternion, data.qvel[dof + 3 : dof + 6])
    arm = data.qpos[start : start + 3] - link.pose.position
    data.qvel[dof : dof + 3] = linear + np.cross(spin, arm)
    sim.engine.physics.changed_body(VELOCITY, binding.body)


def _apply_joint_velocities(sim: Simulation, commands: list[tuple[Joint, Numbers]]) -> None:
    """Apply the efforts, within the limits, that bring joints to their commanded velocities v in one step.

    The effort is τ = (I + step·D) (v − q') / step − I a. I is the effective inertia, q' the current velocity, and a the
    acceleration without these efforts. D is the damping, which the engine integrates implicitly. New contacts during
    the step are not considered.
    """
    import mujoco

    targets: dict[int, float] = {}
    for joint, velocities in commands:
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
    inertia = inverse(solved[:, dofs])
    acceleration = (np.array([targets[d] for d in dofs]) - data.qvel[dofs]) / sim.timestep
    damping = sim.timestep * model.dof_damping[dofs] * acceleration
    efforts = dict(zip(dofs, (matmul(inertia, acceleration - data.qacc[dofs]) + damping).tolist(), strict=True))
    for joint, _ in commands:
        values = [efforts.get(dof, 0.0) for dof in joint.mj_dofs]
        if values:
            joint.set_effort(values[0] if len(values) == 1 else values)
