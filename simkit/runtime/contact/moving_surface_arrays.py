"""`simkit.runtime.contact.moving_surface` for many contacts: the same on arrays, with the same bits."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from simkit.runtime.contact.belt import BeltMotion, Point

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.integer[Any]]
Bools = npt.NDArray[np.bool_]

MIN_SINE = 1e-6
"""Sine of an angle below which a normal stands along an axle."""


def find_belt_contacts(
    belts: Ints, frames: Floats, points: Floats, runs: Sequence[BeltMotion | None], axles: Sequence[Point]
) -> tuple[Ints, Floats, Floats]:
    """Which of some contacts are with belts that run, the directions of their friction, and their velocities [m/s].

    Args:
        belts: numbers of those on either side, shape (k, 2); -1 for none.
        frames: normal (from the first side to the second) and tangents of each, shape (k, 9).
        points: where they are [m], world, shape (k, 3).
        runs: how belts run.
        axles: of the belts, unit vectors in the world; any for one that stands.

    Returns:
        Places (m,) among the contacts, directions (m, 3) and velocities (m, 3) in the world.
    """
    does_run = np.array([run is not None for run in (*runs, None)])  # the last for -1
    active: Bools = does_run[belts]
    places = (active[:, 0] | active[:, 1]).nonzero()[0]
    normals, axle = frames[places, :3], np.array(axles)
    speed = np.array([0.0 if run is None else run.speed for run in runs])
    bends = [run is not None and run.centre is not None for run in runs]
    is_bent = np.array(bends)
    centre = np.array([(0.0,) * 3 if run is None or run.centre is None else run.centre for run in runs])
    directions, velocities = np.zeros((2, places.size, 3))
    for side, inwards in ((1, 1.0), (0, -1.0)):
        those = active[places, side].nonzero()[0]
        if not those.size:
            continue
        belt, into = belts[places[those], side], inwards * normals[those]
        along = unit(cross(into, axle[belt]))
        if any(bends):
            bent = is_bent[belt].nonzero()[0]
            away = points[places[those[bent]]] - centre[belt[bent]]
            along[bent] = _circular_directions(along[bent], into[bent], away)
        directions[those] = along
        velocities[those] += (inwards * speed[belt])[:, None] * along
    return places, directions, velocities


def _circular_directions(along: Floats, normal: Floats, away: Floats) -> Floats:
    """The way round a centre that is not against the straight one; that one where there is none round it."""
    circle = unit(cross(normal, away))
    over = dot(circle, along)
    ahead = np.where(over == 0.0, 0.0, np.copysign(1.0, over))
    is_none = (circle == 0.0).all(axis=1, keepdims=True)
    return np.where(is_none, along, circle * ahead[:, None])


def cross(a: Floats, b: Floats) -> Floats:
    """Vector products (k, 3)."""
    (ax, ay, az), (bx, by, bz) = a.T, b.T
    return np.stack((ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx), axis=1)


def dot(a: Floats, b: Floats) -> Floats:
    """Scalar products (k,)."""
    (ax, ay, az), (bx, by, bz) = a.T, b.T
    found: Floats = ax * bx + ay * by + az * bz
    return found


def unit(vectors: Floats) -> Floats:
    """Vectors of length 1 (k, 3); zero for one that has nearly none."""
    length = np.sqrt(dot(vectors, vectors))[:, None]
    return np.where(length > MIN_SINE, vectors / np.maximum(length, MIN_SINE), 0.0)


def along_tangents(frames: Floats, vectors: Floats) -> Floats:
    """Parts (k, 2) of vectors (k, 3) along the tangents of contacts, of frames (k, 9)."""
    return np.stack((dot(frames[:, 3:6], vectors), dot(frames[:, 6:], vectors)), axis=1)


def rotate_frames(frames: Floats, wanted: Floats, upright: float) -> tuple[Floats, Bools]:
    """Contacts' frames (k, 9) whose first tangent is along a direction (k, 3), and where there is one.

    Args:
        frames: as they are; they stay where a direction stands on the surface.
        wanted: the directions, in the world.
        upright: of the square of a direction, the part that has to lie along the surface.
    """
    normal = frames[:, :3]
    flat = wanted - dot(wanted, normal)[:, None] * normal
    square = dot(flat, flat)
    lies: Bools = square > upright * dot(wanted, wanted)
    first = flat / np.where(lies, np.sqrt(square), 1.0)[:, None]
    found: Floats = np.hstack((normal, first, cross(normal, first)))
    return np.where(lies[:, None], found, frames), lies


def rotate_surface_velocities(flows: Floats, before: Floats, after: Floats) -> Floats:
    """Speeds of surfaces (k, 3) along the tangents of some frames (k, 9), along those of others."""
    over = flows[:, :1] * before[:, 3:6] + flows[:, 1:2] * before[:, 6:]
    return np.hstack((along_tangents(after, over), flows[:, 2:]))
