"""Wet part of a surface of triangles in calm water, and the forces on it.

The formulas are those of `Physics.cc` of asv_wave_sim: pressure of the water at rest, friction after ITTC 1957,
pressure drag by the angle between the surface and its velocity, and damping by the wet share of the area.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from simkit.extend import Vector
from simkit.linear_algebra import matmul, norm

_LEAST_REYNOLDS = 1e3
_VISCOSITY = 1.0533e-6  # of salt water [m²/s]


@dataclass(frozen=True)
class Drag:
    """Coefficients of the drag.

    Attributes:
        has_damping, has_friction, has_pressure: parts that act.
        linear, turning: linear and quadratic damping of the velocity and of the turning rate.
        positive, negative: linear and quadratic pressure drag and exponent, against and along the flow.
        speed: reference speed of the pressure drag [m/s].
    """

    has_damping: bool
    has_friction: bool
    has_pressure: bool
    linear: tuple[float, float]
    turning: tuple[float, float]
    positive: tuple[float, float, float]
    negative: tuple[float, float, float]
    speed: float


def wet_triangles(corners: Vector) -> tuple[Vector, float]:
    """Return the parts of triangles below z = 0, shape (m, 3, 3), and the length of the waterline along x [m].

    Args:
        corners: corners of the triangles [m], shape (n, 3, 3), counter-clockwise from outside.
    """
    heights = corners[:, :, 2]
    is_wet = (heights < 0.0).all(axis=1)
    is_cut = ~is_wet & (heights < 0.0).any(axis=1)
    parts, length = [corners[is_wet]], 0.0
    for triangle in corners[is_cut].tolist():
        polygon: list[list[float]] = []
        crossings: list[list[float]] = []
        for first, second in zip(triangle, [*triangle[1:], triangle[0]], strict=True):
            if first[2] < 0.0:
                polygon.append(first)
            if (first[2] < 0.0) != (second[2] < 0.0):
                share = first[2] / (first[2] - second[2])
                crossing = [a + share * (b - a) for a, b in zip(first, second, strict=True)]
                polygon.append(crossing)
                crossings.append(crossing)
        if len(crossings) == 2:
            length += abs(crossings[1][0] - crossings[0][0])
        parts += [np.array([[polygon[0], polygon[i], polygon[i + 1]]]) for i in range(1, len(polygon) - 1)]
    return np.concatenate(parts), length / 2


def surface_wrench(
    wet: Vector,
    area: float,
    waterline: float,
    centre: Vector,
    motion: Vector,
    weight: float,
    density: float,
    drag: Drag,
) -> tuple[Vector, Vector]:
    """Return force [N] and torque [N·m] about a point of the water on a wet surface, in world axes.

    Args:
        wet: wet triangles, shape (m, 3, 3).
        area: area of the whole surface [m²].
        waterline: length of the waterline [m].
        centre: the point, the centre of mass.
        motion: its velocity [m/s] and the angular velocity [rad/s], shape (6,).
        weight: weight of the water [N/m³].
        density: density of the water [kg/m³].
        drag: coefficients.
    """
    linear, angular = motion[:3], motion[3:]
    first, second, third = wet.transpose(1, 0, 2)
    doubled = np.cross(second - first, third - first)
    areas = np.sqrt(np.einsum("ij,ij->i", doubled, doubled)) / 2
    normals = doubled / np.maximum(2 * areas, 1e-300)[:, None]
    arms = wet - centre
    depths = wet[:, :, 2]
    # of two linear functions f and g, the integral over a triangle is area / 12 · (Σ f·g + Σ f · Σ g)
    pressed = np.einsum("ij,ijk->ik", depths, arms) + depths.sum(axis=1)[:, None] * arms.sum(axis=1)
    force = weight * (normals * (areas * depths.sum(axis=1) / 3)[:, None]).sum(axis=0)
    torque = weight * np.cross(pressed * (areas / 12)[:, None], normals).sum(axis=0)
    levers = arms.mean(axis=1)
    velocities = linear + np.cross(np.broadcast_to(angular, levers.shape), levers)
    pushes = np.zeros_like(levers)
    if drag.has_friction:
        pushes += _friction(velocities, normals, areas, norm(linear) * waterline, density)
    if drag.has_pressure:
        pushes += _pressure_drag(velocities, normals, areas, drag)
    force += pushes.sum(axis=0)
    torque += np.cross(levers, pushes).sum(axis=0)
    if drag.has_damping:
        share = math.fsum(areas.tolist()) / max(area, 1e-300)
        force -= share * (drag.linear[0] + drag.linear[1] * norm(linear)) * linear
        torque -= share * (drag.turning[0] + drag.turning[1] * norm(angular)) * angular
    return force, torque


def _friction(velocities: Vector, normals: Vector, areas: Vector, reach: float, density: float) -> Vector:
    reynolds = max(_LEAST_REYNOLDS, reach / _VISCOSITY)
    factor = 0.075 / (math.log10(reynolds) - 2.0) ** 2
    speeds = np.sqrt(np.einsum("ij,ij->i", velocities, velocities))
    along = velocities - np.einsum("ij,ij->i", velocities, normals)[:, None] * normals
    lengths = np.sqrt(np.einsum("ij,ij->i", along, along))
    directions = -along / np.maximum(lengths, 1e-12)[:, None]
    pushes: Vector = (0.5 * density * factor * areas * speeds * speeds)[:, None] * directions
    return pushes


def _pressure_drag(velocities: Vector, normals: Vector, areas: Vector, drag: Drag) -> Vector:
    speeds = np.sqrt(np.einsum("ij,ij->i", velocities, velocities))
    cosines = np.einsum("ij,ij->i", velocities, normals) / np.maximum(speeds, 1e-12)
    ratios = speeds / drag.speed
    sizes = []
    for cosine, ratio, area in zip(cosines.tolist(), ratios.tolist(), areas.tolist(), strict=True):
        first, second, exponent = drag.positive if cosine >= 0.0 else drag.negative
        sizes.append(-math.copysign(1.0, cosine) * (first + second * ratio) * ratio * area * abs(cosine) ** exponent)
    pushes: Vector = np.array(sizes)[:, None] * normals if sizes else matmul(np.zeros((0, 3)), np.eye(3))
    return pushes
