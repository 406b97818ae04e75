"""Tables of models and worlds in notebooks."""

from __future__ import annotations

import html
import math
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

from simkit.number_text import counted

if TYPE_CHECKING:
    from simkit.pose import Pose
    from simkit.runtime.handles.model import Model

_MOST_ROWS = 30


def model_html(model: Model) -> str:
    """Return a model as a line of text with its pose, and a table of its movable joints."""
    pose = _pose_text(model.pose) if model.is_present else "removed"
    title = f"<code>{html.escape(repr(model))}</code> {pose}, {_count(len(model.links), 'link')}"
    joints = {name: joint for name, joint in model.below("joints").items() if joint.dof} if model.is_present else {}
    rows = ([name, joint.type, _numbers(joint.position), _numbers(joint.velocity)] for name, joint in joints.items())
    return title + (
        _table(("joint", "type", "position [rad, m]", "velocity [rad/s, m/s]"), rows, len(joints)) if joints else ""
    )


def world_html(title: str, models: Mapping[str, Model]) -> str:
    """Return a world as a line of text and a table of its top-level models."""
    rows = (
        [name, "static" if model.static else _pose_text(model.pose), len(model.links), len(model.joints)]
        for name, model in models.items()
    )
    table = _table(("model", "pose", "links", "joints"), rows, len(models)) if models else ""
    return f"<code>{html.escape(title)}</code>{table}"


def _table(head: Sequence[str], rows: Iterable[Sequence[object]], count: int) -> str:
    lines = ["".join(f"<th>{name}</th>" for name in head)]
    for row, _ in zip(rows, range(_MOST_ROWS), strict=False):
        lines.append("".join(f"<td>{html.escape(str(value))}</td>" for value in row))
    more = f"… {count - _MOST_ROWS} more" if count > _MOST_ROWS else ""
    return f"<table>{''.join(f'<tr>{line}</tr>' for line in lines)}</table>{more}"


def _pose_text(pose: Pose) -> str:
    """Return a pose as a text: x, y, z [m] and yaw [°]."""
    x, y, z = (float(value) for value in pose.position)
    yaw = math.degrees(pose.rpy[2])
    return f"x {x:z.3f}, y {y:z.3f}, z {z:z.3f} m, yaw {yaw:z.1f}°"


def _numbers(value: float | Sequence[float]) -> str:
    values = [value] if isinstance(value, (int, float)) else value
    return ", ".join(f"{float(each):z.3f}" for each in values)


def _count(count: int, name: str) -> str:
    return counted(count, name)
