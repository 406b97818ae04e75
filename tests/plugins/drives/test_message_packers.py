"""Packers return the bytes of the messages that the functions beside them make of the same arguments."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest

from simkit import msgs
from simkit.msgs.cdr_template import PACKERS
from simkit.plugins.drives.odometry import planar_covariance
from simkit.plugins.drives.odometry_messages import (
    BodyTwist,
    PlanarPose,
    odometry_message,
    planar_odometry,
    planar_transform,
    transforms,
)
from simkit.plugins.joint_states import joint_state_message
from simkit.plugins.world.clock_and_statistics import clock_message
from simkit.pose import Pose
from simkit.runtime.communication.subscription import LazyMessage

_TIME = 12_000_000_345
_POSE = Pose((1.0, -2.0, 0.5), (0.5, 0.5, -0.5, 0.5))
_TWIST = BodyTwist((0.1, 0.2, 0.3), np.array((4.0, 5.0, 6.0)))
_COVARIANCES = planar_covariance(1e-5, 2e-5, 1e-3), planar_covariance(3.0, 4.0, 5.0)
_CASES = (
    partial(odometry_message, _TIME, "odom", "base", _POSE, _TWIST),
    partial(odometry_message, _TIME, "odom", "base_footprint", _POSE, _TWIST, *_COVARIANCES),
    partial(odometry_message, _TIME, "", "", PlanarPose(1.0, 2.0, 0.5), _TWIST, _COVARIANCES[0]),
    partial(transforms, _TIME),
    partial(transforms, _TIME, ("odom", "base", _POSE), ("base", "wheel", lambda: _POSE)),
    partial(planar_odometry, _TIME, "odom", "base", 1.0, 2.0, -0.7, 0.2, 0.3),
    partial(planar_transform, _TIME, "odom", "base", 1.0, 2.0, -0.7),
    partial(joint_state_message, _TIME, [("left", 1.0, 2.0, 3.0), ("right_wheel", -1.0, 0.0, 1e-300)]),
    partial(joint_state_message, _TIME, [("free", np.arange(3.0), np.arange(3.0), np.zeros(3)), ("fixed", (), (), ())]),
    partial(joint_state_message, _TIME, []),
    partial(clock_message, _TIME),
)


@pytest.mark.parametrize("make", _CASES, ids=lambda make: make.func.__name__)
def test_a_packer_returns_the_type_and_the_bytes_of_the_message(make: partial[object]) -> None:
    message = make()
    expected = msgs.type_name(message), msgs.serialize(message)
    assert PACKERS[make.func](*make.args) == expected
    assert LazyMessage(make).serialised() == expected


def test_every_packer_is_compared_with_its_message() -> None:
    assert {make.func for make in _CASES} == set(PACKERS)


@pytest.mark.parametrize("yaw", [0.0, -0.0, 0.7, -3.1, 2.5e-9])
def test_a_planar_pose_has_the_bits_of_its_pose_in_a_message(yaw: float) -> None:
    planar = PlanarPose(-0.0, 2.0, yaw)
    found, expected = (odometry_message(_TIME, "odom", "base", pose, _TWIST) for pose in (planar, planar()))
    assert msgs.serialize(found) == msgs.serialize(expected)
