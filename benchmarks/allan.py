"""The Allan deviation of an IMU at rest for one simulated hour gives back what its data sheet was told to be.

Prints density N and bias instability B of every axis beside those of the file, and draws the curves.

    python benchmarks/allan.py [--hours 1] [--out docs/images/sensors/allan.png]
"""

from __future__ import annotations

import argparse
import math
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import simkit
from simkit.sensors.bias_drift import ALLAN_FLOOR

Values = npt.NDArray[np.float64]
RATE = 100  # [Hz]
MOST = 0.10
"""Greatest relative error that is let pass."""

# [unit/√Hz], [unit], [unit/√s] of a cheap MEMS unit, whose floor can be told from an hour
GYRO = {"noise_density": 2.0e-4, "bias_instability": 2.0e-4, "random_walk": 0.0}  # rad/s
ACCELEROMETER = {"noise_density": 2.0e-3, "bias_instability": 1.0e-3, "random_walk": 4.0e-5}  # m/s²


def world(rate: float = RATE) -> str:
    """An IMU that lies still, one step a reading."""

    def axes(sheet: dict[str, float]) -> str:
        words = "".join(f"<{name}>{value}</{name}>" for name, value in sheet.items())
        return "".join(f'<{axis}><noise type="gaussian">{words}</noise></{axis}>' for axis in "xyz")

    return f"""<sdf version="1.9"><world name="w">
      <physics name="p" type="ode"><max_step_size>{1 / rate}</max_step_size></physics>
      <model name="m"><static>true</static><link name="l"><sensor name="imu" type="imu">
        <topic>imu</topic><update_rate>{rate}</update_rate><imu>
        <angular_velocity>{axes(GYRO)}</angular_velocity>
        <linear_acceleration>{axes(ACCELEROMETER)}</linear_acceleration></imu>
      </sensor></link></model></world></sdf>"""


def readings(sim: Any, duration: float) -> Values:
    """Rates [rad/s] and specific forces [m/s²] of `duration` [s], shape (samples, 6)."""
    sub, out, stretch = sim.subscribe("/imu", keep=60 * RATE), [], 60.0
    for _ in range(round(duration / stretch)):
        sim.run(stretch)
        for message in sub.messages:
            w, a = message.angular_velocity, message.linear_acceleration
            out.append((w.x, w.y, w.z, a.x, a.y, a.z))
    return np.array(out)


def allan_deviation(values: Values, rate: float, clusters: npt.NDArray[np.int64]) -> Values:
    """The overlapping Allan deviation, one column a channel.

    Half the mean square of the difference between the means of two neighbouring clusters of n readings, over all
    places of the pair (IEEE Std 952-1997, annex C; W. J. Riley, NIST Special Publication 1065, 5.2.5).

    Args:
        values: readings, shape (samples, channels).
        rate: [Hz].
        clusters: n of each averaging time n/rate.
    """
    angle = np.concatenate((np.zeros((1, values.shape[1])), np.cumsum(values, axis=0))) / rate
    out = []
    for n in clusters:
        pairs = angle[2 * n :] - 2 * angle[n:-n] + angle[: -2 * n]
        out.append(np.sqrt(np.square(pairs).mean(axis=0) / 2) * rate / n)
    return np.array(out)


def fit(times: Values, deviation: Values, duration: float) -> tuple[float, float, float]:
    """N, B and K of σ²(τ) = N²/τ + (0.664·B)² + K²·τ/3 (IEEE Std 952-1997, annex C), least squares.

    Each point counts by how well it is known: its variance to about √(τ/duration) of itself.
    """
    terms = np.stack((1 / times, np.full_like(times, ALLAN_FLOOR**2), times / 3), axis=1)
    weight = np.sqrt(duration / times) / deviation**2
    n2, b2, k2 = np.linalg.lstsq(terms * weight[:, None], np.sqrt(duration / times), rcond=None)[0]
    if k2 < 0:  # none that can be told
        (n2, b2), k2 = np.linalg.lstsq(terms[:, :2] * weight[:, None], np.sqrt(duration / times), rcond=None)[0], 0.0
    n, b, k = (math.sqrt(max(0.0, x)) for x in (n2, b2, k2))
    return n, b, k


def draw(times: Values, deviation: Values, out: Path) -> None:
    """The curves beside what they should be."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, both = pyplot.subplots(1, 2, figsize=(10, 4.2), constrained_layout=True)
    sides = (("gyroscope", "rad/s", GYRO), ("accelerometer", "m/s²", ACCELEROMETER))
    for i, (axes, (name, unit, sheet)) in enumerate(zip(both, sides, strict=True)):
        for j, axis in enumerate("xyz"):
            axes.loglog(times, deviation[:, 3 * i + j], lw=1, label=axis)
        n, b, k = sheet["noise_density"], sheet["bias_instability"], sheet["random_walk"]
        total = np.sqrt(n**2 / times + (ALLAN_FLOOR * b) ** 2 + k**2 * times / 3)
        axes.loglog(times, total, "k--", lw=1.2, label="data sheet")
        axes.axhline(ALLAN_FLOOR * b, color="grey", lw=0.8, ls=":")
        axes.annotate(
            f"0.664 · B, B = {b:g} {unit}", (times[0], ALLAN_FLOOR * b), textcoords="offset points", xytext=(0, 4)
        )
        axes.annotate(
            f"N = {n:g} {unit}/√Hz", (times[4], n / math.sqrt(times[4])), textcoords="offset points", xytext=(8, 2)
        )
        axes.set(title=name, xlabel="averaging time τ [s]", ylabel=f"Allan deviation [{unit}]")
        axes.grid(which="both", alpha=0.25)
        axes.legend()
    out.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(out, dpi=110)
    print(f"wrote {out}")


def main(hours: float, out: Path | None, seed: int = 1) -> bool:
    """Whether every N and B came back within `MOST`."""
    begin, duration = time.process_time(), 3600.0 * hours
    with simkit.load(world(), seed=seed) as sim:
        values = readings(sim, duration)
    print(f"{len(values)} readings of {duration:g} s in {time.process_time() - begin:.1f} s")
    clusters = np.unique(np.geomspace(1, len(values) // 9, 60).astype(np.int64))
    times = clusters / RATE
    deviation = allan_deviation(values, RATE, clusters)
    is_right = True
    for channel in range(6):
        sheet = (GYRO, ACCELEROMETER)[channel // 3]
        n, b, _ = fit(times, deviation[:, channel], duration)
        errors = n / sheet["noise_density"] - 1, b / sheet["bias_instability"] - 1
        is_right = is_right and max(map(abs, errors)) <= MOST
        name = f"{('gyroscope', 'accelerometer')[channel // 3]} {'xyz'[channel % 3]}"
        print(f"{name:16s} density N {n:.4g} ({errors[0]:+.1%})   bias instability B {b:.4g} ({errors[1]:+.1%})")
    if out is not None:
        draw(times, deviation, out)
    return is_right


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--hours", type=float, default=1.0, help="of simulated time")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path, default=None, help="PNG file for the curves")
    chosen = parser.parse_args()
    sys.exit(0 if main(chosen.hours, chosen.out, chosen.seed) else 1)
