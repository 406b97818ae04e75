"""Move a model by setting its velocity instead of wheel forces, for velocity control and planar move."""

from __future__ import annotations

import abc
import functools
import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.linear_algebra import matmul
from simkit.params import LARGEST
from simkit.plugins.base import ModelPlugin
from simkit.plugins.not_deep_copied import SharedByCopies
from simkit.pose import IDENTITY, Pose, Vector
from simkit.runtime.engine.physics_step import STALE, VELOCITY

if TYPE_CHECKING:
    from simkit.runtime import Simulation

Triple = tuple[float, float, float]

LARGEST_STEP: Final = 1.0
"""Largest commanded motion in a step [m]. A model on a plane diverges at 10 m."""

LARGEST_TURN: Final = 0.2
"""Largest commanded rotation in a step [rad], as for the wheels of a drive. A model diverges at 10 rad."""

_STATIC, _OTHER = -1, -2  # values of `_owners` for geoms that no motion moves
_SIX = np.arange(6)


class KinematicMotion(SharedByCopies):
    """Free links of a model that move together as one rigid body. A deep copy returns the same object.

    Joints below the free links keep their velocities; gravity and inertia still act on a carried arm.

    Args:
        sim: Simulation of the model.
        links: Scoped names of links. Links that have a parent link or are fixed to the world are ignored.
        carrier: Scoped name of the link that carries the frame.
        frame: Pose of the frame in the carrier.
    """

    def __init__(self, sim: Simulation, links: Iterable[str], carrier: str, frame: Pose = IDENTITY) -> None:
        self._sim, self.links, self._carrier, self._frame = sim, tuple(links), carrier, frame
        names = sim.engine.names
        self._roots = [name for name in self.links if names.link(name).root_joint_dof >= 0]
        self._bound: object = None

    def __bool__(self) -> bool:
        return bool(self._roots)

    @property
    def frame(self) -> Pose:
        """World pose of the frame. After a velocity was set, reading this pose needs no new forward pass."""
        self.bind()
        physics = self._sim.engine.physics
        if physics.stage == STALE:
            physics.fresh()
        data = physics.data
        pose = Pose(data.xpos[self._body], data.xquat[self._body])
        return pose if self._offset == IDENTITY else pose @ self._offset

    def bind(self) -> None:
        """Look up the addresses of the links in the current compiled model."""
        sim = self._sim
        if self._bound is sim.mj_model:
            return
        self._bound, names = sim.mj_model, sim.engine.names
        carrier = names.link(self._carrier)
        self._body, self._offset = int(carrier.body), carrier.offset @ self._frame
        roots = [names.link(name) for name in self._roots]
        self.addresses = [(int(b.root_joint_dof), int(b.root_joint_qpos), int(b.body)) for b in roots]
        self.geoms = [geom for name in self.links for geom in names.link(name).geoms]


@dataclass(frozen=True, slots=True)
class VelocityTarget:
    """Commanded motion for the next step: the links move as if they were fixed to a frame that has this twist.

    Attributes:
        motion: Links to move.
        frame: Pose of the frame in the world.
        linear, angular: Velocity of the frame's origin and angular velocity, in the frame's axes [m/s, rad/s].
        falls: True to let the model fall while it has no contact; then the vertical speed is not commanded.
    """

    motion: KinematicMotion
    frame: Pose
    linear: Triple
    angular: Triple
    falls: bool = False


class KinematicMover(SharedByCopies):
    """Applies velocity targets of many models; the computation that they share is done once per step.

    A deep copy returns the same object.
    """

    def __init__(self, sim: Simulation) -> None:
        self._sim = sim
        self._bound: tuple[object, tuple[KinematicMotion, ...]] = (None, ())

    def move(self, moves: Sequence[VelocityTarget]) -> None:
        """Apply the targets to the next step only.

        During the step each frame moves along the exact path of its twist: a screw motion, or an arc in the plane.

        Args:
            moves: Targets whose links are not connected by joints.
        """
        if not moves:
            return
        sim, physics = self._sim, self._sim.engine.physics
        self._bind(tuple(move.motion for move in moves))
        if physics.stage == STALE:
            physics.fresh()
        # all targets use the positions and unconstrained accelerations of one forward pass
        data = physics.data
        touched = self._smooth_contacts(data) if data.ncon else frozenset()
        mobility = self._mobilities(data)
        gravity, weightless, step = sim.mj_model.opt.gravity, sim.mj_model.body_gravcomp, sim.timestep
        for index, move in enumerate(moves):
            falls = move.falls and index not in touched
            origin, axes = move.frame.position, move.frame.matrix
            shift, turn = _screw(move.linear, move.angular, step)
            turn, target = matmul(axes, turn, axes.T), origin + matmul(axes, shift)
            turning = matmul(axes, move.angular)
            for dof, qpos, body in move.motion.addresses:
                root = data.qpos[qpos : qpos + 3]
                velocity = (target + matmul(turn, root - origin) - root) / step
                lacking = -data.qacc_smooth[dof : dof + 6]
                if falls:
                    lacking[2] += gravity[2] * (1.0 - weightless[body])
                    velocity[2] = data.qvel[dof + 2]
                data.qfrc_applied[dof : dof + 6] += _solve_force(mobility[:, dof : dof + 6], lacking)
                data.qvel[dof : dof + 3] = velocity
                data.qvel[dof + 3 : dof + 6] = matmul(turning, data.xmat[body].reshape(3, 3))
                physics.push_once()
                physics.changed_body(VELOCITY, body)

    def _mobilities(self, data: mujoco.MjData) -> Vector:
        """Return the accelerations for unit forces on the six degrees of freedom of each free link, shape (6, nv).

        One table row is enough for all free links: the links are in different kinematic trees, so a force on one link
        does not accelerate another link.
        """
        mujoco.mj_solveM(self._sim.mj_model, data, self._columns, self._units)
        return self._columns

    def _smooth_contacts(self, data: mujoco.MjData) -> frozenset[int]:
        """Remove the friction between moved models and static geometry; return the indices of models in contact.

        Gravity on a moved model is compensated, so there is no normal force that could cause friction. With friction,
        MuJoCo's convex friction cone would add a normal force at high sliding speeds, which lifts and tilts the model.
        """
        contacts = data.contact
        first, second = self._owners[contacts.geom.T]
        lower, higher = np.minimum(first, second), np.maximum(first, second)
        sliding = np.flatnonzero((higher >= 0) & ((lower == _STATIC) | (lower == higher)))
        if len(sliding) and self._is_pyramidal:  # the constraint rows contain pyramidal friction, so they are rebuilt
            contacts.dim[sliding] = 1
            model = self._sim.mj_model
            mujoco.mj_makeConstraint(model, data)
            if not model.opt.disableflags & int(mujoco.mjtDisableBit.mjDSBL_ISLAND):
                mujoco.mj_island(model, data)
            mujoco.mj_projectConstraint(model, data)
        elif len(sliding):
            friction, mu = contacts.friction, contacts.mu
            mu[sliding] *= mujoco.mjMINMU / friction[sliding, 0]
            friction[sliding] = mujoco.mjMINMU
        return frozenset(first.tolist()) | frozenset(second.tolist())

    def _bind(self, motions: tuple[KinematicMotion, ...]) -> None:
        """Build the tables for these motions in the current compiled model."""
        model = self._sim.mj_model
        if self._bound[0] is model and self._bound[1] == motions:
            return
        self._bound = model, motions
        self._is_pyramidal = model.opt.cone == mujoco.mjtCone.mjCONE_PYRAMIDAL
        self._units, self._columns = np.zeros((6, model.nv)), np.zeros((6, model.nv))
        owners = np.where(np.append(model.geom_bodyid, -1) == 0, _STATIC, _OTHER)  # index -1 means no geom
        for index, motion in enumerate(motions):
            motion.bind()
            owners[motion.geoms] = index
            for dof, _, _ in motion.addresses:
                self._units[_SIX, _SIX + dof] = 1.0
        self._owners: npt.NDArray[np.int_] = owners


