"""References of velocity servos: lag, waiting wheels and stops."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from simkit_control.plugins.ros2_control.velocity_references import advance_references

SLACK = 0.05  # [rad]


def advance(
    lags: list[float],
    speeds: list[float],
    groups: list[int],
    velocity: float = 0.0,
    previous_speeds: tuple[float, ...] = (),
) -> Any:
    """Return lags of the references and their speeds; joints are at 1 rad."""
    count = len(lags)
    references, found = advance_references(
        [1.0 + lag for lag in lags],
        speeds,
        positions=[1.0] * count,
        velocities=[velocity] * count,
        previous_speeds=previous_speeds or (0.0,) * count,
        slacks=[SLACK] * count,
        catch_up_times=[0.1] * count,
        groups=groups,
    )
    return np.array(references) - 1.0, found


def test_a_joint_that_can_follow_gets_the_commanded_reference() -> None:
    lags, speeds = advance([0.03, -0.04], [2.0, -3.0], [1, 1])
    np.testing.assert_allclose(lags, [0.03, -0.04])
    np.testing.assert_array_equal(speeds, [2.0, -3.0])


def test_a_joint_that_cannot_follow_does_not_wind_its_reference_up() -> None:
    lags, speeds = advance([5.0], [1.0], [0])
    assert lags[0] == pytest.approx(2 * SLACK) and speeds[0] == pytest.approx(0)


def test_joints_of_one_controller_wait_for_the_slowest_and_other_joints_do_not() -> None:
    _, speeds = advance([1.5 * SLACK, 0.0, 0.0, 0.0], [2.0, 2.0, 2.0, 2.0], [1, 1, 2, 0])
    np.testing.assert_allclose(speeds, [1.0, 1.0, 2.0, 2.0])
    _, speeds = advance([-1.5 * SLACK, 0.0], [-2.0, 1.0], [1, 1])
    np.testing.assert_allclose(speeds, [-1.0, 0.5])


def test_a_joint_ahead_of_its_reference_does_not_wait() -> None:
    _, speeds = advance([-3 * SLACK, 0.0], [2.0, 2.0], [1, 1])
    np.testing.assert_array_equal(speeds, [2.0, 2.0])


def test_a_stopped_joint_holds_the_position_where_it_comes_to_rest() -> None:
    lags, _ = advance([0.04], [0.0], [0], previous_speeds=(0.1,))
    assert lags[0] == 0  # the command has just ended
    lags, _ = advance([0.04], [0.0], [1], velocity=2.0)
    assert lags[0] == 0  # it still moves
    lags, _ = advance([0.04], [0.0], [1])
    assert lags[0] == pytest.approx(0.04)  # at rest it holds


def test_the_lag_across_the_motion_is_corrected_when_wheels_stop() -> None:
    lags, _ = advance([0.04, 0.02], [0.0, 0.0], [1, 1], previous_speeds=(0.1, 0.1))
    np.testing.assert_allclose(lags, [0.01, -0.01])  # straight motion: the heading is corrected
    lags, _ = advance([0.04, -0.02], [0.0, 0.0], [1, 1], previous_speeds=(0.1, -0.1))
    np.testing.assert_allclose(lags, [0.01, 0.01])  # rotation: the position is corrected


def test_a_joint_without_effort_limit_may_lag_without_limit() -> None:
    references, speeds = advance_references(
        [50.0],
        [1.0],
        positions=[0.0],
        velocities=[0.0],
        previous_speeds=[1.0],
        slacks=[np.inf],
        catch_up_times=[0.1],
        groups=[0],
    )
    assert (references[0], speeds[0]) == (50, 1)
