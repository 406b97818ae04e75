"""Streams whose bits differ by less than a golden keeps."""

from __future__ import annotations

import math

from simkit.golden.difference import Difference
from simkit.golden.record import Stream
from simkit.golden.units import quantity, unit_of


def difference_in_bits(golden: Stream, run: Stream) -> Difference:
    """`bits differ from t in 3–4 s, by less than 31 µm`: found by the hashes of each second."""
    both = min(len(golden.chunks), len(run.chunks))
    second = next((i for i in range(both) if golden.chunks[i] != run.chunks[i]), both)
    times = run.times_ns
    first = next((i for i, t in enumerate(times.tolist()) if t >= second * 1_000_000_000), -1)
    words = f"{run.topic}: bits differ from t in {second}–{second + 1} s"
    rounding = rounding_of(golden)
    if golden.pictures is not None or any(path.startswith("points.") for path in golden.columns):
        words += ", in what a golden does not keep"
    elif rounding:
        words += f", by less than {rounding}"
    time = float(times[first]) * 1e-9 if first >= 0 else float(second)
    return Difference(run.topic, "", "bits", time, math.nan, "", words, "the same bits", first)


def rounding_of(stream: Stream) -> str:
    """What numbers of a stream are rounded to, in words: `31 µm of ranges`; "" where nothing is."""
    steps = {path: column.step for path, column in stream.columns.items() if column.step}
    if not steps:
        return ""
    by_unit: dict[str, tuple[float, str]] = {}
    for path, step in steps.items():
        unit = unit_of(stream.type_name, path)
        by_unit[unit] = max(by_unit.get(unit, (0.0, "")), (step / 2.0, path))
    told = [quantity(step, unit, signed=False) for unit, (step, _) in sorted(by_unit.items(), key=lambda i: i[0])]
    return ", ".join(told[:3])
