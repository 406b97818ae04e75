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
_DEEPEST: Final = 20.0  # [m] below the ground: the bed of a pool is not as deep, and a model falls so far in 2 s
_DEPTH_SIZES: Final = 2.0  # depth, relative to the size of everything else


def find_stray_models(
    sim: Simulation, boxes_by_model: Mapping[str, Points], moving: Sequence[str], ground: float
) -> tuple[str, ...]:
    """Return the models that must not decide the view of a picture, in the order of the world.

    A model is left out if `SK-PHYS-032` has reported it, if it is far below the ground, or if it is far from the middle
    half of all models. A single model is never left out for its distance.

    Args:
        sim: simulation to show.
        boxes_by_model: corners of the boxes around the drawn geoms of each model [m], shape (n, 3).
        moving: names of the models that are not static.
        ground: height of the lowest static shape [m]; infinite if there is none.
    """
    left_out = {name for name in moving if name in sim.engine.stray_bodies.reported}
    kept = {name: box for name, box in boxes_by_model.items() if name not in left_out and len(box)}
    if len(kept) > 2:
        centres = np.array([(box.min(axis=0) + box.max(axis=0)) / 2 for box in kept.values()])
        ways = np.abs(centres - np.median(centres, axis=0)).max(axis=1)
        nearest = np.argsort(ways, kind="stable")[: (len(ways) + 1) // 2]
        names = list(kept)
        low, high = _bounds([kept[names[number]] for number in nearest.tolist()])
        for number in np.argsort(ways, kind="stable").tolist():  # a chain of models grows the box step by step
            box = kept[names[number]]
            gap = norm(np.maximum(0.0, np.maximum(low - box.max(axis=0), box.min(axis=0) - high)))
            if gap > max(_FARTHEST, _SIZES * norm(high - low)):
                left_out.add(names[number])
            else:
                low, high = _bounds([np.array((low, high)), box])
    if np.isfinite(ground):
        rest = [box for name, box in kept.items() if name not in left_out and box[:, 2].max() >= ground - _DEEPEST]
        size = norm(np.ptp(np.concatenate(rest), axis=0)) if rest else 0.0
        depth = max(_DEEPEST, _DEPTH_SIZES * size)
        left_out.update(name for name in moving if name in kept and kept[name][:, 2].max() < ground - depth)
    return tuple(name for name in sim.models if name in left_out)


def _bounds(boxes: Sequence[Points]) -> tuple[Points, Points]:
    """Return the lowest and the highest corner around points."""
    points = np.concatenate(boxes)
    low: Points = points.min(axis=0)
    high: Points = points.max(axis=0)
    return low, high
