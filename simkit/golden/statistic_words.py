"""Statistics that are other, in words."""

from __future__ import annotations

import math

from simkit.golden.difference import Difference
from simkit.golden.record import Stream
from simkit.golden.statistics import Deviance, Statistics
from simkit.golden.units import quantity, unit_of, value_in_words


def difference_of(deviance: Deviance, run: Stream, path: str, golden: Statistics, other: Statistics) -> Difference:
    """`/imu.angular_velocity.x: noise's deviation 0.0002 rad/s became 0.00024 rad/s (+20 %) in 6000 samples`.

    Args:
        deviance: what is other.
        run: the stream.
        path: of its field.
        golden, other: statistics of it; the run's are the other ones.
    """
    unit = unit_of(run.type_name, path)
    place = f"[{deviance.component}]" if golden.mean.size > 1 else ""
    counts = f"{other.count}" if other.count == golden.count else f"{golden.count} and {other.count}"
    samples = f"in {counts} samples"
    a, b = value_in_words(deviance.golden, unit, 4), value_in_words(deviance.run, unit, 4)
    size, allowed = abs(deviance.run - deviance.golden), ""
    if deviance.what == "count":
        said = f"{deviance.golden:g} samples of the noise became {deviance.run:g}"
        unit, allowed = "samples", "enough samples on both sides"
    elif deviance.what == "mean":
        said = f"the noise's mean {a} became {b} {samples}"
        allowed = f"{quantity(deviance.limit, unit, signed=False)} by chance"
    elif deviance.what == "distribution":
        at = value_in_words(deviance.at, unit, 3)
        said = f"{100 * deviance.golden:.1f} % of the noise below {at} from its mean became {100 * deviance.run:.1f} %"
        said += f" {samples}: another distribution"
        allowed, unit = f"{100 * deviance.limit:.2g} % by chance", ""
    else:
        what = "deviation" if deviance.what == "deviation" else f"Allan deviation over {deviance.at:g} s"
        said = f"the noise's {what} {a} became {b}{_percent(deviance)} {samples}"
        allowed = f"{100 * (deviance.limit - 1):.2g} % by chance"
    time = float(run.times_ns[0]) * 1e-9 if len(run.times_ns) else 0.0
    words = f"{run.topic}.{path}{place}: {said}"
    return Difference(run.topic, path, "statistics", time, size, unit, words, allowed)


def _percent(deviance: Deviance) -> str:
    if not deviance.golden or not math.isfinite(deviance.run / deviance.golden):
        return ""
    percent = 100.0 * (deviance.run / deviance.golden - 1.0)
    return f" ({percent:+.3g} %)".replace("-", "−")
