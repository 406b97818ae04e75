"""Click in a camera's picture: the goal of a head that turns the camera there, as TIAGo's look_to_point does."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np

from simkit import Pose
from simkit.bridges.live.request_fields import RequestRefused
from simkit.linear_algebra import norm
from simkit.run_spec import JsonObject

if TYPE_CHECKING:
    from simkit import Simulation
    from simkit.extend import GoalHandle, Sensor

POINT_HEAD: Final = "control_msgs/action/PointHead"
_DISTANCE: Final = 1.0  # [m] from the camera to the point, as in PAL's tutorial
_SHORTEST: Final = {"sec": 1, "nanosec": 0}  # of the motion
_FASTEST: Final = 1.0  # [rad/s]


def point_camera(sim: Simulation, name: str, across: float, down: float) -> GoalHandle:
    """Send the goal of a head that looks at what a pixel shows.

    Args:
        sim: simulation.
        name: scoped name of the camera.
        across: place in the picture from the left, 0 to 1.
        down: place in the picture from the top, 0 to 1.

    Raises:
        RequestRefused: there is no such camera, no head that moves, or the place is outside the picture.
    """
    sensor = sim.contents.sensors.get(name)
    if sensor is None or not hasattr(sensor.options, "model"):
        raise RequestRefused(f"there is no camera {name!r:.80}")
    if not (0 <= across <= 1 and 0 <= down <= 1):
        raise RequestRefused(f"the place ({across:g}, {down:g}) is outside the picture, which reaches from 0 to 1")
    return sim.send_goal(_action(sim, sensor), _goal(sim, sensor, across, down))


def _action(sim: Simulation, sensor: Sensor) -> str:
    """Return the action of the head; of several, the one with the name of the camera's robot."""
    names = [name for name, kind in sim.communication.actions.names().items() if kind == POINT_HEAD]
    if not names:
        raise RequestRefused("no head of this world takes goals: there is no action of the type PointHead")
    robot = sensor.scoped.split("::", 1)[0]
    return next((name for name in names if robot in name.split("/")), names[0])


def _goal(sim: Simulation, sensor: Sensor, across: float, down: float) -> JsonObject:
    """Return the goal: the point 1 m away on the ray of a pixel, and the camera's axis, both in a frame of the head."""
    camera: Any = getattr(sensor.options, "model")  # noqa: B009 - the options of all cameras with one picture have it
    y = (down * camera.height - camera.cy) / camera.fy
    x = (across * camera.width - camera.cx - camera.skew * y) / camera.fx
    ray = np.array((1.0, -x, -y))  # the picture's right and bottom are the sensor's -y and -z
    eye = sensor.pose
    frame, pose = _head_frame(sim, sensor)
    inverse = pose.inverse()
    point = inverse.transform(eye.transform(ray * (_DISTANCE / norm(ray))))
    axis = inverse.rotate(eye.rotate((1.0, 0.0, 0.0)))
    return {
        "target": {"header": {"frame_id": frame}, "point": _xyz(point)},
        "pointing_frame": frame,
        "pointing_axis": _xyz(axis),
        "min_duration": _SHORTEST,
        "max_velocity": _FASTEST,
    }


def _head_frame(sim: Simulation, sensor: Sensor) -> tuple[str, Pose]:
    """Return the frame of the camera's messages if it is a link of the robot, or else the camera's own link."""
    robot = sensor.scoped.split("::", 1)[0]
    links = sim.model(robot).links
    wanted = getattr(sensor, "optical_frame_id", "") or sensor.frame_id
    own = sensor.scoped.split("::")[-2]
    name = wanted if wanted in links else own
    return name, links[name].pose


def _xyz(vector: object) -> dict[str, float]:
    return dict(zip("xyz", np.asarray(vector, np.float64).tolist(), strict=True))
