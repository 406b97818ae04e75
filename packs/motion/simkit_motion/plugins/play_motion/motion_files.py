"""Motion files: YAML in the layout of play_motion2 (ROS 2) or of play_motion (ROS 1).

Both layouts have a block `motions` below the name of a node. In ROS 2, a motion has `joints`, `positions` (of all
points, concatenated) and `times_from_start`. In ROS 1, a motion has `joints` and `points`; each point has `positions`,
`time_from_start` and optionally `velocities`. A file may mix both layouts: the keys of a motion decide its layout.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import lru_cache
from pathlib import Path
from typing import Final

from simkit import Diagnostic
from simkit.extend import Diagnostics, Where, counted, did_you_mean
from simkit.plugins.ros_parameter_files import Entry, ParameterFile, read_parameter_file
from simkit_motion.plugins.play_motion.motion import LARGEST_NUMBER, Motion, motion_fault, point_rows

_KEYS: Final = ("joints", "positions", "times_from_start", "points", "meta")
_POINT_KEYS: Final = ("positions", "velocities", "time_from_start")
_META_KEYS: Final = ("name", "usage", "description")
_PLANNERS: Final = ("motion_planner", "approach_planner")
_SPEEDS: Final = ("approach_velocity", "skip_planning_approach_vel", "approach_vel")
_SHORTEST: Final = ("approach_min_duration",)
_EXCLUDED: Final = ("exclude_from_planning_joints",)
_SETTINGS: Final = (*_SPEEDS, *_SHORTEST, *_EXCLUDED)


@dataclass(slots=True)
class MotionFile:
    """Contents of a motion file.

    Attributes:
        motions: Motions by key, in the order of the file.
        approach_velocity: Speed of the fastest joint during the approach to the first point [rad/s or m/s].
        approach_min_duration: Shortest duration of the approach [s].
        excluded_joints: Joints that may touch objects, such as gripper joints.

    The last three are None if the file does not set them.
    """

    motions: dict[str, Motion] = field(default_factory=dict)
    approach_velocity: float | None = None
    approach_min_duration: float | None = None
    excluded_joints: tuple[str, ...] | None = None

    def update(self, other: MotionFile) -> None:
        """Add the contents of another file; its motions and settings replace those with the same key."""
        self.motions.update(other.motions)
        for name in ("approach_velocity", "approach_min_duration", "excluded_joints"):
            if getattr(other, name) is not None:
                setattr(self, name, getattr(other, name))


def read_motions(path: Path, diagnostics: Diagnostics) -> MotionFile:
    """Read a motion file; an invalid motion is reported as a warning and left out.

    Args:
        path: File to read.
        diagnostics: Collector of the warnings and errors.
    """
    stamp: tuple[int, ...] = ()
    with suppress(OSError):  # `read_parameter_file` reports a missing file
        stat = path.stat()
        stamp = (stat.st_dev, stat.st_ino, stat.st_mtime_ns, stat.st_size)
    file, reports = _read_cached(path, stamp)
    diagnostics.extend(reports)
    return replace(file, motions=dict(file.motions))


@lru_cache(maxsize=32)  # reading takes 10 ms, and a process may load a world many times
def _read_cached(path: Path, _stamp: tuple[int, ...]) -> tuple[MotionFile, tuple[Diagnostic, ...]]:
    """Return the contents and the diagnostics of a file. A changed file has another `_stamp`, so it is read again."""
    motion_file, reports = MotionFile(), Diagnostics()
    file = read_parameter_file(path, reports)
    if file is None:
        return motion_file, tuple(reports)
    # the warning about an empty file mentions controllers, so it is replaced by a warning about motions
    reports.drop([d for d in reports if d.code == "SK-CONTROL-003"])
    for block in _motion_blocks(file):
        for name, entry in (block.below or {}).items():
            if name == "motions":
                _read_motions(entry, motion_file, reports)
            elif name in _PLANNERS:
                _read_planner(entry, motion_file, reports)
            elif name in _SETTINGS:
                _read_planner(Entry(block.where, below={name: entry}), motion_file, reports)
            elif near := did_you_mean(name, ("motions", *_PLANNERS, *_SETTINGS)):
                reports.warning("SK-MOTION-006", f"{name!r} is not used", entry.where, near)
    if not motion_file.motions and not reports.has_errors:
        hint = "add a block `motions` below the name of a node"
        reports.warning("SK-MOTION-003", f"{path.name} has no valid motion", Where(str(path)), hint)
    return motion_file, tuple(reports)


def _motion_blocks(file: ParameterFile) -> Iterator[Entry]:
    """Yield every block that may contain motions: each node (ROS 2), and each block with a key `motions` (ROS 1)."""
    for _, entry in file.nodes:
        yield entry
    if file.root is not None:
        yield from _blocks_with_motions(file.root)


def _blocks_with_motions(entry: Entry) -> Iterator[Entry]:
    below = entry.below or {}
    if any(name in below for name in ("motions", *_PLANNERS)):
        yield entry
        return
    for inner in below.values():
        yield from _blocks_with_motions(inner)


def _read_motions(entry: Entry, found: MotionFile, diagnostics: Diagnostics) -> None:
    for key, inner in (entry.below or {}).items():
        try:
            found.motions[key] = _motion(key, inner, diagnostics)
        except ValueError as error:
            diagnostics.warning("SK-MOTION-002", f"motion {key!r} is left out: {error}", inner.where)


def _motion(key: str, entry: Entry, diagnostics: Diagnostics) -> Motion:
    """Read one motion in either layout.

    Raises:
        ValueError: The entry is not a valid motion; the error text states the reason.
    """
    below = entry.below
    if below is None:
        raise ValueError(f"found {entry.text!r}; expected a block with {', '.join(_KEYS[:3])}")
    if not key.strip() or not key.isprintable():
        raise ValueError("its key is empty or not printable")
    _report_unknown(f"motion {key!r}", below, _KEYS, diagnostics)
    joints = [item.text for item in _list_items(below, "joints")]
    if any(not joint for joint in joints):
        raise ValueError("an item of 'joints' is not a joint name")
    if "points" in below:
        times, flat, velocities = _points(key, below["points"], len(joints), diagnostics)
        for name in ("positions", "times_from_start"):
            if name in below:
                message = f"motion {key!r}: {name!r} is not used together with 'points'"
                diagnostics.warning("SK-MOTION-006", message, below[name].where)
    else:
        flat, times, velocities = _numbers(below, "positions"), _numbers(below, "times_from_start"), ()
    fault = motion_fault(joints, flat, times, [v for row in velocities for v in row])
    if fault:
        raise ValueError(fault)
    meta = _meta(key, below, diagnostics)
    _report_unknown(f"motion {key!r}, 'meta'", meta, _META_KEYS, diagnostics)
    texts = {name: " ".join(meta[name].text.split()) for name in _META_KEYS if name in meta}
    return Motion(
        key, tuple(joints), tuple(times), point_rows(flat, len(joints)), velocities, where=entry.where, **texts
    )


def _meta(key: str, below: dict[str, Entry], diagnostics: Diagnostics) -> dict[str, Entry]:
    """Return the entries of a motion's `meta` block."""
    entry = below.get("meta")
    if entry is None:
        return {}
    if entry.below is None and (entry.text or entry.items):
        message = f"motion {key!r}: 'meta' is not used; expected a block with {', '.join(_META_KEYS)}"
        diagnostics.warning("SK-MOTION-006", message, entry.where)
    return entry.below or {}


