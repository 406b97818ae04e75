"""Topics of gz's drives: an empty one is the default, one without a letter is an error."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from belt_worlds import GROUND, TRACKED, conveyor, tank, track_controller, world
from car_worlds import BASE, TRACK, car
from mecanum_worlds import mecanum
from plugin_worlds import rover

import simkit


def _diff_drive(inner: str) -> str:
    plugin = '<plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">'
    joints = "<left_joint>left_wheel</left_joint><right_joint>right_wheel</right_joint>"
    return rover(f"{plugin}{joints}{inner}</plugin>")


def _odometry(inner: str) -> str:
    plugin = '<plugin filename="gz-sim-odometry-publisher-system" name="gz::sim::systems::OdometryPublisher">'
    return rover(f"{plugin}{inner}</plugin>")


def _ackermann(inner: str) -> str:
    plugin = '<plugin filename="gz-sim-ackermann-steering-system" name="gz::sim::systems::AckermannSteering">'
    joints = (
        "<left_joint>rl_joint</left_joint><right_joint>rr_joint</right_joint>"
        "<left_steering_joint>fl_steering</left_steering_joint>"
        "<right_steering_joint>fr_steering</right_steering_joint>"
    )
    size = f"<wheel_base>{BASE}</wheel_base><wheel_separation>{TRACK}</wheel_separation>"
    return car(f"{plugin}{joints}{size}{inner}</plugin>")


def _mecanum(inner: str) -> str:
    return mecanum(settings=inner)


def _tank(inner: str) -> str:
    controllers = "".join(track_controller(f"{side}_track") for side in ("left", "right"))
    return tank(TRACKED.format(inner=inner) + controllers)


def _tank_side(inner: str) -> str:
    return _tank("").replace("<link>left_track</link></left_track>", f"<link>left_track</link>{inner}</left_track>")


Model = Callable[[str], str]
TOPICS: list[tuple[Model, str, str]] = [
    *((_diff_drive, f"{name}topic", f"/model/rover/{own}") for name, own in (("", "cmd_vel"), ("tf_", "tf"))),
    (_diff_drive, "odom_topic", "/model/rover/odometry"),
    (_odometry, "odom_topic", "/model/rover/odometry"),
    (_odometry, "odom_covariance_topic", "/model/rover/odometry_with_covariance"),
    (_odometry, "tf_topic", "/model/rover/pose"),
    *((_ackermann, f"{name}topic", f"/model/car/{own}") for name, own in (("", "cmd_vel"), ("tf_", "tf"))),
    (_ackermann, "odom_topic", "/model/car/odometry"),
    (_ackermann, "sub_topic", "/model/car/cmd_vel"),
    *((_mecanum, f"{name}topic", f"/model/robot/{own}") for name, own in (("", "cmd_vel"), ("tf_", "tf"))),
    (_mecanum, "odom_topic", "/model/robot/odometry"),
    *((_tank, f"{name}topic", f"/model/tank/{own}") for name, own in (("", "cmd_vel"), ("tf_", "tf"))),
    (_tank, "odom_topic", "/model/tank/odometry"),
    (_tank, "steering_efficiency_topic", "/model/tank/steering_efficiency"),
    (_tank_side, "velocity_topic", "/model/tank/link/left_track/track_cmd_vel"),
    (_tank_side, "center_of_rotation_topic", "/model/tank/link/left_track/track_cmd_center_of_rotation"),
    (conveyor, "velocity_topic", "/model/conveyor/link/belt/track_cmd_vel"),
    (conveyor, "center_of_rotation_topic", "/model/conveyor/link/belt/track_cmd_center_of_rotation"),
    (conveyor, "odometry_topic", "/model/conveyor/link/belt/odometry"),
]


@pytest.mark.parametrize(("model", "element", "default"), TOPICS)
def test_an_empty_topic_is_the_default_and_one_without_a_letter_an_error(
    model: Model, element: str, default: str
) -> None:
    with simkit.load(world(GROUND, model(f"<{element}/>"))) as sim:
        assert default in sim.topics()
        assert "/" not in sim.topics()
    for bad in ("/", "ü"):
        with pytest.raises(simkit.LoadError, match=f"found <{element}>{bad}</{element}>; expected a name"):
            simkit.load(world(GROUND, model(f"<{element}>{bad}</{element}>")))
