"""Particles in images and readings: spheres in drawn images, and echoes of rendered lidars and depth cameras."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import mujoco
import numpy as np

from simkit.linear_algebra import matmul
from simkit.pose import Vector
from simkit.runtime import Simulation
from simkit.runtime.particle_clouds import find_clouds

_SPHERE = int(mujoco.mjtGeom.mjGEOM_SPHERE)
_MOST_DRAWN = 2000  # particles of one image
_GLOW = 0.6  # share of the colour that is independent of light: smoke has no dark side
_UPRIGHT = np.eye(3).reshape(9)
_LENGTH_OF_ONES = 3.0**0.5


def drawer_of_particles(sim: Simulation, time: float) -> Callable[[mujoco.MjvScene], None] | None:
    """Return a function that adds the present particles to a scene as transparent spheres; None without particles."""
    clouds = find_clouds(sim, time)
    if not clouds:
        return None
    positions, radii, colours = (
        np.concatenate([getattr(cloud, name) for cloud in clouds]) for name in ("positions", "radii", "colours")
    )
    stride = -(-len(radii) // _MOST_DRAWN)

    def draw(scene: mujoco.MjvScene) -> None:
        for position, radius, colour in zip(positions[::stride], radii[::stride], colours[::stride], strict=True):
            if scene.ngeom >= scene.maxgeom:
                return
            size = np.array((radius, radius, radius))
            mujoco.mjv_initGeom(scene.geoms[scene.ngeom], _SPHERE, size, position, _UPRIGHT, colour.astype(np.float32))
            scene.geoms[scene.ngeom].emission = _GLOW
            scene.ngeom += 1

    return draw


@dataclass(frozen=True, slots=True)
class Echoes:
    """Echoes of the particles at one instant, seen from a sensor.

    An echo is that of gz-rendering (gpu_rays_1st_pass_fs.glsl): a particle faces the sensor as a disc. With the
    probability of the scatter ratio, the ray ends behind its first disc, at a random distance. It never ends behind
    what it hits without particles.

    Attributes:
        clouds: clouds, with positions in the sensor's frame.
        generator: random numbers of the sample.
    """

    clouds: Sequence[tuple[Vector, Vector, float, float]]
    generator: np.random.Generator

    def shorten(self, directions: Vector, ranges: Vector) -> Vector:
        """Return the ranges [m] with echoes, for unit vectors of the rays, shape (n, 3)."""
        chance, deviation = self.generator.random(len(ranges)), self.generator.standard_normal(len(ranges))
        shortened = ranges.copy()
        which = np.flatnonzero(chance < max(ratio for _, _, ratio, _ in self.clouds))
        chance, deviation, ranges = chance[which], deviation[which], ranges[which]
        x, y, z = (np.ascontiguousarray(directions[which, axis]) for axis in range(3))
        first = np.full(len(which), np.inf)
        ratio, spread = np.zeros(len(which)), np.zeros(len(which))
        for centres, radii, scatter_ratio, cloud_spread in self.clouds:
            squares = centres[:, 0] ** 2 + centres[:, 1] ** 2 + centres[:, 2] ** 2 - radii * radii
            tangents = np.sqrt(np.maximum(squares, 0.0))  # ways along rays that touch the edges of the discs
            for (cx, cy, cz), tangent in zip(centres.tolist(), tangents.tolist(), strict=True):
                along = x * cx
                along += y * cy
                along += z * cz
                hit = np.flatnonzero((along > tangent) & (along < first))
                first[hit], ratio[hit], spread[hit] = along[hit], scatter_ratio, cloud_spread
        noise = spread * (deviation + 0.5 * (chance - 0.5) ** 2)
        echo = first + _LENGTH_OF_ONES * np.abs(noise)
        is_seen = (chance < ratio) & (first < ranges) & (echo < ranges)
        shortened[which[is_seen]] = echo[is_seen]
        return shortened


def find_echoes(sim: Simulation, scoped: str, time: float, position: Vector, rotation: Vector) -> Echoes | None:
    """Return the echoes of a sensor at a time; None without particles.

    Args:
        sim: simulation with the particles.
        scoped: scoped name of the sensor, for its random numbers.
        time: time of the sample [s].
        position: position of the sensor in the world [m].
        rotation: rotation matrix of the sensor in the world.
    """
    clouds = find_clouds(sim, time)
    if not clouds:
        return None
    seen = [(matmul(c.positions - position, rotation), c.radii, c.scatter_ratio, c.spread) for c in clouds]
    return Echoes(seen, sim.engine.streams.words(scoped, "particles", round(time / sim.timestep)))
