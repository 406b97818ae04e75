"""Rigid motions between two worlds: a moved robot is reported once, not once for each of its links."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from simkit.float_sum import float_sum
from simkit.linear_algebra import norm
from simkit.pose import Pose, Vector
from simkit.testing.golden.cause.first_tick import distinct_digits
from simkit.testing.golden.compare.world_edits import Edit, entity_kind, parent_path, scoped_name, split_entity_path

_LOCAL_FIELDS = {"pose_world": "pose_link", "xyz_world": "xyz_joint", "direction_world": "direction"}
"""Value in the world frame -> value in the file. A motion of the owner changes only the value in the world frame."""
_CLOSE = 1e-9  # tolerance for equal motions [m and rad], per metre from the origin
_FARTHEST = 1e15  # [m]
_STRAIGHT = 1e-6
_SMALL = 0.1  # [m]; smaller lengths are written in millimetres


@dataclass
class Motion:
    """Entity that was moved.

    Attributes:
        owner: Path of the entity.
        words: Description of the motion.
        numbers: Coordinates that differ, as in a file; may be empty.
        along: Description of other entities that moved with this one; may be empty.
        edits: All values that differ because of the motion; those of the entity itself are first.
    """

    owner: str
    words: str
    numbers: str
    edits: list[Edit] = field(default_factory=list)
    along: str = ""

    @property
    def where(self) -> str:
        """Source position of the entity, `file:line`; empty if unknown."""
        return next((e.where for e in self.edits if e.where), "")


def find_motions(
    edits: list[Edit], golden: Mapping[str, object], run: Mapping[str, object]
) -> tuple[list[Motion], list[Edit]]:
    """Return the motions and the remaining edits.

    Args:
        edits: Values that differ.
        golden: All values of the golden world.
        run: All values of the new world.
    """
    poses = [e for e in edits if e.attribute in ("pose_world", "pose_link") and _is_pose(e.golden) and _is_pose(e.run)]
    # values that are computed from a local value of the entity and the pose of its owner
    derived = [e for e in edits if local_path(e.path) in run]
    rest = [e for e in edits if e not in derived and e not in poses]
    in_world = {e.owner: e for e in poses if e.attribute == "pose_world" and f"{e.owner}.pose_link" not in run}
    # motion of the world frame that moves the entity in the same way
    deltas = {owner: _pose(edit.run) @ _pose(edit.golden).inverse() for owner, edit in in_world.items()}
    carriers = _carrying_entities(run, set(in_world))
    motions: dict[str, Motion] = {}
    roots = {owner: _root_motion(owner, deltas, carriers) for owner in in_world}
    for owner, edit in in_world.items():
        if roots[owner] == owner:
            words, numbers = _simplest_motion(edit, owner, golden, run, carriers)
            motions[owner] = Motion(owner, words, numbers, [edit])
    for owner, edit in in_world.items():
        if roots[owner] != owner:
            motions[roots[owner]].edits.append(edit)
    for edit in poses:
        if edit.attribute == "pose_link":
            words, numbers = _motion_text(_pose(edit.golden), _pose(edit.run))
            motions[edit.owner] = Motion(edit.owner, words, numbers, [edit])
    posed = {e.owner for e in poses}
    for edit in derived:
        home = _owner_motion(edit.owner, motions, roots)
        if home is not None:
            motions[home].edits.append(edit)
        elif edit.owner not in posed:
            rest.append(edit)
    for motion in motions.values():
        motion.along = _count_carried(motion)
    return list(motions.values()), rest


def _is_pose(value: object) -> bool:
    """Check whether a value is a position and a quaternion; a golden run may come from an untrusted source."""
    if not isinstance(value, list) or len(value) != 7:
        return False
    if not all(isinstance(v, (int, float)) and abs(v) < _FARTHEST for v in value):
        return False
    return bool(float_sum(v * v for v in value[3:]) > _CLOSE)


def local_path(path: str) -> str:
    """Return the path of the local value that belongs to a value in world axes; empty if there is none."""
    beginning, dot, last = path.rpartition(".")
    return f"{beginning}{dot}{_LOCAL_FIELDS[last]}" if last in _LOCAL_FIELDS else ""


def _owner_motion(owner: str, found: Mapping[str, Motion], roots: Mapping[str, str]) -> str | None:
    """Return the path of the entity whose motion moved `owner`; None if `owner` was not moved."""
    while True:
        if owner in found:
            return owner
        if owner in roots:
            return roots[owner]
        if not owner:
            return None
        owner = parent_path(owner)


def _pose(numbers: Any) -> Pose:
    return Pose(numbers[:3], numbers[3:])


def _carrying_entities(run: Mapping[str, object], moved: set[str]) -> dict[str, list[str]]:
    """Return the entities that carry each moved entity, the nearest one last.

    A model carries its links, the parent link of a joint carries the child link, and the child link carries the joint.
    """
    owners = [split_entity_path(path)[0] for path in run if split_entity_path(path)[1] == "pose_world"]
    links = {scoped_name(owner): owner for owner in owners if entity_kind(owner) == "link"}
    carriers: dict[str, list[str]] = {owner: [parent_path(owner)] for owner in moved}
    for path, child in run.items():
        owner, attribute = split_entity_path(path)
        if attribute != "child_link" or not isinstance(child, str):
            continue
        parent = run.get(f"{owner}.parent_link", "")
        if owner in carriers and child in links:
            carriers[owner].append(links[child])
        if links.get(child, "") in carriers and isinstance(parent, str) and parent in links:
            carriers[links[child]].append(links[parent])
    return carriers


def _root_motion(owner: str, deltas: Mapping[str, Pose], carriers: Mapping[str, list[str]]) -> str:
    """Return the outermost entity that carries `owner` and has the same motion; `owner` if there is none."""
    seen = {owner}
    at = owner
    while True:
        known = [c for c in carriers.get(at, ()) if c in deltas and c not in seen]
        further = [c for c in known if _is_same_motion(deltas[c], deltas[owner])]
        if not further:
            return at
        at = further[0]
        seen.add(at)


def _is_same_motion(a: Pose, b: Pose) -> bool:
    far = 1.0 + max(np.abs(a.position).max(), np.abs(b.position).max())
    turned = min(np.abs(a.quaternion - b.quaternion).max(), np.abs(a.quaternion + b.quaternion).max())
    return bool(np.abs(a.position - b.position).max() < _CLOSE * far * 10 and turned < _CLOSE)


def _simplest_motion(
    edit: Edit, owner: str, golden: Mapping[str, object], run: Mapping[str, object], carriers: Mapping[str, list[str]]
) -> tuple[str, str]:
    """Describe a motion in the frame with the shortest text: the owner's, the carrying link's, or the world's."""
    frames = [parent_path(owner), *reversed(carriers.get(owner, [])), ""]
    candidates = []
    for frame in dict.fromkeys(frames):
        a, b = golden.get(f"{frame}.pose_world"), run.get(f"{frame}.pose_world")
        base_a, base_b = (_pose(a), _pose(b)) if _is_pose(a) and _is_pose(b) else (Pose(), Pose())
        words, numbers = _motion_text(base_a.inverse() @ _pose(edit.golden), base_b.inverse() @ _pose(edit.run))
        candidates.append((words.count(" along ") + words.count("("), len(words), words, numbers))
    return min(candidates, key=lambda t: t[:1])[2:]


