"""Reader of `<population>`: many copies of one model, at positions from a rule, as in Gazebo Classic.

Random positions come from a separate stream, whose seed is the names of the world and the population. The same file
therefore gives the same positions in every process, and one population never changes another.
"""

from __future__ import annotations

import hashlib
import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from simkit.diagnostics import did_you_mean
from simkit.linear_algebra import matmul
from simkit.loaders.sdf.entity_names import read_name
from simkit.loaders.sdf.load_context import MAX_MODELS, EntitySource, SdfFile, Workspace, read_pose
from simkit.number_text import counted
from simkit.params import Params
from simkit.pose import Pose

Points = npt.NDArray[np.float64]
DISTRIBUTIONS = ("random", "uniform", "grid", "linear-x", "linear-y", "linear-z")
_CODE = "SK-SDF-033"
_WIDEST = 1e12  # [m], limit for a region and for the steps of a grid
_SAMPLES = 10_000
_ROUNDS = 100


@dataclass(frozen=True, slots=True)
class _Region:
    """Region of the copies, in the population's own axes: a box from 0 to `size`, or a cylinder about z."""

    kind: str
    size: tuple[float, float, float]

    def random_points(self, count: int, stream: np.random.Generator) -> Points:
        """Return random points; a cylinder's radii are uniform, so it is denser near the axis, as in Gazebo."""
        numbers: Points = stream.random((count, 3))
        if self.kind == "box":
            return np.asarray(numbers * np.array(self.size))
        angle, radius = 2 * math.pi * numbers[:, 0], self.size[0] * numbers[:, 1]
        return np.column_stack((radius * np.cos(angle), radius * np.sin(angle), self.size[2] * numbers[:, 2]))


def population_sources(population: Params, world: str, file: SdfFile, workspace: Workspace) -> list[EntitySource]:
    """Return the copies, named `model_clone_0`, `model_clone_1`, ...; an empty list if the population is invalid.

    Each copy is upright: its roll, pitch and yaw are 0. As in Gazebo, the model's own `<pose>` is ignored.
    """
    diagnostics = workspace.diagnostics
    name = read_name(population, diagnostics, file.version)
    models = population.all("model")
    pose, base = read_pose(population)
    if len(models) != 1:
        population.error(_CODE, f"population {name!r} needs one <model>; it has {len(models)}")
        return []
    model = read_name(models[0], diagnostics, file.version)
    models[0].child("pose")
    points = _points(population, name, f"{world}::{name}", pose)
    if not model or points is None:
        models[0].mark_all_read()
        return []
    return [
        EntitySource(f"{model}_clone_{i}", models[0], file, Pose(tuple(point)), base, where=population.where)
        for i, point in enumerate(points)
    ]


def _points(population: Params, name: str, stream: str, pose: Pose) -> Points | None:
    """Return the positions of the copies, in the base frame of the population's pose."""
    rule = population.block("distribution")
    kind = rule.text("type", "random")
    if kind not in DISTRIBUTIONS:
        place = rule.child("type") or rule
        known = ", ".join(DISTRIBUTIONS)
        place.error(_CODE, f"distribution {kind!r} is not one of {known}", did_you_mean(kind, DISTRIBUTIONS))
        return None
    if kind == "grid":
        return _turn_points(_grid(population, rule, name), pose, np.zeros(3))
    count = population.integer("model_count", 1, minimum=1)
    if count > MAX_MODELS:
        population.error(_CODE, f"population {name!r} has {counted(count, 'model')}; the limit is {MAX_MODELS}")
        return None
    region = _region(population, name)
    if region is None:
        return None
    corner = np.array(region.size) / 2 if region.kind == "box" else np.zeros(3)
    if kind.startswith("linear"):
        if region.kind != "box":
            population.error(_CODE, f"population {name!r}: distribution {kind!r} needs a <box>")
            return None
        return _turn_points(_line(region.size, count, "xyz".index(kind[-1])), pose, corner)
    generator = _random_stream(stream)
    points = region.random_points(count, generator) if kind == "random" else _evenly_spread(region, count, generator)
    return _turn_points(points, pose, corner)


