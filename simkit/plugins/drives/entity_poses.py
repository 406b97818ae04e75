"""Poses of models, links and visuals, each relative to its own frame.

A tick only copies the poses of MuJoCo's bodies; the relative poses are computed when a message is made.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from simkit import msgs
from simkit.plugins.drives.odometry_messages import message_types
from simkit.plugins.not_deep_copied import SharedByCopies
from simkit.pose import Pose, Vector

if TYPE_CHECKING:
    from collections.abc import Iterable

    from simkit.runtime import Link, Model, Simulation
    from simkit.scene import SceneJoint

PoseNumbers = tuple[float, float, float, float, float, float, float]
"""Pose as plain numbers: x, y, z [m] and a unit quaternion w, x, y, z. Multiplication is faster than with `Pose`."""

FramePose = tuple[str, str, PoseNumbers]
"""Frame, child frame, and pose of the child in the frame."""

_IDENTITY: PoseNumbers = (0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class PosedEntity(SharedByCopies):
    """Link, model or visual whose pose is published.

    Attributes:
        frame: Scoped name of the parent; the world's name for a top-level model.
        child: Scoped name of the entity.
        place: Constant pose in the parent; None if the entity can move.
        handle: Link or model of the entity; None if it cannot move.
        within: Model or link that contains the entity; None for the world.
        moves: True if Gazebo publishes this pose on the topic of moving entities, in a setup where static entities have
            a separate topic.
    """

    frame: str
    child: str
    place: Pose | None = None
    handle: Link | Model | None = None
    within: Link | Model | None = None
    moves: bool = False


class _CompiledEntity(NamedTuple):
    """Entity with its addresses in the compiled model.

    Attributes:
        frame, child: Names from the `PosedEntity`.
        place: Constant pose of the entity in `frame`; None if the entity can move.
        row: Index of the entity's body among the sampled bodies.
        offset: Pose of the entity in the frame of its body.
        base: Index of the parent's body among the sampled bodies; -1 for the world.
        back: Pose of the parent's body in the parent's frame.
        is_body: True if the entity's frame equals the frame of its body.
        is_base: True if the parent's frame equals the frame of its body.
    """

    frame: str
    child: str
    place: PoseNumbers | None = None
    row: int = -1
    offset: PoseNumbers = _IDENTITY
    base: int = -1
    back: PoseNumbers = _IDENTITY
    is_body: bool = False
    is_base: bool = False


class EntityPoses(SharedByCopies):
    """Poses of a sequence of entities, prepared for one compiled model.

    Args:
        sim: Simulation that contains the entities.
        entities: Entities in the order of the output.
    """

    def __init__(self, sim: Simulation, entities: Sequence[PosedEntity]) -> None:
        self._sim = sim
        self._rows: dict[int, int] = {}
        # tuples, because `place` unpacks one for each entity and message
        self._plan = [self._find(entity) for entity in entities]
        self._bodies = np.array(list(self._rows), dtype=np.intp)

    def take(self) -> PoseSample:
        """Copy the body poses of this tick, from which the entity poses are computed later."""
        data = self._sim.engine.physics.fresh()
        return PoseSample(self, data.xpos[self._bodies], data.xquat[self._bodies])

    def place(self, positions: Vector, quaternions: Vector) -> list[FramePose]:
        """Compute the poses of all entities from given body poses.

        Args:
            positions: World positions of the sampled bodies [m], shape (n, 3).
            quaternions: World orientations of these bodies (w, x, y, z), shape (n, 4).

        Returns:
            The frame, child and pose of each entity, in the order of the entities.
        """
        world: list[PoseNumbers] = [
            (x, y, z, w, i, j, k)
            for (x, y, z), (w, i, j, k) in zip(positions.tolist(), quaternions.tolist(), strict=True)
        ]
        backs: list[PoseNumbers | None] = [None] * len(world)
        placed: list[FramePose] = []
        for frame, child, fixed, row, offset, base, back, is_body, is_base in self._plan:
            if fixed is not None:
                placed.append((frame, child, fixed))
                continue
            pose = world[row]
            # multiplication by the identity changes nothing but the sign of a zero
            if not is_body or 0.0 in pose:
                pose = _compose_poses(pose, offset)
            if base >= 0:
                inverse_base = backs[base]
                if inverse_base is None:
                    inverse_base = _invert_pose(world[base])
                    if not is_base or 0.0 in inverse_base:
                        inverse_base = _compose_poses(back, inverse_base)
                    backs[base] = inverse_base
                pose = _compose_poses(inverse_base, pose)
            placed.append((frame, child, pose))
        return placed

    # ------------------------------------------------------------------ inside

    def _find(self, entity: PosedEntity) -> _CompiledEntity:
        if entity.place is not None:
            return _CompiledEntity(entity.frame, entity.child, pose_numbers(entity.place))
        assert entity.handle is not None
        body, offset = self._body_and_offset(entity.handle)
        if entity.within is None:
            place = pose_numbers(offset)
            if body == 0:
                return _CompiledEntity(entity.frame, entity.child, place)
            return _CompiledEntity(entity.frame, entity.child, None, self._row(body), place, is_body=place == _IDENTITY)
        base, its_offset = self._body_and_offset(entity.within)
        if body == base:
            return _CompiledEntity(entity.frame, entity.child, pose_numbers(its_offset.inverse() @ offset))
        weld = self._sim.mj_model.body_weldid
        if weld[body] == weld[base] != 0:  # no joint between both bodies: the loaded pose is constant
            place = pose_numbers(entity.within.scene.pose_world.inverse() @ entity.handle.scene.pose_world)
            return _CompiledEntity(entity.frame, entity.child, place)
        back = pose_numbers(its_offset.inverse())
        entity_offset, rows = pose_numbers(offset), (self._row(body), self._row(base))
        are_bodies = entity_offset == _IDENTITY, back == _IDENTITY
        return _CompiledEntity(entity.frame, entity.child, None, rows[0], entity_offset, rows[1], back, *are_bodies)

    def _body_and_offset(self, handle: Any) -> tuple[int, Pose]:
        """Return MuJoCo's body of a link or model, and the pose of the link or model in the body's frame."""
        names, scene = self._sim.engine.names, handle.scene
        if handle.scoped in names.links:
            binding = names.link(handle.scoped)
            return int(binding.body), binding.offset
        if not scene.canonical_link:
            return 0, handle.pose
        binding = names.link(scene.canonical_link)
        return int(binding.body), binding.offset @ (binding.scene.pose_world.inverse() @ scene.pose_world)

    def _row(self, body: int) -> int:
        return self._rows.setdefault(body, len(self._rows))


class PoseSample:
    """Body poses of one tick. The entity poses are computed on first access, so unread messages cost little."""

    __slots__ = ("_placed", "_poses", "_positions", "_quaternions")

    def __init__(self, poses: EntityPoses, positions: Vector, quaternions: Vector) -> None:
        self._poses, self._positions, self._quaternions = poses, positions, quaternions
        self._placed: list[FramePose] | None = None

    @property
    def placed(self) -> list[FramePose]:
        """Frame, child and pose of each entity, in the order of the entities."""
        placed = self._placed
        if placed is None:
            placed = self._placed = self._poses.place(self._positions, self._quaternions)
        return placed


def transforms_message(time_ns: int, sample: PoseSample, others: Sequence[FramePose] = ()) -> msgs.TFMessage:
    """Return a `tf2_msgs/msg/TFMessage` of all sampled entities, followed by other transforms.

    Args:
        time_ns: Time of the message [ns].
        sample: Poses to convert.
        others: Further transforms.
    """
    types = message_types()
    message, transform = types["TransformStamped"], types["Transform"]
    vector, quaternion = types["Vector3"], types["Quaternion"]
    header = msgs.headers(time_ns)
    made = [
        message(header(frame), child, transform(vector(x, y, z), quaternion(i, j, k, w)))
        for frame, child, (x, y, z, w, i, j, k) in (*sample.placed, *others)
    ]
    transforms: msgs.TFMessage = types["TFMessage"](made)
    return transforms


def stamped_transform(time_ns: int, frame: str, child: str, pose: PoseNumbers) -> msgs.TransformStamped:
    """Return a `geometry_msgs/msg/TransformStamped` of one entity.

    Args:
        time_ns: Time of the message [ns].
        frame: Parent frame.
        child: Child frame.
        pose: Pose of the child in the parent frame.
    """
    types = message_types()
    x, y, z, w, i, j, k = pose
    place = types["Transform"](types["Vector3"](x, y, z), types["Quaternion"](i, j, k, w))
    stamped: msgs.TransformStamped = types["TransformStamped"](msgs.header(time_ns, frame), child, place)
    return stamped


def links_moved_by_joints(joints: Iterable[SceneJoint]) -> frozenset[str]:
    """Return the scoped names of the links on both sides of every joint that is not fixed."""
    return frozenset(end for joint in joints if joint.type != "fixed" for end in (joint.parent_link, joint.child_link))


def pose_numbers(pose: Pose) -> PoseNumbers:
    """Convert a pose into plain numbers."""
    x, y, z = pose.position.tolist()
    w, i, j, k = pose.quaternion.tolist()
    return x, y, z, w, i, j, k


def _compose_poses(a: PoseNumbers, b: PoseNumbers) -> PoseNumbers:
    """Return the product of two poses, a · b."""
    ax, ay, az, aw, ai, aj, ak = a
    x, y, z, w, i, j, k = b
    tx, ty, tz = 2 * (aj * z - ak * y), 2 * (ak * x - ai * z), 2 * (ai * y - aj * x)
    return (
        ax + x + aw * tx + aj * tz - ak * ty,
        ay + y + aw * ty + ak * tx - ai * tz,
        az + z + aw * tz + ai * ty - aj * tx,
        aw * w - ai * i - aj * j - ak * k,
        aw * i + ai * w + aj * k - ak * j,
        aw * j - ai * k + aj * w + ak * i,
        aw * k + ai * j - aj * i + ak * w,
    )


def _invert_pose(pose: PoseNumbers) -> PoseNumbers:
    x, y, z, w, i, j, k = pose
    i, j, k = -i, -j, -k
    tx, ty, tz = 2 * (j * z - k * y), 2 * (k * x - i * z), 2 * (i * y - j * x)
    x, y, z = (
        0.0 + x + w * tx + j * tz - k * ty,
        0.0 + y + w * ty + k * tx - i * tz,
        0.0 + z + w * tz + i * ty - j * tx,
    )
    return -x, -y, -z, w, i, j, k
