"""Picture of a run: the scene from above, the driven path and the last scan."""

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
_SHORTEST = 0.01  # [m] of travel per piece of the path
_VERTICAL_FOV = 0.8  # [rad]
_FILLED = 0.9  # fraction of the image that the visible points fill
_NEAREST = 0.15  # [m] least distance of the eye
_VIEW = np.array((0.6, 0.8, -1.0)) / math.sqrt(2.0)  # line of sight, 45° downwards
_CORNERS = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))
_SCANNERS = frozenset({"ray", "gpu_ray", "lidar", "gpu_lidar"})


class DrivenPath:
    """Paths of the models that move; the run loop calls `sample`."""

    def __init__(self, sim: Simulation) -> None:
        self._sim = sim
        self.tracks: dict[str, list[Points]] = {}
        self.sample()

    def sample(self) -> None:
        """Store the present positions, except in a diverged state, which the next step reports."""
        if not np.isfinite(self._sim.mj_data.qpos).all():
            return
        for name, model in self._sim.models.items():
            if model.static:
                continue
            position = model.pose.position
            track = self.tracks.setdefault(name, [position])
            if float(np.linalg.norm(position - track[-1])) >= _SHORTEST:
                track.append(position)


def scan_points(message: LaserScan, pose: Pose) -> Points:
    """Return the points of a `LaserScan` in the world frame [m], shape (n, 3), for a scanner at `pose`."""
    ranges = np.asarray(message.ranges, dtype=np.float64)
    angles = message.angle_min + np.arange(len(ranges)) * message.angle_increment
    hit = np.isfinite(ranges)
    flat = np.stack(
        (ranges[hit] * np.cos(angles[hit]), ranges[hit] * np.sin(angles[hit]), np.zeros(int(hit.sum()))), axis=1
    )
    points: Points = flat @ pose.matrix.T + pose.position
    return points


def save_picture(sim: Simulation, path: Path, render: Render, driven: DrivenPath | None = None) -> None:
    """Draw the present state of the simulation to an image file (`.png` or `.jpg`).

    Args:
        sim: simulation to draw.
        path: image file to write.
        render: function that draws a view of a simulation: `render_view` of the cameras' `overview_image`.
        driven: paths to draw.

    Raises:
        RenderError: SK-RENDER-001 there is no renderer.
        InputError: SK-CLI-013 the file is not writable.
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

    eye, target = _viewpoint([*points, *_moving_models(sim)], driven)
    # twice the resolution gives smooth edges on every renderer
    width, height = _SIZE
    large = render(
        sim,
        _OVERSAMPLED * width,
        _OVERSAMPLED * height,
        eye=eye,
        target=target,
        vertical_fov=_VERTICAL_FOV,
        decorate=decorate,
    )
    colours = cv2.resize(large, _SIZE, interpolation=cv2.INTER_AREA)
    try:
        is_saved = cv2.imwrite(str(path), colours[:, :, ::-1])
    except cv2.error as error:
        raise InputError(
            f"SK-CLI-013 cannot write {path}: {str(error).strip().splitlines()[-1]}", "SK-CLI-013"
        ) from None
    if not is_saved:
        raise InputError(f"SK-CLI-013 cannot write {path}", "SK-CLI-013")


def check_target(path: Path) -> None:
    """Check before a run whether its picture can be written.

    Raises:
        InputError: SK-CLI-013 the suffix is not supported, or the folder does not exist.
    """
    if path.suffix.lower() not in (".png", ".jpg", ".jpeg"):
        raise InputError(
            f"SK-CLI-013 --picture {path}: found the ending {path.suffix!r}; expected .png or .jpg", "SK-CLI-013"
        )
    if not path.absolute().parent.is_dir():
        raise InputError(f"SK-CLI-013 --picture {path}: folder {path.absolute().parent} does not exist", "SK-CLI-013")


def _last_scans(sim: Simulation) -> list[tuple[LaserScan, Pose]]:
    """Return the newest planar scan of each scanner, with the scanner's pose."""
    found = []
    for sensor in sim.contents.sensors.values():
        if sensor.kind in _SCANNERS:
            message = sensor.latest
            if hasattr(message, "ranges"):
                found.append((message, sensor.pose))
    return found


