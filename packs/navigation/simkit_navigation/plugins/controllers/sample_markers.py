"""Markers of the trajectories of a controller, as Nav2's MPPI controller publishes them."""

from __future__ import annotations

from typing import Any

from simkit_navigation.plugins.navigation.planar_pose import Floats

_SPHERE, _ADD = 2, 0  # of visualization_msgs/msg/Marker


def trajectory_markers(points: Floats, steps: int, best: Floats) -> list[dict[str, Any]]:
    """Return the fields of markers without their headers; sizes and colours are those of Nav2's visualiser.

    Args:
        points: points of the samples, one trajectory after the other, shape (n, 2) [m].
        steps: number of points of each trajectory.
        best: poses of the chosen trajectory, shape (m, 3).
    """
    markers = []
    for index, (x, y) in enumerate(points.tolist()):
        part = index % steps / steps
        markers.append(_marker("Candidate Trajectories", index, (x, y, 0.03), (0.03, 0.03), (part, 1.0 - part)))
    for index, (x, y, _) in enumerate(best.tolist()):
        part, is_last = index / len(best), index == len(best) - 1
        size = (0.07, 0.09) if is_last else (0.03, 0.07)
        markers.append(_marker("Optimal Trajectory", len(points) + index, (x, y, 0.06), size, (part, part)))
    return markers


def _marker(
    space: str, number: int, place: tuple[float, float, float], size: tuple[float, float], colour: tuple[float, float]
) -> dict[str, Any]:
    x, y, z = place
    return {
        "ns": space,
        "id": number,
        "type": _SPHERE,
        "action": _ADD,
        "pose": {"position": {"x": x, "y": y, "z": z}, "orientation": {"w": 1.0}},
        "scale": {"x": size[0], "y": size[0], "z": size[1]},
        "color": {"r": 0.0, "g": colour[0], "b": colour[1], "a": 1.0},
    }