def _motion_text(golden: Pose, run: Pose) -> tuple[str, str]:
    """Describe the change of a pose and the coordinates that differ."""
    moved = run.position - golden.position
    turn = (run @ golden.inverse()).quaternion
    words, numbers = [], []
    distance = norm(moved)
    if distance > _CLOSE * (1 + float(np.abs(golden.position).max())):
        words.append(f"moved {_length(distance)} along {_axis(moved / distance)}")
        numbers += [
            f"{name} {distinct_digits(a, b)}"
            for name, a, b in zip("xyz", golden.position, run.position, strict=True)
            if abs(b - a) > 1e-3 * distance
        ]
    sine = norm(turn[1:])
    angle = 2 * math.atan2(sine, abs(float(turn[0])))
    if angle > _CLOSE:
        axis = turn[1:] / sine * (1.0 if turn[0] >= 0 else -1.0)
        words.append(f"rotated {math.degrees(angle):.4g}° about {_rotation_axis(axis, golden)}")
        names = ("roll", "pitch", "yaw")
        numbers += [
            f"{n} {distinct_digits(float(a), float(b))}"
            for n, a, b in zip(names, golden.rpy, run.rpy, strict=True)
            if abs(b - a) > 1e-3 * angle
        ]
    if not words:
        return "moved by a rounding error", ""
    return " and ".join(words), f" ({', '.join(numbers)})" if numbers else ""


def _length(metres: float) -> str:
    if metres >= _SMALL:
        return f"{metres:.4g} m"
    return f"{metres * 1e3:.4g} mm" if metres >= 1e-6 else f"{metres:.2g} m"


def _axis(direction: Vector) -> str:
    """Return the letter of an axis, or its components."""
    letter = _letter(direction)
    return letter or "(" + ", ".join(f"{v:.3g}" if abs(v) > _STRAIGHT else "0" for v in direction) + ")"


def _letter(direction: Vector) -> str:
    largest = int(np.argmax(np.abs(direction)))
    if abs(abs(direction[largest]) - 1.0) < _STRAIGHT:
        return ("-" if direction[largest] < 0 else "") + "xyz"[largest]
    return ""


def _rotation_axis(axis: Vector, golden: Pose) -> str:
    """Describe a rotation axis: an axis of the frame, an axis of the entity, or components."""
    local_axis = golden.inverse().rotate(axis)
    return f"its own {_letter(local_axis)}" if not _letter(axis) and _letter(local_axis) else _axis(axis)


def _count_carried(motion: Motion) -> str:
    """Describe the number of other links and models that moved with this entity."""
    owners = {e.owner for e in motion.edits} - {motion.owner}
    links = [o for o in owners if entity_kind(o) in ("link", "model") and not o.startswith(motion.owner + ".")]
    return f", with {len(links)} more on it" if links else ""
