"""Lab 12: the filters of the solution against the truth; the picture of its README shows them."""

from __future__ import annotations

import math
import runpy
import shutil
from pathlib import Path
from typing import Any, NamedTuple

import cv2
import numpy as np
import numpy.typing as npt
import pytest

import simkit

LAB = Path(__file__).parents[2] / "labs" / "12_sensors_and_time"
Vector = npt.NDArray[np.float64]
DENSITY, WALK = 5e-4, 1e-2  # of `table.sdf`

NODE = """<plugin filename="libsimkit_robot_localization.so" name="ekf_filter_node">
  <ros><remapping>odometry/filtered:=ekf/odometry</remapping></ros>
  <two_d_mode>true</two_d_mode><publish_tf>false</publish_tf>
  <odom0>odom</odom0><odom0_config>0 0 0  0 0 0  1 1 0  0 0 0  0 0 0</odom0_config>
  <imu0>imu</imu0><imu0_config>0 0 0  0 0 0  0 0 0  0 0 1  0 0 0</imu0_config></plugin>"""


class Drive(NamedTuple):
    """Paths of a drive: the true one and one for each topic, shape (n, 2) [m]."""

    true: Vector
    estimates: dict[str, Vector]

    def error(self, topic: str) -> float:
        """Return the root mean square of the position error [m]."""
        return math.sqrt(np.square(self.estimates[topic] - self.true).sum(axis=1).mean())


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    """Return a folder with the solved lab."""
    folder = tmp_path / "lab"
    shutil.copytree(LAB, folder, ignore=shutil.ignore_patterns("solution", "__pycache__"))
    shutil.copytree(LAB / "solution", folder, dirs_exist_ok=True, ignore=shutil.ignore_patterns("__pycache__"))
    return folder


def driven(lab: Path, topics: tuple[str, ...], seed: int, seconds: float = 38.0) -> Drive:
    with simkit.load(lab / "rover.sdf", plugin_paths=[lab], seed=seed) as sim:
        found = {topic: sim.subscribe(topic, keep=1) for topic in topics}
        rows = []
        sim.run(0.5)
        start = sim.model("rover").pose
        while sim.time < seconds:
            sim.run(0.1)
            places = [found[topic].latest.pose.pose.position for topic in topics]
            rows.append(
                [*(start.inverse() @ sim.model("rover").pose).position[:2]] + [v for p in places for v in (p.x, p.y)]
            )
    table = np.array(rows)
    return Drive(table[:, :2], {topic: table[:, 2 * k + 2 : 2 * k + 4] for k, topic in enumerate(topics)})


@pytest.mark.labs
def test_the_filters_and_the_picture_of_them(lab: Path, tmp_path: Path) -> None:
    """To renew the picture, copy the file that the failure names."""
    pyplot = pytest.importorskip("matplotlib.pyplot")
    figure, (left, middle, right) = pyplot.subplots(1, 3, figsize=(10, 3.4), constrained_layout=True)
    draw_deviation(left, lab)
    draw_tilt(middle, lab)
    drive = driven(lab, ("/odom", "/odometry/filtered"), seed=3)
    assert drive.error("/odom") > 1.0
    assert drive.error("/odometry/filtered") < drive.error("/odom") / 2
    for label, path, style in (
        ("truth", drive.true, "k-"),
        ("odometry", drive.estimates["/odom"], "r-"),
        ("filter", drive.estimates["/odometry/filtered"], "b--"),
    ):
        right.plot(*path.T, style, lw=1.5, label=label)
    right.set(title="path of the rover", xlabel="x [m]", ylabel="y [m]", aspect="equal")
    for panel in (left, middle, right):
        panel.legend(fontsize=8)
    picture = tmp_path / "filters.png"
    figure.savefig(picture, dpi=90)
    pyplot.close(figure)
    shown, drawn = (cv2.imread(str(file)) for file in (LAB / "filters.png", picture))
    assert shown is not None and shown.shape == drawn.shape, picture
    difference = np.abs(shown.astype(float) - drawn).max(axis=2) > 100
    assert difference.mean() < 0.003, picture


def draw_deviation(panel: Any, lab: Path) -> None:
    with simkit.load(lab / "table.sdf", plugin_paths=[lab], seed=3) as sim:
        rates: list[float] = []
        sim.subscribe("/imu", lambda message: rates.append(message.angular_velocity.z))
        figures = [sim.subscribe(f"/allan/{name}", keep=1) for name in ("noise_density", "random_walk")]
        sim.run(200.0)
        for found, true in zip(figures, (DENSITY, WALK), strict=True):
            assert found.latest.data == pytest.approx(true, rel=0.1)
    sizes = np.unique(np.geomspace(1, 500, 40).astype(int))
    times = sizes / 50.0
    deviation = runpy.run_path(str(LAB / "solution" / "allan.py"))["deviation"]
    panel.loglog(times, deviation(np.array(rates), 50.0, sizes), "b-", lw=2, label="measured")
    panel.loglog(times, np.sqrt(DENSITY**2 / times + WALK**2 * times / 3), "k--", lw=1, label="theory")
    panel.set(title="gyroscope at rest", xlabel="averaging time [s]", ylabel="Allan deviation [rad/s]")


def draw_tilt(panel: Any, lab: Path) -> None:
    with simkit.load(lab / "pendulum.sdf", plugin_paths=[lab]) as sim:
        rows, alone = [], 0.5
        imu, tilt = sim.subscribe("/imu", keep=1), sim.subscribe("/tilt", keep=1)
        while sim.time < 12.0:
            sim.run(0.008)
            reading = imu.latest
            alone += reading.angular_velocity.y * 0.008
            accelerometer = math.atan2(-reading.linear_acceleration.x, reading.linear_acceleration.z)
            true = sim.link("pendulum::rod").pose.rpy[1]
            rows.append((sim.time, true, accelerometer, alone, tilt.latest.data))
    times, true, *others = np.array(rows).T
    errors = [math.sqrt(np.square(other - true).mean()) for other in others]
    assert errors[2] < 0.5 * min(errors[:2])
    first = times < 4.0
    panel.plot(times[first], others[0][first], color="0.8", lw=0.8, label="accelerometer")
    panel.plot(times[first], true[first], "k-", lw=1.5, label="truth")
    panel.plot(times[first], others[2][first], "b--", lw=1.5, label="filter")
    panel.set(title="tilt of the pendulum", xlabel="time [s]", ylabel="tilt [rad]", ylim=(-1.1, 0.7))


@pytest.mark.labs
def test_ekf_node_halves_the_error_of_the_odometry_with_a_gyroscope_without_bias(lab: Path) -> None:
    """The state of `ekf_node` has no bias; question 2 of the lab is about this."""
    world = lab / "rover.sdf"
    text = (
        world.read_text("utf-8")
        .replace("<bias_mean>0.02</bias_mean>", "")
        .replace("<bias_stddev>0.01</bias_stddev>", "")
    )
    world.write_text(text.replace("</world>", f"{NODE}</world>"), "utf-8")
    drive = driven(lab, ("/odom", "/ekf/odometry"), seed=1, seconds=22.0)
    assert drive.error("/ekf/odometry") < drive.error("/odom") / 2