def _turn_points(points: Points | None, pose: Pose, corner: Points) -> Points | None:
    """Rotate and move points to the population's pose.

    `corner` is the half size of a box, whose middle is at the pose. As in Gazebo, it is subtracted without rotation.
    """
    if points is None:
        return None
    turned: Points = matmul(points, pose.matrix.T)
    return turned + (np.asarray(pose.position) - corner)


def _region(population: Params, name: str) -> _Region | None:
    box, cylinder = population.child("box"), population.child("cylinder")
    if box is not None:
        size = box.vector3("size", (1.0, 1.0, 1.0))
        region = _Region("box", size)
    elif cylinder is not None:
        radius = cylinder.number("radius", 1.0)
        region = _Region("cylinder", (radius, radius, cylinder.number("length", 1.0)))
    else:
        population.error(_CODE, f"population {name!r} needs a <box> or a <cylinder> as its region")
        return None
    if min(region.size) <= 0:
        (box or cylinder or population).error(_CODE, f"population {name!r} has a {region.kind} without a volume")
        return None
    if max(region.size) > _WIDEST:
        message = f"population {name!r} has a {region.kind} that is larger than {_WIDEST:g} m"
        (box or cylinder or population).error(_CODE, message)
        return None
    return region


def _grid(population: Params, rule: Params, name: str) -> Points | None:
    """Return grid points: rows along y, columns along x, the middle of the grid at the population's pose."""
    rows, cols = rule.integer("rows", 1, minimum=1), rule.integer("cols", 1, minimum=1)
    if rows * cols > MAX_MODELS:
        population.error(_CODE, f"population {name!r} has {rows * cols} models; the limit is {MAX_MODELS}")
        return None
    step = np.array(rule.vector3("step", (1.0, 1.0, 0.0)))
    if np.abs(step).max() > _WIDEST:
        rule.error(_CODE, f"population {name!r}: a component of <step> is larger than {_WIDEST:g} m")
        return None
    column, row = np.meshgrid(np.arange(cols) - (cols - 1) / 2, np.arange(rows) - (rows - 1) / 2)
    return np.column_stack((column.ravel() * step[0], row.ravel() * step[1], np.zeros(rows * cols)))


def _line(size: tuple[float, float, float], count: int, axis: int) -> Points:
    """Return points at equal distances along one axis of the box, in the middle of its other axes."""
    points = np.tile(np.array(size) / 2, (count, 1))
    points[:, axis] = size[axis] * np.arange(count) / count
    return points


def _evenly_spread(region: _Region, count: int, stream: np.random.Generator) -> Points:
    """Return evenly spread points: the means of `count` clusters of random points in the region (Lloyd's algorithm)."""
    cloud = region.random_points(max(_SAMPLES, 4 * count), stream)
    centres = cloud[:count].copy()
    if count > 500:  # more centres make clusters of few points, whose means are not spread better than the points
        return centres
    nearest: npt.NDArray[np.intp] | None = None
    for _ in range(_ROUNDS):
        now = _nearest(cloud, centres)
        if nearest is not None and np.array_equal(now, nearest):
            break
        nearest = now
        sizes = np.bincount(nearest, minlength=count)
        for axis in range(3):
            sums = np.bincount(nearest, weights=cloud[:, axis], minlength=count)
            centres[:, axis] = np.where(sizes > 0, sums / np.maximum(sizes, 1), centres[:, axis])
    return centres


def _nearest(cloud: Points, centres: Points) -> npt.NDArray[np.intp]:
    """Return the index of the nearest centre of each point.

    Sums of squares are used, because the last bits of a matrix product depend on the number of threads.
    """
    best = np.full(len(cloud), np.inf)
    index = np.zeros(len(cloud), dtype=np.intp)
    for i, centre in enumerate(centres):
        distance = ((cloud - centre) ** 2).sum(axis=1)
        closer = distance < best
        best[closer], index[closer] = distance[closer], i
    return index


def _random_stream(name: str) -> np.random.Generator:
    """Return a stream of random numbers that depends only on its name."""
    words = np.frombuffer(hashlib.sha256(name.encode()).digest(), dtype="<u4")
    return np.random.Generator(np.random.PCG64(np.random.SeedSequence([int(w) for w in words])))
