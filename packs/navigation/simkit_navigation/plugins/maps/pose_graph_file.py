"""Files of a pose graph: `NAME.posegraph` has poses and edges as JSON, `NAME.data` has the ranges of the scans.

slam_toolbox has two files with the same names, in a binary format of Boost that depends on its version and the
processor.
"""

from __future__ import annotations

import io
import json
import math
from pathlib import Path
from typing import Any, Final

import numpy as np

from simkit.input_file import open_input
from simkit_navigation.plugins.maps.pose_graph import Edge
from simkit_navigation.plugins.maps.scan_mapper import MapScan
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose

_FORMAT: Final = "simkit pose graph 1"
_BOOST: Final = b"serialization::archive"
_ENDINGS: Final = (".posegraph", ".data")


class PoseGraphFault(Exception):
    """A file of a pose graph cannot be read or written; the text says why."""


def write_pose_graph(name: str, scans: list[MapScan], edges: list[Edge]) -> Path:
    """Write both files of a pose graph, and return the first one.

    Raises:
        PoseGraphFault: the name is empty, or a file with the name is not of this format.
        OSError: a file cannot be written.
    """
    graph_file, data_file = _paths(name)
    for file in (graph_file, data_file):
        if file.exists() and not _is_own(file):
            raise PoseGraphFault(f"{file} exists and is not a pose graph of simkit; choose another name")
    graph = {
        "format": _FORMAT,
        "scans": [
            {
                "pose": list(scan.pose),
                "odometry": list(scan.odometry),
                "sensor": list(scan.sensor),
                "limit": scan.limit,
                "rays": len(scan.ranges),
            }
            for scan in scans
        ],
        "edges": [[edge.first, edge.second, list(edge.pose), list(edge.information), edge.is_loop] for edge in edges],
    }
    rays = [np.column_stack((scan.ranges, scan.angles)) for scan in scans]
    content = io.BytesIO()
    np.save(content, np.concatenate(rays) if rays else np.zeros((0, 2)), allow_pickle=False)
    data_file.write_bytes(content.getvalue())
    graph_file.write_text(json.dumps(graph) + "\n", "utf-8")
    return graph_file


def read_pose_graph(name: str) -> tuple[list[MapScan], list[Edge]]:
    """Return the scans and the edges of the files of a pose graph.

    Raises:
        PoseGraphFault: a file is missing, damaged, or of another program.
    """
    graph_file, data_file = _paths(name)
    try:
        with open_input(graph_file) as file:
            content = file.read()
        with open_input(data_file) as file:
            data = file.read()
    except OSError as error:
        raise PoseGraphFault(f"cannot read {error.filename or graph_file}: {error.strerror or error}") from error
    if _BOOST in content[:100]:
        raise PoseGraphFault(
            f"{graph_file} is a file of slam_toolbox in ROS, whose binary format is not read; "
            "make the map with simkit, or use the image that save_map wrote"
        )
    try:
        graph = json.loads(content)
        if graph["format"] != _FORMAT:
            raise PoseGraphFault(f"{graph_file}: format {graph['format']!r:.60} is not {_FORMAT!r}")
        rays = np.load(io.BytesIO(data), allow_pickle=False)
        return _scans(graph, rays), _edges(graph)
    except (ArithmeticError, ValueError, LookupError, TypeError, EOFError, MemoryError, RecursionError) as error:
        raise PoseGraphFault(
            f"{graph_file} or {data_file.name} is damaged, or is not a pose graph of simkit"
        ) from error


def _paths(name: str) -> tuple[Path, Path]:
    """Return the paths of both files; the name may have the ending of one of them."""
    path = Path(name).expanduser()
    if path.suffix in _ENDINGS:
        path = path.with_suffix("")
    if not name or "\0" in name or path.name in ("", ".."):
        raise PoseGraphFault(f"the name {name!r:.60} of a pose graph is not the name of a file")
    first, second = (path.absolute().with_name(path.name + ending) for ending in _ENDINGS)
    return first, second


def _is_own(file: Path) -> bool:
    """Return whether a file is one that `write_pose_graph` may replace."""
    with open_input(file) as stream:
        head = stream.read(64)
    return head.startswith((f'{{"format": "{_FORMAT}"'.encode(), b"\x93NUMPY"))


def _scans(graph: dict[str, Any], rays: Any) -> list[MapScan]:
    scans, first = [], 0
    for entry in graph["scans"]:
        last = first + int(entry["rays"])
        part = np.array(rays[first:last], np.float64)
        if last < first or part.shape != (last - first, 2) or not np.isfinite(part[:, 1]).all():
            raise ValueError("rays are missing or invalid")
        pose, odometry, sensor = (_pose(entry[key]) for key in ("pose", "odometry", "sensor"))
        scans.append(MapScan(part[:, 0].copy(), part[:, 1].copy(), float(entry["limit"]), sensor, odometry, pose))
        first = last
    return scans


def _edges(graph: dict[str, Any]) -> list[Edge]:
    edges, count = [], len(graph["scans"])
    for first, second, pose, information, is_loop in graph["edges"]:
        xx, xy, yy, yaw = map(float, information)
        edge = Edge(int(first), int(second), _pose(pose), (xx, xy, yy, yaw), bool(is_loop))
        if not (0 <= edge.first < count and 0 <= edge.second < count and all(map(math.isfinite, edge.information))):
            raise ValueError("an edge is invalid")
        edges.append(edge)
    return edges


def _pose(numbers: list[float]) -> PlanarPose:
    x, y, yaw = map(float, numbers)
    if not all(map(math.isfinite, (x, y, yaw))):
        raise ValueError("a pose is NaN or infinite")
    return PlanarPose(x, y, yaw)