def _moving_models(sim: Simulation) -> list[Points]:
    """Return the corners of the boxes around the drawn geoms of all models that are not static [m], shape (8 n, 3)."""
    model, data = sim.mj_model, sim.mj_data
    links = sim.engine.names.links.values()
    owned = [geom for link in links if not sim.models[link.model].static for geom in link.visuals or link.geoms]
    drawn = np.array(owned, dtype=int)
    drawn = drawn[(model.geom_rbound[drawn] > 0.0)]  # a plane has no bounds
    if not len(drawn):
        return []
    corners = model.geom_aabb[drawn, None, :3] + _CORNERS * model.geom_aabb[drawn, None, 3:]
    axes = data.geom_xmat[drawn].reshape(-1, 3, 3)
    return [(np.einsum("nij,nkj->nki", axes, corners) + data.geom_xpos[drawn, None]).reshape(-1, 3)]


def _viewpoint(points: list[Points], driven: DrivenPath | None) -> tuple[Points, Points] | tuple[None, None]:
    """Return eye and target [m] of a view from obliquely above that shows all moving models and scan points.

    A point at (across, up, depth) from the target is in the image if |across| and |up| are at most the tangents of half
    the opening angles times its distance along the view. So each point gives a least distance of the eye. The target is
    shifted until the least distances of opposite edges are equal.
    """
    visible = [cloud for cloud in points if len(cloud)]
    if driven is not None:
        visible += [np.array(track) for track in driven.tracks.values()]
    if not visible:
        return None, None
    cloud = np.concatenate(visible)
    target = (cloud.min(axis=0) + cloud.max(axis=0)) / 2
    across = np.cross(_VIEW, (0.0, 0.0, 1.0))
    across /= np.linalg.norm(across)
    axes = np.array((across, np.cross(across, _VIEW), _VIEW))
    half_height = _FILLED * math.tan(_VERTICAL_FOV / 2)
    distance = 0.0
    for axis, half in ((0, half_height * _SIZE[0] / _SIZE[1]), (1, half_height)):
        position, depth = (cloud - target) @ axes[axis], (cloud - target) @ axes[2]
        high, low = float((position / half - depth).max()), float((-position / half - depth).max())
        target = target + axes[axis] * half * (high - low) / 2
        distance = max(distance, (high + low) / 2)
    return target - max(distance, _NEAREST) * axes[2], target


def _add_capsule(scene: mujoco.MjvScene, start: Points, end: Points, radius: float, colour: tuple[float, ...]) -> None:
    import mujoco

    geom = _next_geom(scene, mujoco.mjtGeom.mjGEOM_CAPSULE, colour)
    if geom is not None:
        mujoco.mjv_connector(geom, mujoco.mjtGeom.mjGEOM_CAPSULE, radius, np.asarray(start), np.asarray(end))


def _add_sphere(scene: mujoco.MjvScene, position: Points, radius: float, colour: tuple[float, ...]) -> None:
    import mujoco

    geom = _next_geom(scene, mujoco.mjtGeom.mjGEOM_SPHERE, colour)
    if geom is not None:
        geom.size[:] = radius
        geom.pos[:] = position


def _next_geom(scene: mujoco.MjvScene, kind: mujoco.mjtGeom, colour: tuple[float, ...]) -> mujoco.MjvGeom | None:
    """Return an unused geom of the drawn scene; None if the scene is full (the last decorations are then missing)."""
    import mujoco

    if scene.ngeom >= scene.maxgeom:
        return None
    geom: mujoco.MjvGeom = scene.geoms[scene.ngeom]
    mujoco.mjv_initGeom(geom, kind, np.zeros(3), np.zeros(3), np.eye(3).reshape(-1), np.array(colour, dtype=np.float32))
    geom.emission = 0.6
    scene.ngeom += 1
    return geom
