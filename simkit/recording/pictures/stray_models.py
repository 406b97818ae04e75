"""Models that a picture does not frame: they fell out of the world, or are far away from everything else."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from simkit.linear_algebra import norm

if TYPE_CHECKING:
    from simkit.runtime import Simulation

Points = NDArray[np.float64]

_FARTHEST: Final = 300.0  # [m] distance that no model is left out for: a multicopter flies as high
_SIZES: Final = 20.0  # distance, relative to the size of everything else
_OBJECT_SIZES: Final = 8.0  # the same for an object beside robots: a ball that rolled away would make them dots
_DEEPEST: Final = 20.0  # [m] below the ground: the bed of a pool is not as deep, and a model falls so far in 2 s
_DEPTH_SIZES: Final = 2.0  # depth, relative to the size of everything else


def find_stray_models(
    sim: Simulation,
    boxes_by_model: Mapping[str, Points],
    moving: Sequence[str],
    robots: Sequence[str],
    ground: float,
) -> tuple[str, ...]:
    """Return the models that must not decide the view of a picture, in the order of the world.

    A model is left out if `SK-PHYS-032` has reported it, if it is far below the ground, or if it is far from the middle
    half of all models. A single model is never left out for its distance. In a world with robots, other moving models
    are compared with the robots and the static models.

    Args:
        sim: simulation to show.
        boxes_by_model: corners of the boxes around the drawn geoms of each model [m], shape (n, 3).
        moving: names of the models that are not static.
        robots: names of the models that are not static and have joints or sensors.
        ground: height of the lowest static shape [m]; infinite if there is none.
    """
    left_out = {name for name in moving if name in sim.engine.stray_bodies.reported}
    kept = {name: box for name, box in boxes_by_model.items() if name not in left_out and len(box)}
    objects = [name for name in kept if robots and name in moving and name not in robots]
    scene = [name for name in kept if name not in objects]
    bounds = None
    if len(scene) > 2:
        bounds = _leave_out_far_models(kept, scene, left_out, None, _FARTHEST, _SIZES)
    elif scene:
        bounds = _bounds([kept[name] for name in scene])
    if bounds is not None and norm(bounds[1] - bounds[0]) > 0.0:  # a robot without shapes is a point
        _leave_out_far_models(kept, objects, left_out, bounds, 0.0, _OBJECT_SIZES)
    if np.isfinite(ground):
        rest = [box for name, box in kept.items() if name not in left_out and box[:, 2].max() >= ground - _DEEPEST]
        size = norm(np.ptp(np.concatenate(rest), axis=0)) if rest else 0.0
        depth = max(_DEEPEST, _DEPTH_SIZES * size)
        left_out.update(name for name in moving if name in kept and kept[name][:, 2].max() < ground - depth)
    return tuple(name for name in sim.models if name in left_out)


def _leave_out_far_models(
    boxes_by_model: Mapping[str, Points],
    names: Sequence[str],
    left_out: set[str],
    bounds: tuple[Points, Points] | None,
    least_gap: float,
    sizes: float,
) -> tuple[Points, Points]:
    """Add the models that are far from a box to `left_out`, and return the box around it and all other models.

    Args:
        boxes_by_model: corners around each model [m], shape (n, 3).
        names: models to check.
        left_out: names to extend.
        bounds: lowest and highest corner of the box [m]; None for the middle half of the models.
        least_gap: distance from the box that no model is left out for [m].
        sizes: largest distance, relative to the size of the box.
    """
    centres = np.array([(boxes_by_model[name].min(axis=0) + boxes_by_model[name].max(axis=0)) / 2 for name in names])
    middle = np.median(centres, axis=0) if bounds is None else np.array(bounds).mean(axis=0)
    order = np.argsort(np.abs(centres.reshape(-1, 3) - middle).max(axis=1), kind="stable").tolist()
    if bounds is None:
        bounds = _bounds([boxes_by_model[names[number]] for number in order[: (len(names) + 1) // 2]])
    low, high = bounds
    for number in order:  # a chain of models grows the box step by step
        box = boxes_by_model[names[number]]
        gap = norm(np.maximum(0.0, np.maximum(low - box.max(axis=0), box.min(axis=0) - high)))
        if gap > max(least_gap, sizes * norm(high - low)):
            left_out.add(names[number])
        else:
            low, high = _bounds([np.array((low, high)), box])
    return low, high


def _bounds(boxes: Sequence[Points]) -> tuple[Points, Points]:
    """Return the lowest and the highest corner around points."""
    points = np.concatenate(boxes)
    low: Points = points.min(axis=0)
    high: Points = points.max(axis=0)
    return low, high