class KinematicPlugin(ModelPlugin):
    """Plugin that sets the velocity of its model, or of links of the model, at every step."""

    drives = True
    _mover: KinematicMover

    @abc.abstractmethod
    def velocity_targets(self) -> list[VelocityTarget]:
        """Return the commanded velocities of the next step."""

    def bounded(self, linear: Triple, angular: Triple) -> tuple[Triple, Triple]:
        """Return a commanded twist with at most `LARGEST_STEP` and `LARGEST_TURN` in a step; warn if it was larger."""
        step = self.sim.timestep
        shortened = [_shortened(linear, LARGEST_STEP / step), _shortened(angular, LARGEST_TURN / step)]
        if shortened != [linear, angular]:
            text = (
                f"a command asks for {math.hypot(*linear):.4g} m/s and {math.hypot(*angular):.4g} rad/s; the model "
                f"gets {LARGEST_STEP / step:g} m/s and {LARGEST_TURN / step:g} rad/s at most"
            )
            self._once.warn("SK-PHYS-033", "bound", text, "send a smaller command")
        return shortened[0], shortened[1]

    def before_step(self) -> None:
        """Set the velocities for the next step."""
        self._mover.move(self.velocity_targets())

    @classmethod
    def before_step_together(cls, plugins: Sequence[KinematicPlugin]) -> Callable[[Iterable[KinematicPlugin]], None]:
        """Return a function that runs `before_step` of many plugins and does their common computation only once."""
        mover = KinematicMover(plugins[0].sim)

        def run(rota: Iterable[KinematicPlugin]) -> None:
            mover.move([move for plugin in rota for move in plugin.velocity_targets()])

        return run


def _shortened(vector: Triple, most: float) -> Triple:
    """Return a vector that is not longer than `most`, in the same direction."""
    length = math.hypot(*vector)
    if length <= most:
        return vector
    x, y, z = (value * (most / length) for value in vector)
    return x, y, z


def _solve_force(mobility: Vector, acceleration: Vector) -> Vector:
    """Return the force (6,) that produces an acceleration (6,); the mobility (6, 6) is positive definite."""
    factor, force = np.ascontiguousarray(mobility), np.empty(6)
    mujoco.mju_cholFactor(factor, 0.0)
    mujoco.mju_cholSolve(force, factor, acceleration)
    return force


@functools.lru_cache(maxsize=256)
def _screw(linear: Triple, angular: Triple, step: float) -> tuple[Vector, Vector]:
    """Return the shift (3,) and rotation matrix (3, 3) of a frame after one step with a twist in the frame's axes.

    This is the exponential map of SE(3). For small angles a series replaces the quotients, which would lose digits.
    """
    v, w = (np.clip(motion, -LARGEST, LARGEST) * step for motion in (linear, angular))
    square = float(matmul(w, w))
    if square > 1e-6:
        angle = math.sqrt(square)
        first, second = (1 - math.cos(angle)) / square, (angle - math.sin(angle)) / (angle * square)
    else:
        first, second = 0.5 - square / 24, 1 / 6 - square / 120
    x, y, z = w
    across = np.array(((0, -z, y), (z, 0, -x), (-y, x, 0)))
    turn = np.eye(3) + (1 - square * second) * across + matmul(first * across, across)
    shift = v + first * matmul(across, v) + second * matmul(across, matmul(across, v))
    shift.flags.writeable = turn.flags.writeable = False
    return shift, turn
