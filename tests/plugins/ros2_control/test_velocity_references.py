"""How the references of velocity servos go on."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from simkit.plugins.ros2_control.velocity_references import advance_references

SLACK = 0.05  # [rad]


def led(
    lags: list[float], speeds: list[float], groups: list[int], turning: float = 0.0, before: tuple[float, ...] = ()
) -> Any:
    """Lags of the references and their speeds; joints are at 1 rad."""
    count = len(lags)
    references, found = advance_references(
        [1.0 + lag for lag in lags],
        speeds,
        places=[1.0] * count,
        turning=[turning] * count,
        before=before or (0.0,) * count,
        slacks=[SLACK] * count,
        catch_up=[0.1] * count,
        groups=groups,
    )
    return np.array(references) - 1.0, found


def test_what_follows_is_led_as_commanded() -> None:
    lags, speeds = led([0.03, -0.04], [2.0, -3.0], [1, 1])
    np.testing.assert_allclose(lags, [0.03, -0.04])
    np.testing.assert_array_equal(speeds, [2.0, -3.0])


def test_a_joint_that_cannot_follow_does_not_wind_its_reference_up() -> None:
    lags, speeds = led([5.0], [1.0], [0])
    assert lags[0] == pytest.approx(2 * SLACK) and speeds[0] == pytest.approx(0)


def test_the_others_of_its_controller_wait_for_it_and_those_of_another_do_not() -> None:
    _, speeds = led([1.5 * SLACK, 0.0, 0.0, 0.0], [2.0, 2.0, 2.0, 2.0], [1, 1, 2, 0])
    np.testing.assert_allclose(speeds, [1.0, 1.0, 2.0, 2.0])
    _, speeds = led([-1.5 * SLACK, 0.0], [-2.0, 1.0], [1, 1])
    np.testing.assert_allclose(speeds, [-1.0, 0.5])


def test_a_joint_that_is_ahead_of_its_reference_waits_for_nobody() -> None:
    _, speeds = led([-3 * SLACK, 0.0], [2.0, 2.0], [1, 1])
    np.testing.assert_array_equal(speeds, [2.0, 2.0])


def test_told_to_stand_it_stands_where_it_comes_to_rest() -> None:
    lags, _ = led([0.04], [0.0], [0], before=(0.1,))
    assert lags[0] == 0  # the command has just ended
    lags, _ = led([0.04], [0.0], [1], turning=2.0)
    assert lags[0] == 0  # it still moves
    lags, _ = led([0.04], [0.0], [1])
    assert lags[0] == pytest.approx(0.04)  # at rest it holds


def test_what_wheels_differ_by_from_the_motion_is_made_good_when_they_stop() -> None:
    lags, _ = led([0.04, 0.02], [0.0, 0.0], [1, 1], before=(0.1, 0.1))
    np.testing.assert_allclose(lags, [0.01, -0.01])  # straight on: the heading
    lags, _ = led([0.04, -0.02], [0.0, 0.0], [1, 1], before=(0.1, -0.1))
    np.testing.assert_allclose(lags, [0.01, 0.01])  # turning: the place


def test_an_effort_without_limit_leads_without_limit() -> None:
    references, speeds = advance_references(
        [50.0],
        [1.0],
        places=[0.0],
        turning=[0.0],
        before=[1.0],
        slacks=[np.inf],
        catch_up=[0.1],
        groups=[0],
    )
    assert (references[0], speeds[0]) == (50, 1)