def _points(
    key: str, entry: Entry, width: int, diagnostics: Diagnostics
) -> tuple[list[float], list[float], tuple[tuple[float, ...], ...]]:
    """Return the times, the concatenated positions and the velocities of a motion's points in ROS 1's layout."""
    times: list[float] = []
    flat: list[float] = []
    velocities: list[tuple[float, ...]] = []
    for k, item in enumerate(entry.items or ()):
        point = item.below
        if point is None:
            raise ValueError(f"point {k} is {item.text!r}; expected a block with positions and time_from_start")
        _report_unknown(f"motion {key!r}, point {k}", point, _POINT_KEYS, diagnostics)
        positions = _numbers(point, "positions", f"point {k}")
        if len(positions) != width:
            raise ValueError(f"point {k} has {counted(len(positions), 'position')} for {width} joints")
        if "time_from_start" not in point:
            raise ValueError(f"point {k} needs 'time_from_start'")
        times.append(_number(point["time_from_start"], "time_from_start"))
        flat += positions
        if "velocities" in point:
            row = tuple(_numbers(point, "velocities", f"point {k}"))
            if len(row) != width:
                raise ValueError(f"point {k} has {counted(len(row), 'velocity', 'velocities')} for {width} joints")
            velocities.append(row)
    if velocities and len(velocities) != len(times):
        raise ValueError(f"{len(velocities)} of {len(times)} points have velocities; expected all or none")
    return times, flat, tuple(velocities)


