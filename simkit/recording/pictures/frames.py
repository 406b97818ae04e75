"""Drawing of one picture or video frame: the scene, its backdrop and the marks over it."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from simkit.float_sum import float_sum
from simkit.linear_algebra import norm
from simkit.recording.pictures.camera import VERTICAL_FOV, Camera, frame_points, line_of_sight
from simkit.recording.pictures.overlay import Colours, Distances, Marks, Points, draw_overlay
from simkit.recording.pictures.subject import Subject

if TYPE_CHECKING:
    from simkit.runtime import Simulation

Render = Callable[..., Colours]
"""Function that draws a view of a simulation: `render_view` of the cameras' `overview_image`."""

SOFT_PASSES: Final = 16
"""Passes of a picture with soft shadows and smooth edges: 1.2 s at 1280 × 800 without a graphics card."""
_TRIAL: Final = (192, 120)  # [px] size of the images that compare viewpoints
_ENOUGH: Final = 0.1  # a viewpoint is taken if it shows at most this share less than the best one
_FLAT, _TALL = 0.12, 0.7  # height of a subject, relative to its width, that is seen steeply or from the side
_STEEP, _LEVEL = math.radians(50), math.radians(20)
_AZIMUTHS: Final = tuple(math.radians(turn) for turn in (0, 90, -90, 180))
_TOP: Final = ((math.radians(65), 0.15), (math.radians(82), 0.3))
"""Steeper elevations, which show less of the sides, and the share of a subject that they must show in addition."""
_COVERED: Final = 0.5  # share that the best viewpoint shows if nothing needs to be opened
_HEADROOM: Final = 0.05  # [m] between the robots and the lowest shape that can be left out
_ROBOTS: Final = 0.7  # weight of robots beside that of scans and paths


@dataclass(frozen=True)
class Look:
    """Size and quality of pictures.

    Attributes:
        width, height: size of the image [px].
        quality: fast, gazebo or high.
        passes: passes of a picture; 1 gives hard shadows.
        backdrop: True shades an empty background.
    """

    width: int = 1280
    height: int = 800
    quality: str = "gazebo"
    passes: int = SOFT_PASSES
    backdrop: bool = True


def draw_frame(sim: Simulation, render: Render, camera: Camera, look: Look, marks: Marks, subject: Subject) -> Colours:
    """Draw the present state of a simulation with all marks.

    Raises:
        RenderError: SK-RENDER-001 there is no renderer.
    """
    distances = np.full((look.height, look.width), np.inf, dtype=np.float32)
    colours = render(
        sim,
        look.width,
        look.height,
        eye=camera.eye,
        target=camera.target,
        vertical_fov=VERTICAL_FOV,
        quality=look.quality,
        passes=look.passes if look.quality != "fast" else 4 if look.passes > 1 else 1,
        lit=_lit_sphere(subject, camera),
        distances=distances,
        ceiling=camera.ceiling,
    )
    surroundings = sim.world.surroundings
    if look.backdrop and not surroundings.sky and surroundings.fog is None:
        colours = _shade_backdrop(colours, distances)
    return draw_overlay(colours, distances, camera.resized(look.width, look.height), marks)


def choose_camera(sim: Simulation, render: Render, subject: Subject, look: Look) -> Camera:
    """Return the camera that shows most of a subject, among several viewpoints.

    A tall subject is seen from the side, a flat one from above. Small images of all viewpoints tell how much of the
    robots, scans and paths is hidden behind walls. If most of it is hidden from everywhere, as below a roof, what is
    above it is not drawn. In a world without robots, the small shapes of the room take their place.
    """
    views = list(_views(subject))
    cameras = [frame_points(subject.points, view, look.width, look.height) for view, _ in views]
    if not len(subject.centres) and not len(subject.traces):
        if not len(subject.room_centres):
            return cameras[0]
        share = _visible_share(sim, render, cameras[0], subject)
        if share > _COVERED:
            return cameras[0]
        best = share, cameras[0]
    else:
        best = _best_camera(
            sim, render, subject, [(camera, more) for camera, (_, more) in zip(cameras, views, strict=True)]
        )
    if best[0] > _COVERED:
        return best[1]
    ceiling = _ceiling(subject)
    opened = [(replace(camera, ceiling=ceiling), more) for camera, (_, more) in zip(cameras, views, strict=True)]
    above = line_of_sight(math.radians(-90), math.radians(89.9))
    opened.append((replace(frame_points(subject.points, above, look.width, look.height), ceiling=ceiling), _TOP[-1][1]))
    below_roof = _best_camera(sim, render, subject, opened)
    return below_roof[1] if below_roof[0] > best[0] + _ENOUGH else best[1]


