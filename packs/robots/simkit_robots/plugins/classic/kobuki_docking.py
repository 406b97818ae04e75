"""Infrared signals between a docking station and a Kobuki base, which Gazebo's plugin does not have.

The regions of the station (left, middle and right, each near and far), the order of the receivers (right, middle, left)
and the meaning of left and right are those of `dock_drive_states.cpp` in kobuki_core: a robot is in the left region if
it must turn left from its view at the station, to get to the middle. Angles and ranges are not published; the defaults
are simkit's own.
"""

from __future__ import annotations

import math
from typing import Final

from simkit import Pose
from simkit.extend import Options, number, text
from simkit.pose import wrap_angle

RECEIVERS: Final = (-math.pi / 3, 0.0, math.pi / 3)
"""Directions of the right, the middle and the left receiver about the robot's z axis [rad]."""
_RADIUS: Final = 0.17  # of the receivers around the robot's origin [m]
_VIEW: Final = math.radians(35)  # half of the field of view of a receiver [rad]
_NEAR_BITS: Final = {"left": 1, "center": 2, "right": 4}  # constants of DockInfraRed
_FAR_BITS: Final = {"left": 16, "center": 8, "right": 32}
_OVERLAP: Final = 0.5  # the side regions begin at this part of the angle of the middle region
_OVERLAP_OF_RANGES: Final = 0.9  # the far fields begin at this part of the near range
_REACH: Final = 0.178  # from the robot's origin to its front [m]
_GAP: Final = 0.02  # the contacts of the station are closed within this distance from its front [m]
_ASIDE: Final = 0.02, math.radians(10)  # largest distance [m] and angle [rad] from the axis of the station
CHARGING: Final = 6  # DOCKING_CHARGING of SensorState


class KobukiDockOptions(Options):
    """Options of the docking station. Its front is the origin of the model, and the model's x axis points out of it."""

    dock_model: str = text()
    dock_near_range: float = number(0.6, "m", minimum=0)
    dock_far_range: float = number(3.0, "m", minimum=0)
    dock_center_angle: float = number(math.radians(10), "rad", minimum=0, maximum=math.pi / 2)
    dock_field_angle: float = number(math.radians(45), "rad", minimum=0, maximum=math.pi)


def signals(robot: Pose, options: KobukiDockOptions) -> list[int]:
    """Return the signals that the right, the middle and the left receiver get.

    Args:
        robot: pose of the robot in the frame of the station.
        options: ranges and angles of the station.
    """
    heading = float(robot.rpy[2])
    received = []
    for direction in RECEIVERS:
        x, y, _ = robot.transform((_RADIUS * math.cos(direction), _RADIUS * math.sin(direction), 0.0)).tolist()
        bearing = wrap_angle(math.atan2(-y, -x) - heading - direction)
        received.append(_signal(math.hypot(x, y), math.atan2(y, x), options) if abs(bearing) <= _VIEW else 0)
    return received


def _signal(distance: float, angle: float, options: KobukiDockOptions) -> int:
    """Return the signal at a place, by its distance from the station [m] and its angle about the station's z [rad]."""
    regions = []
    if abs(angle) <= options.dock_center_angle:
        regions.append("center")
    if _OVERLAP * options.dock_center_angle <= abs(angle) <= options.dock_field_angle:
        regions.append("left" if angle > 0 else "right")
    near, far = options.dock_near_range, options.dock_far_range
    bits = 0
    for region in regions:
        bits |= _NEAR_BITS[region] if distance <= near else 0
        bits |= _FAR_BITS[region] if _OVERLAP_OF_RANGES * near <= distance <= far else 0
    return bits


def is_docked(robot: Pose) -> bool:
    """Check whether the contacts of the station touch those of the robot.

    Args:
        robot: pose of the robot in the frame of the station.
    """
    x, y, _ = robot.position.tolist()
    error = wrap_angle(float(robot.rpy[2]) - math.pi)
    largest, angle = _ASIDE
    return abs(y) <= largest and abs(error) <= angle and x - _REACH <= _GAP
