"""Lab 11: step responses of the solution agree with theory; the picture of its README shows both."""

from __future__ import annotations

import math
import runpy
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import numpy.typing as npt
import pytest

import simkit

LAB = Path(__file__).parents[2] / "labs" / "11_control"
Vector = npt.NDArray[np.float64]
MASS, BRAKE, WEIGHT = 2.0, 4.0, 2.0 * 9.8 * math.sin(0.1)  # [kg], [N s/m], [N]


class World:
    """The lift with a controller, and the true position of the carriage at each millisecond."""

    def __init__(self, tmp_path: Path, change: tuple[str, str] = ("", "")) -> None:
        for file in (LAB / "lift.sdf", LAB / "referee.py"):
            (tmp_path / file.name).write_bytes(file.read_bytes())
        text = (LAB / "solution" / "pid.py").read_text("utf-8").replace(*change) if change[0] else None
        (tmp_path / "pid.py").write_text(text or (LAB / "solution" / "pid.py").read_text("utf-8"), "utf-8")
        steps = runpy.run_path(str(LAB / "referee.py"))["STEPS"]
        self.begins = [time for time, _, _ in steps[:-1]]
        with simkit.load(tmp_path / "lift.sdf", plugin_paths=[tmp_path]) as sim:
            topics = [f"/referee/step_{k}/{name}" for k in (1, 2, 3, 4) for name in ("rise_time", "overshoot")]
            found = {name: sim.subscribe(name, keep=1) for name in topics}
            joint, positions = sim.joint("lift::slide"), []
            while sim.time < 24.5:
                sim.step(5)
                positions.append(joint.position)
            self.results = {name: sub.latest.data for name, sub in found.items()}
        self.positions = np.array(positions)
        self.times = np.arange(1, len(positions) + 1) * 0.005

    def response(self, k: int) -> tuple[Vector, Vector]:
        """Return times after the step k [s] and the response, from 0 to about 1."""
        is_in = (self.times >= self.begins[k]) & (self.times < self.begins[k] + 2.99)
        positions = self.positions[is_in]
        return self.times[is_in] - self.begins[k], (positions - positions[0]) / (positions[-1] - positions[0])


def theory(times: Vector, kp: float, kd: float) -> Vector:
    """Return the step response of the closed loop with a PD controller."""
    natural, damping = math.sqrt(kp / MASS), (BRAKE + kd) / (2 * math.sqrt(kp * MASS))
    damped = natural * math.sqrt(1 - damping**2)
    decay = np.exp(-damping * natural * times) / math.sqrt(1 - damping**2)
    return 1.0 - decay * np.sin(damped * times + math.acos(damping))


GAINS = [(128.0, 12.0), (288.0, 15.2)]


@pytest.mark.labs
def test_the_whole_step_response_is_that_of_the_theory_and_the_picture_shows_it(tmp_path: Path) -> None:
    """To renew the picture, copy the file that the failure names."""
    pyplot = pytest.importorskip("matplotlib.pyplot")
    solved = World(tmp_path)
    for k, gains in enumerate(GAINS):
        times, response = solved.response(k)
        np.testing.assert_allclose(response, theory(times, *gains), atol=0.01)  # of the step
        kp, kd = gains
        damping = (BRAKE + kd) / (2 * math.sqrt(kp * MASS))
        overshoot = math.exp(-math.pi * damping / math.sqrt(1 - damping**2))
        assert solved.results[f"/referee/step_{k + 1}/overshoot"] == pytest.approx(overshoot, rel=0.05)
    (tmp_path / "wound").mkdir()
    wound = World(tmp_path / "wound", ("if force == wanted:", "if True:"))
    picture = tmp_path / "responses.png"
    draw(pyplot, solved, wound, picture)
    shown, drawn = (cv2.imread(str(file)) for file in (LAB / "responses.png", picture))
    assert shown is not None and shown.shape == drawn.shape, picture
    difference = np.abs(shown.astype(float) - drawn).max(axis=2) > 100
    assert difference.mean() < 0.002, picture  # one curve has 0.4 % of the pixels


def draw(pyplot: Any, solved: World, wound: World, picture: Path) -> None:
    figure, axes = pyplot.subplots(1, 3, figsize=(10, 3.2), constrained_layout=True)
    for k, (panel, gains) in enumerate(zip(axes, GAINS, strict=False)):
        times, response = solved.response(k)
        panel.plot(times, response, color="tab:orange", lw=3, label="simulation")
        panel.plot(times, theory(times, *gains), "k--", lw=1, label="theory")
        panel.set(
            title="designed gains" if k == 0 else "gains set on line", xlim=(0, 1.2), xlabel="time after the step [s]"
        )
    axes[0].set_ylabel("position, as a share of the step")
    for world, label, colour in ((wound, "integral winds up", "tab:red"), (solved, "integral waits", "tab:orange")):
        axes[2].plot(*world.response(3), color=colour, lw=2, label=label)
    axes[2].set(title="a step beyond the motor's limit", xlim=(0, 2.5), xlabel="time after the step [s]")
    for panel in axes:
        panel.axhline(1.0, color="grey", lw=0.6)
        panel.set_ylim(0, 1.75)
        panel.legend(loc="lower right", fontsize=8)
    figure.savefig(picture, dpi=90)
    pyplot.close(figure)