def _read_planner(entry: Entry, found: MotionFile, diagnostics: Diagnostics) -> None:
    """Read the settings of the approach to the first point; simkit has no use for the other keys of the block."""
    for name, inner in (entry.below or {}).items():
        try:
            if name in _SPEEDS:
                found.approach_velocity = _bounded_number(inner, name, 0.0, strictly=True)
            elif name in _SHORTEST:
                found.approach_min_duration = _bounded_number(inner, name, 0.0, strictly=False)
            elif name in _EXCLUDED:
                found.excluded_joints = _names(inner)
        except ValueError as error:
            diagnostics.warning("SK-MOTION-002", f"{name!r} is left out: {error}", inner.where)


def _bounded_number(entry: Entry, name: str, least: float, *, strictly: bool) -> float:
    value = _number(entry, name)
    smallest = max(least, 1 / LARGEST_NUMBER) if strictly else least  # the time of the approach stays finite
    if not smallest <= value <= LARGEST_NUMBER:
        raise ValueError(f"found {value:g}; expected a number {'above' if strictly else 'from'} {least:g}")
    return value


def _names(entry: Entry) -> tuple[str, ...]:
    if entry.below is not None or (entry.items is None and entry.text):
        raise ValueError(f"found {entry.text or 'a block'!r}; expected a list of joints")
    return tuple(item.text for item in entry.items or ())


def _list_items(below: dict[str, Entry], name: str) -> list[Entry]:
    entry = below.get(name)
    if entry is None:
        near = did_you_mean(name, below)
        raise ValueError(f"it needs {name!r}" + (f"; {near}" if near else ""))
    if entry.items is None:
        raise ValueError(f"{name!r} is not a list")
    return entry.items


def _numbers(below: dict[str, Entry], name: str, owner: str = "") -> list[float]:
    try:
        return [_number(item, name) for item in _list_items(below, name)]
    except ValueError as error:
        raise ValueError(f"{owner}: {error}" if owner else str(error)) from None


def _number(entry: Entry, name: str) -> float:
    if entry.items is not None or entry.below is not None:
        raise ValueError(f"{name!r} holds a list or block; expected numbers")
    try:
        return float(entry.text)
    except ValueError:
        raise ValueError(f"{name!r} holds {entry.text!r}; expected numbers") from None


def _report_unknown(owner: str, below: dict[str, Entry], allowed: tuple[str, ...], diagnostics: Diagnostics) -> None:
    for name, entry in below.items():
        if name not in allowed:
            hint = did_you_mean(name, allowed) or "there is " + ", ".join(allowed)
            diagnostics.warning("SK-MOTION-006", f"{owner}: {name!r} is not used", entry.where, hint)
