"""Splines through the points of a trajectory."""

from __future__ import annotations

import numpy as np
import pytest

from simkit_control.plugins.ros2_control.trajectory import (
    SECOND,
    Setpoint,
    Spline,
    TrajectoryPoint,
    integrate_points,
    shortest_differences,
    whole_turn_offset,
)


def point(time: float, *fields: list[float] | None) -> TrajectoryPoint:
    return TrajectoryPoint(round(time * SECOND), *(None if f is None else np.array(f) for f in fields))


def at(spline: Spline, time: float) -> Setpoint:
    return spline.at(round(time * SECOND))


START = point(0.0, [0.0, 1.0], [0.0, 0.0])


def test_positions_alone_are_joined_by_straight_lines() -> None:
    spline = Spline.through(START, [point(2.0, [1.0, 0.0]), point(3.0, [1.0, 4.0])])
    np.testing.assert_allclose(at(spline, 0.5).motion, [[0.25, 0.75], [0.5, -0.5], [0.0, 0.0]])
    np.testing.assert_allclose(at(spline, 2.5).motion, [[1.0, 2.0], [0.0, 4.0], [0.0, 0.0]])
    np.testing.assert_allclose(at(spline, 9.0).motion, [[1.0, 4.0], [0.0, 0.0], [0.0, 0.0]])


def test_velocities_give_the_cubic_hermite_polynomial() -> None:
    spline = Spline.through(START, [point(2.0, [1.0, 0.0], [0.5, 0.0]), point(4.0, [2.0, 0.0], [0.0, 0.0])])
    s = 0.75 / 2.0  # the cubic of a rise of 1 in 2 s that begins at rest and ends at 0.5
    expected = 1.0 * (3 * s**2 - 2 * s**3) + 0.5 * 2.0 * (s**3 - s**2)
    assert at(spline, 0.75).motion[0, 0] == pytest.approx(expected, abs=1e-12)
    for time in (1e-9, 2.0 - 1e-9, 2.0, 4.0 - 1e-9):
        wanted = 0.5 if 1.0 < time < 3.0 else 0.0
        assert at(spline, time).motion[1, 0] == pytest.approx(wanted, abs=1e-7)


def test_velocities_and_accelerations_give_the_quintic_hermite_polynomial() -> None:
    ends = [point(1.0, [1.0], [0.2], [-0.4]), point(3.0, [0.0], [0.0], [0.0])]
    spline = Spline.through(point(0.0, [0.0], [0.0], [0.3]), ends)
    for time, motion in ((0.0, [0.0, 0.0, 0.3]), (1.0, [1.0, 0.2, -0.4])):
        np.testing.assert_allclose(at(spline, time).motion[:, 0], motion, atol=1e-12)
    before = at(spline, 1.0 - 1e-6).motion[:, 0]
    np.testing.assert_allclose(before, [1.0, 0.2, -0.4], atol=1e-4)


def test_a_quintic_starts_with_zero_acceleration_if_the_state_has_none() -> None:
    spline = Spline.through(point(0.0, [0.0], [0.1]), [point(1.0, [1.0], [0.0], [0.0])])
    s = 0.5
    expected = 10 * s**3 - 15 * s**4 + 6 * s**5 + 0.1 * (s - 6 * s**3 + 8 * s**4 - 3 * s**5)
    assert at(spline, 0.5).motion[0, 0] == pytest.approx(expected, abs=1e-12)


def test_a_piece_without_velocities_is_straight_between_cubic_pieces() -> None:
    points = [point(1.0, [1.0, 1.0], [0.0, 0.0]), point(2.0, [2.0, 1.0]), point(3.0, [3.0, 1.0], [0.0, 0.0])]
    spline = Spline.through(START, points)
    assert at(spline, 1.25).motion[0, 0] == pytest.approx(1.25)
    assert at(spline, 0.25).motion[0, 0] == pytest.approx(3 * 0.25**2 - 2 * 0.25**3)


def test_a_trajectory_begins_at_its_first_past_point() -> None:
    late = point(1.5, [5.0, 5.0])
    spline = Spline.through(late, [point(1.0, [1.0, 1.0]), point(2.0, [3.0, 1.0])])
    np.testing.assert_allclose(at(spline, 1.5).motion[0], [2.0, 1.0])


def test_without_interpolation_the_target_is_the_next_point() -> None:
    spline = Spline.through(START, [point(1.0, [1.0, 1.0]), point(2.0, [3.0, 2.0])], steps=True)
    assert at(spline, 0.5).motion[0].tolist() == [0.0, 1.0]
    assert at(spline, 1.5).motion[0].tolist() == [3.0, 2.0]
    assert at(spline, 2.5).motion[0].tolist() == [3.0, 2.0]


def test_efforts_are_interpolated_between_points() -> None:
    spline = Spline.through(START, [point(1.0, [1.0, 1.0], None, None, [4.0, 0.0]), point(2.0, [1.0, 1.0])])
    efforts = at(spline, 0.5).efforts
    assert efforts is not None and efforts.tolist() == [2.0, 0.0]
    last = at(spline, 5.0).efforts
    assert last is not None and last.tolist() == [0.0, 0.0]


def test_velocities_are_integrated_to_missing_positions() -> None:
    points = integrate_points(START, [point(1.0, None, [1.0, -1.0]), point(3.0, None, [1.0, -1.0])])
    assert [p.positions.tolist() for p in points if p.positions is not None] == [[0.5, 0.5], [2.5, -1.5]]
    (only,) = integrate_points(START, [point(2.0, None, None, [1.0, 0.0])])
    assert only.velocities is not None and only.velocities.tolist() == [1.0, 0.0]


def test_each_joint_comes_to_rest_at_its_own_deceleration() -> None:
    spline = Spline.stop(np.array([1.0, 2.0, 3.0]), np.array([1.0, -2.0, 1.0]), np.array([2.0, 2.0, 0.0]))
    # v²/(2a) = 0.25 m in 0.5 s, and 1 m in 1 s; the third has no deceleration and stops at once
    np.testing.assert_allclose(at(spline, 0.25).motion[0], [1.0 + 0.25 - 0.0625, 2.0 - 0.5 + 0.0625, 3.0])
    np.testing.assert_allclose(at(spline, 0.75).motion[0], [1.25, 2.0 - 1.5 + 0.5625, 3.0])
    np.testing.assert_allclose(at(spline, 2.0).motion, [[1.25, 1.0, 3.0], [0.0] * 3, [0.0] * 3], atol=1e-12)


def test_continuous_joints_take_the_short_way() -> None:
    turning = np.array([True, False])
    turns = whole_turn_offset(np.array([6.0, 6.0]), np.array([0.1, 0.1]), turning)
    np.testing.assert_allclose(turns, [2 * np.pi, 0.0])
    np.testing.assert_allclose(shortest_differences(np.array([6.0, 6.0]), turning), [6.0 - 2 * np.pi, 6.0])


def test_a_setpoint_has_the_same_bits_alone_and_computed_ahead() -> None:
    ends = [point(1.0, [0.3, 0.7], [0.2, -0.1], [0.1, 0.4]), point(2.5, [1.0, 0.0], [0.0, 0.0], [0.0, 0.0])]
    step = 7_000_001
    alone, ahead = Spline.through(START, ends), Spline.through(START, ends)
    for time in range(0, 2 * SECOND, step):
        assert alone.at(time).motion.tobytes() == ahead.at(time, step).motion.tobytes()
    np.testing.assert_array_equal(ahead.at(3 * SECOND, step).motion, ahead.last.motion)