def _best_camera(
    sim: Simulation, render: Render, subject: Subject, cameras: Sequence[tuple[Camera, float]]
) -> tuple[float, Camera]:
    """Return the first camera that shows most of a subject, and the share that it shows.

    Args:
        sim: simulation to show.
        render: function that draws a view.
        subject: what must be seen.
        cameras: cameras, the preferred one first, each with the share that it must show in addition.
    """
    best: tuple[float, Camera] | None = None
    for camera, more in cameras:
        share = _visible_share(sim, render, camera, subject) - more
        if best is None or share > best[0] + _ENOUGH:
            best = share, camera
    assert best is not None
    return best


def _ceiling(subject: Subject) -> float:
    """Return the height above which nothing belongs to the subject [m]: just above the robots, or half of the room."""
    if len(subject.robots):
        return float(subject.robots[:, 2].max()) + _HEADROOM
    room = subject.room if len(subject.room) else subject.traces
    return float(room[:, 2].min() + room[:, 2].max()) / 2


def _views(subject: Subject) -> Iterator[tuple[Points, float]]:
    """Yield lines of sight with the share that each must show in addition, the preferred one first."""
    span = np.ptp(subject.points, axis=0)
    ratio = float(span[2] / max(math.hypot(span[0], span[1]), 1e-9))
    share = min(max((ratio - _FLAT) / (_TALL - _FLAT), 0.0), 1.0)
    elevation = _STEEP + share * (_LEVEL - _STEEP)
    # a robot alone is seen from its front, a scene from the side that maps have below
    front = subject.heading + math.radians(-40) if not len(subject.traces) and not len(subject.room) else None
    azimuth = math.radians(-127) if front is None else front
    steeper = [(rise, more) for rise, more in _TOP if rise > elevation + 0.1]
    for rise, more in ((elevation, 0.0), *steeper):
        for turn in _AZIMUTHS:
            yield line_of_sight(azimuth + turn, rise), more


def _visible_share(sim: Simulation, render: Render, camera: Camera, subject: Subject) -> float:
    """Return the share of robots and of traces that a camera sees."""
    width, height = _TRIAL
    small = camera.resized(width, height)
    distances = np.full((height, width), np.inf, dtype=np.float32)
    render(
        sim, width, height, eye=camera.eye, target=camera.target, vertical_fov=VERTICAL_FOV, quality="fast",
        distances=distances, ceiling=camera.ceiling,
    )  # fmt: skip
    if not len(subject.centres) and not len(subject.traces):  # a room: small shapes in it
        sizes = np.linalg.norm(np.ptp(subject.room.reshape(-1, 8, 3), axis=1), axis=1)
        is_small = sizes <= np.median(sizes)
        return _seen_share(small, distances, subject.room_centres[is_small], float(np.median(sizes)) / 2)
    radius = norm(np.ptp(subject.robots, axis=0)) / 2 if len(subject.robots) else 0.0
    shares, weights = [], []
    for points, slack, weight in (
        (subject.centres, min(radius, 1.0), _ROBOTS),
        (subject.traces, 0.02 * camera.distance, 1.0 - _ROBOTS),
    ):
        if len(points):
            weights.append(weight)
            shares.append(weight * _seen_share(small, distances, points[:: max(1, len(points) // 200)], slack))
    return float_sum(shares) / float_sum(weights)


def _seen_share(camera: Camera, distances: Distances, points: Points, slack: float) -> float:
    """Return the share of points that are at most `slack` behind the surface at their pixel [m]."""
    height, width = distances.shape
    pixels, depth = camera.project(points)
    column = np.clip(np.rint(pixels[:, 0]), 0, width - 1).astype(int)
    row = np.clip(np.rint(pixels[:, 1]), 0, height - 1).astype(int)
    return float((depth <= distances[row, column] + slack).mean())


def _lit_sphere(subject: Subject, camera: Camera) -> tuple[Points, float]:
    """Return the sphere that shadow maps cover: the subject and the ground beside it, or the part near the camera."""
    points = subject.points
    low, high = points.min(axis=0), points.max(axis=0)
    radius, near = max(0.9 * norm(high - low), 0.05), 1.2 * camera.distance
    return ((low + high) / 2, radius) if radius <= near else (camera.target, near)


def _shade_backdrop(colours: Colours, distances: Distances) -> Colours:
    """Shade the empty pixels from light at the top to dark at the bottom."""
    is_empty = ~np.isfinite(distances)
    if not is_empty.any():
        return colours
    shade: NDArray[np.float64] = np.linspace(1.12, 0.86, colours.shape[0])[:, None, None]
    shaded = np.clip(colours * shade, 0, 255).astype(np.uint8)
    return np.where(is_empty[:, :, None], shaded, colours)
