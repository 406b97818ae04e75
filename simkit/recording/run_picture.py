"""Draw a picture of a run: the scene from above, the driven path and the last scan."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from simkit.errors import InputError
from simkit.pose import Pose

if TYPE_CHECKING:
    import mujoco

    from simkit.msgs import LaserScan
    from simkit.runtime import Simulation

Points = NDArray[np.float64]
Render = Callable[..., NDArray[np.uint8]]

_SIZE = (1280, 800)  # [px]
_OVERSAMPLED = 2
_PATH_COLOUR = (0.10, 0.45, 0.95, 1.0)
_SCAN_COLOUR = (0.95, 0.20, 0.15, 1.0)
_PATH_RADIUS, _SCAN_RADIUS = 0.012, 0.018  # [m] at a scene of 5 m
_SHORTEST = 0.01  # [m] of travel that makes a new piece of the path
_SCANNERS = frozenset({"ray", "gpu_ray", "lidar", "gpu_lidar"})


class DrivenPath:
    """Paths of the models that move; the run loop calls `sample`."""

    def __init__(self, sim: Simulation) -> None:
        self._sim = sim
        self.tracks: dict[str, list[Points]] = {}
        self.sample()

    def sample(self) -> None:
        """Notes the present places."""
        for name, model in self._sim.models.items():
            if model.static:
                continue
            place = model.pose.position
            track = self.tracks.setdefault(name, [place])
            if float(np.linalg.norm(place - track[-1])) >= _SHORTEST:
                track.append(place)


def scan_points(message: LaserScan, pose: Pose) -> Points:
    """The points [m] in the world that a `LaserScan` hit, shape (n, 3), for a scanner at `pose`."""
    ranges = np.asarray(message.ranges, dtype=np.float64)
    angles = message.angle_min + np.arange(len(ranges)) * message.angle_increment
    hit = np.isfinite(ranges)
    flat = np.stack(
        (ranges[hit] * np.cos(angles[hit]), ranges[hit] * np.sin(angles[hit]), np.zeros(int(hit.sum()))), axis=1
    )
    points: Points = flat @ pose.matrix.T + pose.position
    return points


def save_picture(sim: Simulation, path: Path, render: Render, driven: DrivenPath | None = None) -> None:
    """Draws the simulation as it is now into an image file (`.png` or `.jpg`).

    Args:
        sim: the simulation.
        path: the image file.
        render: draws a view of a simulation; `simkit.build.render_view`.
        driven: paths to draw in.

    Raises:
        RenderError: SK-RENDER-001 there is no renderer.
        InputError: SK-CLI-013 the file cannot be written.
    """
    import cv2

    points = [scan_points(*found) for found in _last_scans(sim)]

    def decorate(scene: mujoco.MjvScene) -> None:
        size = min(max(float(sim.mj_model.stat.extent) / 5.0, 0.3), 3.0)
        for track in driven.tracks.values() if driven is not None else ():
            for a, b in itertools.pairwise(track):
                _add_capsule(scene, a, b, _PATH_RADIUS * size, _PATH_COLOUR)
        for cloud in points:
            for point in cloud:
                _add_sphere(scene, point, _SCAN_RADIUS * size, _SCAN_COLOUR)

    eye, target = _viewpoint([*points, *_moving_bodies(sim)], driven)
    # drawn larger and shrunk: thin edges come out smooth on any renderer
    width, height = _SIZE
    large = render(sim, _OVERSAMPLED * width, _OVERSAMPLED * height, eye=eye, target=target, decorate=decorate)
    colours = cv2.resize(large, _SIZE, interpolation=cv2.INTER_AREA)
    try:
        written = cv2.imwrite(str(path), colours[:, :, ::-1])
    except cv2.error as error:
        raise InputError(
            f"SK-CLI-013 cannot write {path}: {str(error).strip().splitlines()[-1]}", "SK-CLI-013"
        ) from None
    if not written:
        raise InputError(f"SK-CLI-013 cannot write {path}", "SK-CLI-013")


def check_target(path: Path) -> None:
    """Says before a run that its picture cannot be written.

    Raises:
        InputError: SK-CLI-013.
    """
    if path.suffix.lower() not in (".png", ".jpg", ".jpeg"):
        raise InputError(
            f"SK-CLI-013 --picture {path}: found the ending {path.suffix!r}, allowed is .png or .jpg", "SK-CLI-013"
        )
    if not path.absolute().parent.is_dir():
        raise InputError(f"SK-CLI-013 --picture {path}: there is no folder {path.absolute().parent}", "SK-CLI-013")


def _last_scans(sim: Simulation) -> list[tuple[LaserScan, Pose]]:
    """The newest planar scan of each scanner, with the scanner's pose."""
    found = []
    for sensor in sim.contents.sensors.values():
        if sensor.kind in _SCANNERS:
            message = sensor.latest
            if hasattr(message, "ranges"):
                found.append((message, sensor.pose))
    return found


def _moving_bodies(sim: Simulation) -> list[Points]:
    """Corners [m] in the world of the boxes around what can move, shape (2 n, 3), so that none is cut off."""
    model, data = sim.mj_model, sim.mj_data
    moves = (np.asarray(model.geom_bodyid) > 0) & (np.asarray(model.geom_rbound) > 0.0)
    if not moves.any():
        return []
    places, reach = np.asarray(data.geom_xpos)[moves], np.asarray(model.geom_rbound)[moves][:, None]
    return [np.concatenate((places - reach, places + reach))]


def _viewpoint(points: list[Points], driven: DrivenPath | None) -> tuple[Points, Points] | tuple[None, None]:
    """Eye and target [m]: obliquely from above, so that what moved and what was seen fills the picture."""
    seen = [cloud for cloud in points if len(cloud)]
    if driven is not None:
        seen += [np.array(track) for track in driven.tracks.values()]
    if not seen:
        return None, None
    cloud = np.concatenate(seen)
    low, high = cloud.min(axis=0), cloud.max(axis=0)
    target = (low + high) / 2
    radius = max(float(np.linalg.norm(high - low)) / 2, 0.6)
    distance = 0.88 * radius / math.tan(0.4)
    eye = target + distance * np.array((-0.34, -0.46, 0.82))
    return eye, target


def _add_capsule(scene: mujoco.MjvScene, start: Points, end: Points, radius: float, colour: tuple[float, ...]) -> None:
    import mujoco

    geom = _next_geom(scene, mujoco.mjtGeom.mjGEOM_CAPSULE, colour)
    if geom is not None:
        mujoco.mjv_connector(geom, mujoco.mjtGeom.mjGEOM_CAPSULE, radius, np.asarray(start), np.asarray(end))


def _add_sphere(scene: mujoco.MjvScene, place: Points, radius: float, colour: tuple[float, ...]) -> None:
    import mujoco

    geom = _next_geom(scene, mujoco.mjtGeom.mjGEOM_SPHERE, colour)
    if geom is not None:
        geom.size[:] = radius
        geom.pos[:] = place


def _next_geom(scene: mujoco.MjvScene, kind: mujoco.mjtGeom, colour: tuple[float, ...]) -> mujoco.MjvGeom | None:
    """A fresh drawn geom, or None when the scene is full (the picture then lacks its last decorations)."""
    import mujoco

    if scene.ngeom >= scene.maxgeom:
        return None
    geom: mujoco.MjvGeom = scene.geoms[scene.ngeom]
    mujoco.mjv_initGeom(geom, kind, np.zeros(3), np.zeros(3), np.eye(3).reshape(-1), np.array(colour, dtype=np.float32))
    geom.emission = 0.6
    scene.ngeom += 1
    return geom
