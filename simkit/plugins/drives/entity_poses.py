"""Poses of models, links and visuals, each in its own frame: a tick samples little, and the poses are computed
later.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from simkit import msgs
from simkit.plugins.drives.odometry import message_types
from simkit.pose import Pose, Vector

if TYPE_CHECKING:
    from collections.abc import Iterable

    from simkit.runtime import Link, Model, Simulation
    from simkit.scene import SceneJoint

PoseNumbers = tuple[float, float, float, float, float, float, float]
"""A pose as plain numbers, x, y, z [m] and a unit quaternion w, x, y, z: sooner multiplied than a `Pose`."""

FramePose = tuple[str, str, PoseNumbers]
"""Frame, child frame, and where the child is in the frame."""

_IDENTITY: PoseNumbers = (0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class PosedEntity:
    """One entity whose pose is told.

    Attributes:
        frame: scoped name of what it is in; the world's name for a top-level model.
        child: its own scoped name.
        place: where it always is in that frame; None where it may move.
        handle: the link or model that it is, where it may move.
        within: the model or link that it is in; None in the world.
        moves: whether gz tells it on the topic of moving things where there is another for those at rest.
    """

    frame: str
    child: str
    place: Pose | None = None
    handle: Link | Model | None = None
    within: Link | Model | None = None
    moves: bool = False

    def __deepcopy__(self, memo: dict[int, object]) -> PosedEntity:
        return self


class _CompiledEntity(NamedTuple):
    """A part in the compiled model.

    Attributes:
        frame, child: as the part has them.
        place: where it is in its frame, where that never changes.
        row, offset: its body among those taken, and its frame in that body's.
        base, back: the body of what it is in (-1 for the world), and that body's frame in its own.
        is_body, is_base: whether its frame, and that of what it is in, are those of their bodies.
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


class EntityPoses:
    """The poses of some parts, for one compiled model.

    Args:
        sim: the simulation.
        parts: what is told, in this order.
    """

    def __init__(self, sim: Simulation, parts: Sequence[PosedEntity]) -> None:
        self._sim = sim
        self._rows: dict[int, int] = {}
        # as plain tuples, which are soonest gone through
        self._plan = [self._find(part) for part in parts]
        self._bodies = np.array(list(self._rows), dtype=np.intp)

    def take(self) -> PoseSample:
        """What the poses of this tick are made of."""
        data = self._sim.engine.physics.fresh()
        return PoseSample(self, data.xpos[self._bodies], data.xquat[self._bodies])

    def place(self, positions: Vector, quaternions: Vector) -> list[FramePose]:
        """The poses when the bodies are here: [m] and (w, x, y, z) in the world, shapes (n, 3) and (n, 4)."""
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
            # times one is the same again, unless it is a zero whose sign may turn
            if not is_body or 0.0 in pose:
                pose = _compose_poses(pose, offset)
            if base >= 0:
                there = backs[base]
                if there is None:
                    there = _invert_pose(world[base])
                    if not is_base or 0.0 in there:
                        there = _compose_poses(back, there)
                    backs[base] = there
                pose = _compose_poses(there, pose)
            placed.append((frame, child, pose))
        return placed

    def __deepcopy__(self, memo: dict[int, object]) -> EntityPoses:
        return self

    # ------------------------------------------------------------------ inside

    def _find(self, part: PosedEntity) -> _CompiledEntity:
        if part.place is not None:
            return _CompiledEntity(part.frame, part.child, pose_numbers(part.place))
        assert part.handle is not None
        body, offset = self._spot(part.handle)
        if part.within is None:
            place = pose_numbers(offset)
            if body == 0:
                return _CompiledEntity(part.frame, part.child, place)
            return _CompiledEntity(part.frame, part.child, None, self._row(body), place, is_body=place == _IDENTITY)
        base, its_offset = self._spot(part.within)
        if body == base:
            return _CompiledEntity(part.frame, part.child, pose_numbers(its_offset.inverse() @ offset))
        weld = self._sim.mj_model.body_weldid
        if weld[body] == weld[base] != 0:  # no joint between them: they are as they were loaded for ever
            place = pose_numbers(part.within.scene.pose_world.inverse() @ part.handle.scene.pose_world)
            return _CompiledEntity(part.frame, part.child, place)
        back = pose_numbers(its_offset.inverse())
        own, rows = pose_numbers(offset), (self._row(body), self._row(base))
        are_bodies = own == _IDENTITY, back == _IDENTITY
        return _CompiledEntity(part.frame, part.child, None, rows[0], own, rows[1], back, *are_bodies)

    def _spot(self, handle: Any) -> tuple[int, Pose]:
        """The body that carries a link or a model, and its frame in that of the body."""
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
    """Where the bodies were at a tick, of which the poses are made once somebody looks at them."""

    __slots__ = ("_placed", "_poses", "_positions", "_quaternions")

    def __init__(self, poses: EntityPoses, positions: Vector, quaternions: Vector) -> None:
        self._poses, self._positions, self._quaternions = poses, positions, quaternions
        self._placed: list[FramePose] | None = None

    @property
    def placed(self) -> list[FramePose]:
        """The poses, in the order of the parts."""
        placed = self._placed
        if placed is None:
            placed = self._placed = self._poses.place(self._positions, self._quaternions)
        return placed


def transforms_message(time_ns: int, taken: PoseSample, others: Sequence[FramePose] = ()) -> msgs.TFMessage:
    """A `tf2_msgs/msg/TFMessage` of all parts, and others after them."""
    types = message_types()
    message, transform = types["TransformStamped"], types["Transform"]
    vector, quaternion = types["Vector3"], types["Quaternion"]
    header = msgs.headers(time_ns)
    made = [
        message(header(frame), child, transform(vector(x, y, z), quaternion(i, j, k, w)))
        for frame, child, (x, y, z, w, i, j, k) in (*taken.placed, *others)
    ]
    transforms: msgs.TFMessage = types["TFMessage"](made)
    return transforms


def stamped_transform(time_ns: int, frame: str, child: str, seven: PoseNumbers) -> msgs.TransformStamped:
    """A `geometry_msgs/msg/TransformStamped` of one part."""
    types = message_types()
    x, y, z, w, i, j, k = seven
    place = types["Transform"](types["Vector3"](x, y, z), types["Quaternion"](i, j, k, w))
    stamped: msgs.TransformStamped = types["TransformStamped"](msgs.header(time_ns, frame), child, place)
    return stamped


def links_moved_by_joints(joints: Iterable[SceneJoint]) -> frozenset[str]:
    """Scoped names of the links at either end of a joint that is not fixed."""
    return frozenset(end for joint in joints if joint.type != "fixed" for end in (joint.parent_link, joint.child_link))


def pose_numbers(pose: Pose) -> PoseNumbers:
    """A pose as plain numbers."""
    x, y, z = pose.position.tolist()
    w, i, j, k = pose.quaternion.tolist()
    return x, y, z, w, i, j, k


def _compose_poses(a: PoseNumbers, b: PoseNumbers) -> PoseNumbers:
    """Where something is in the outer frame that is at `b` in the frame at `a`."""
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
