"""Text lines that a driver sees: speed, pose and the nearest obstacle."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final, cast

import numpy as np
import numpy.typing as npt

from simkit.cli.terminal.teleop import Teleop
from simkit.pose import Pose, quat_rotate

if TYPE_CHECKING:
    from simkit.runtime import Link, Model, Simulation
    from simkit.sensors.base import Sensor

Vector = npt.NDArray[np.float64]
_DRIVE_HELP: Final = "w/x faster/slower   a/d left/right   s stop   q/z all speeds ±10 %"
_HOLONOMIC_HELP: Final = "w/x faster/slower   a/d left/right   j/l sideways   s stop   q/z all ±10 %"
_RUN_HELP: Final = "space pause   n step   Ctrl-C ends"
_SCAN: Final = "sensor_msgs/msg/LaserScan"


class DriverLine:
    """Words about what a `Teleop` drives. Whatever it reads is read at the moment, and changes nothing.

    Args:
        sim: the simulation.
        teleop: the commands.
    """

    def __init__(self, sim: Simulation, teleop: Teleop) -> None:
        self._sim, self._teleop = sim, teleop

    def lines(self) -> list[str]:
        """The line, what was asked for, and the keys."""
        return [self.text(), self.asked(), _HOLONOMIC_HELP if self._teleop.target.sideways else _DRIVE_HELP, _RUN_HELP]

    def text(self) -> str:
        """Speed, pose, nearest obstacle; of what is not known nothing."""
        model = self._model()
        if model is None:
            return f"driving {self._teleop.target.topic}"
        pose = model.pose
        yaw = math.degrees(float(pose.rpy[2]))
        place = f"x {pose.position[0]:.2f}  y {pose.position[1]:.2f}  {yaw:.0f}°"
        parts = [self._speed_text(*_velocity(model, pose)), place, self._obstacle_text(model, pose)]
        return "   ".join(part for part in parts if part)

    def asked(self) -> str:
        """The speeds that were asked for, or why they do not go out."""
        teleop = self._teleop
        if teleop.fault:
            return teleop.fault
        return f"asked {self._speed_text(*teleop.speeds)}" + (
            ", stopped since no key came" if teleop.is_expired else ""
        )

    def _speed_text(self, ahead: float, left: float, turn: float) -> str:
        sideways = f", {left:.2f} m/s left" if self._teleop.target.sideways else ""
        return f"{ahead:.2f} m/s{sideways}, {turn:.2f} rad/s"

    def _model(self) -> Model | None:
        """Return the model that is driven, while it exists."""
        name = self._teleop.target.model
        if not name:
            return None
        try:
            return self._sim.model(name)
        except KeyError:
            return None

    def _obstacle_text(self, model: Model, base: Pose) -> str:
        """The nearest of what the robot's lidars see, and in which direction from the robot; empty without a lidar."""
        found = [
            near
            for sensor in self._sim.contents.sensors.values()
            if sensor.scoped.startswith(f"{model.scoped}::") and (near := nearest_reading(sensor)) is not None
        ]
        if not found:
            return ""
        distance, direction, pose, least = min(found, key=lambda one: one[0])
        if distance == math.inf:
            return "nothing near"
        reach = least if distance == -math.inf else distance
        point = pose.position + _rotate(pose, reach * np.array([math.cos(direction), math.sin(direction), 0.0]))
        off = _rotate(base.inverse(), point - base.position)
        where = _side_text(math.degrees(math.atan2(off[1], off[0])))
        if distance == -math.inf:
            return f"nearest below {least:.2f} m, {where}"
        return f"nearest {distance:.2f} m, {where}"


def nearest_reading(sensor: Sensor) -> tuple[float, float, Pose, float] | None:
    """The shortest reading of a lidar [m] (infinite for nothing in reach, minus infinite for something too near), its
    angle about the sensor's z [rad], the sensor's pose and its shortest range [m]; None of other sensors, or before
    the first scan."""
    scan = sensor.latest
    if scan is None or getattr(scan, "__msgtype__", "") != _SCAN:
        return None
    ranges = np.asarray(scan.ranges, dtype=float)
    ranges = np.where(np.isnan(ranges), math.inf, ranges)
    if ranges.size == 0:
        return None
    index = int(ranges.argmin())
    step = float(scan.angle_increment)
    beams = round((scan.angle_max - scan.angle_min) / step) + 1 if step else 1  # of one layer
    return float(ranges[index]), scan.angle_min + index % beams * step, sensor.pose, float(scan.range_min)


def _velocity(model: Model, pose: Pose) -> tuple[float, float, float]:
    """Speed ahead and to the left [m/s] and turning about the vertical [rad/s], in the model's heading."""
    link = next(iter(model.links.values()), None)
    canonical = model.scene.canonical_link
    for one in model.everything():
        if one.scoped == canonical:
            link = cast("Link", one)
    if link is None:
        return 0.0, 0.0, 0.0
    yaw = float(pose.rpy[2])
    arm = pose.position - link.pose.position
    vx, vy, _ = (float(v) for v in link.linear_velocity + np.cross(link.angular_velocity, arm))
    ahead, left = vx * math.cos(yaw) + vy * math.sin(yaw), vy * math.cos(yaw) - vx * math.sin(yaw)
    values = (ahead, left, float(link.angular_velocity[2]))
    return tuple(0.0 if abs(v) < 0.005 else v for v in values)  # type: ignore[return-value]  # no "-0.00"


def _rotate(pose: Pose, vector: Vector) -> Vector:
    return quat_rotate(pose.quaternion, vector)


def _side_text(degrees: float) -> str:
    if abs(degrees) < 10:
        return "ahead"
    if abs(degrees) > 170:
        return "behind"
    return f"{abs(degrees):.0f}° {'left' if degrees > 0 else 'right'}"
