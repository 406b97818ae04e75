"""Noise and bias of scans, clouds and images, item by item."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import Final

import numpy as np

from simkit_identification.measures.context import Context
from simkit_identification.measures.measure import Measure
from simkit_identification.measures.recording import ArrayOverTime, Floats, Stream

RANGE_EDGES: Final = (0.0, 0.5, 1.0, 2.0, 3.0, 5.0, 8.0, 12.0, 20.0, 40.0, 80.0, 200.0)
"""Limits of the ranges [m] whose noise is measured together."""
_BLOCK: Final = 10  # messages in which a scene is still
_LEAST_RETURNS: Final = 5
_MOVING: Final = 1.35  # ratio of the variance to that of neighbours, above which a scene moves; noise has 1
_LEAST_CELLS: Final = 30
_MOST_SAMPLES: Final = 20_000


def arrays(stream: Stream, context: Context) -> Iterator[Measure]:
    """Yield difference, scale and noise of arrays."""
    for array in stream.arrays.values():
        empty = np.empty(0)
        if array.unit == "m":
            yield Measure(f"{array.name} at equal times", "m", "arrays", empty, array=array)
            yield Measure(f"scale of {array.name}", "", "arrays", empty, array=array, is_ratio=True)
        blocks = list(still_blocks(array, context.still))
        if not blocks:
            stream.notes.append(f"the scene is never still, so the noise of {array.name} is unknown")
            continue
        yield from _noise(array, blocks)


def still_blocks(array: ArrayOverTime, still: list[tuple[float, float]] | None) -> Iterator[tuple[Floats, Floats]]:
    """Yield mean and variance of the items with five or more returns, for each ten messages of a still scene."""
    chosen = np.ones(len(array.times), bool)
    if still is not None:
        chosen = np.zeros(len(array.times), bool)
        for start, end in still:
            chosen |= (array.times >= start) & (array.times <= end)
    rows = np.flatnonzero(chosen)
    for at in range(0, len(rows) - _BLOCK + 1, _BLOCK):
        part = rows[at : at + _BLOCK]
        if part[-1] - part[0] != _BLOCK - 1:
            continue
        block = array.values[part].astype(np.float64)
        block = block[:, np.isfinite(block).sum(axis=0) >= _LEAST_RETURNS]
        if block.shape[1] < _LEAST_CELLS:
            continue
        variance = np.nanvar(block, axis=0, ddof=1)
        steps = np.diff(block, axis=0)
        pairs = np.isfinite(steps).sum(axis=0)
        of_neighbours = np.where(pairs, np.nansum(steps**2, axis=0), np.nan) / (2.0 * np.maximum(pairs, 1))
        noisy = (variance > 0.0) & (pairs > 0)
        if noisy.any() and float(np.nanmedian(variance[noisy])) > _MOVING * float(np.nanmedian(of_neighbours[noisy])):
            continue
        yield np.nanmean(block, axis=0), variance


def _noise(array: ArrayOverTime, blocks: list[tuple[Floats, Floats]]) -> Iterator[Measure]:
    means = np.concatenate([mean for mean, _ in blocks])
    variances = np.concatenate([variance for _, variance in blocks])
    if array.unit != "m":
        yield Measure(f"noise of {array.name}", array.unit, "deviation", _thinned(variances))
        return
    for low, high in pairwise(RANGE_EDGES):
        inside = (means >= low) & (means < high)
        if np.count_nonzero(inside) >= _LEAST_CELLS:
            yield Measure(f"noise at {low:g} to {high:g} m", "m", "deviation", _thinned(variances[inside]))


def _thinned(samples: Floats) -> Floats:
    return samples[:: max(1, len(samples) // _MOST_SAMPLES)]
