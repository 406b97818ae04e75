"""Interpolation between the points of a trajectory."""

from __future__ import annotations

import numpy as np
import pytest

from simkit.plugins.joints.joint_trajectory import (
    SECOND,
    JointPath,
    JointTarget,
    TrajectoryPoint,
    active_point,
    trajectory_faults,
)


def point(seconds: float, position: float, *rest: float) -> TrajectoryPoint:
    """Create a point, with a velocity and an acceleration if given."""
    return TrajectoryPoint(round(seconds * SECOND), (position,), rest[:1], rest[1:2])


def sampled(path: JointPath | None, until: float, count: int = 101) -> tuple[np.ndarray, np.ndarray]:
    assert path is not None
    times = np.linspace(0.0, until, count)
    states = [path.at(round(t * SECOND)) for t in times]
    return times, np.array([(s.position, s.velocity, s.acceleration) for s in states])


def test_the_active_point_is_the_first_one_whose_time_has_not_passed() -> None:
    times = [100, 200, 300]
    assert [active_point(times, t) for t in (-5, 0, 100, 101, 200, 201, 300, 301)] == [0, 0, 0, 1, 1, 2, 2, 2]


def test_linear_goes_straight_from_where_the_joint_is() -> None:
    path = JointPath.through(JointTarget(1.0, 9.0), [point(1, 3.0), point(3, 2.0)], 0, "linear")
    times, states = sampled(path, 4.0)
    np.testing.assert_allclose(states[:, 0], np.interp(times, [0, 1, 3], [1, 3, 2]), atol=1e-9)
    assert path is not None and path.at(SECOND // 2).velocity == pytest.approx(2.0)
    assert path.at(5 * SECOND) == JointTarget(2.0, 0.0)


def test_cubic_has_the_positions_and_velocities_of_its_points() -> None:
    # p = t³ - t has the velocities 3 t² - 1
    points = [point(t, t**3 - t, 3 * t**2 - 1) for t in (0.0, 0.7, 2.0)]
    times, states = sampled(JointPath.through(JointTarget(0.0), points, 0, "cubic"), 1.99)
    np.testing.assert_allclose(states[:, 0], times**3 - times, atol=1e-8)
    np.testing.assert_allclose(states[:, 1], 3 * times**2 - 1, atol=1e-7)


def test_cubic_passes_a_point_without_velocity_at_the_mean_slope_or_at_rest() -> None:
    path = JointPath.through(JointTarget(0.0), [point(1, 1.0), point(2, 3.0), point(3, 1.0)], 0, "cubic")
    assert path is not None
    assert path.at(SECOND).velocity == pytest.approx(1.5)
    assert path.at(2 * SECOND).velocity == pytest.approx(0.0)
    assert path.at(3 * SECOND).velocity == pytest.approx(0.0)


def test_quintic_from_rest_to_rest_is_the_jerk_free_move() -> None:
    path = JointPath.through(JointTarget(0.0), [point(2, 1.0, 0.0, 0.0)], 0, "quintic")
    times, states = sampled(path, 2.0)
    s = times / 2.0
    np.testing.assert_allclose(states[:, 0], 10 * s**3 - 15 * s**4 + 6 * s**5, atol=1e-9)
    np.testing.assert_allclose(states[:-1, 2], (60 * s - 180 * s**2 + 120 * s**3)[:-1] / 4.0, atol=1e-8)


def test_quintic_has_the_accelerations_of_its_points() -> None:
    # p = t⁴ has 4 t³ and 12 t²
    points = [point(t, t**4, 4 * t**3, 12 * t**2) for t in (0.0, 1.0, 1.5)]
    times, states = sampled(JointPath.through(JointTarget(5.0), points, 0, "quintic"), 1.49)
    np.testing.assert_allclose(states[:, 0], times**4, atol=1e-8)
    np.testing.assert_allclose(states[:, 1], 4 * times**3, atol=1e-7)


def test_a_joint_that_no_point_has_a_position_for_has_no_path() -> None:
    assert JointPath.through(JointTarget(0.0), [TrajectoryPoint(SECOND, (), (1.0,))], 0, "cubic") is None


@pytest.mark.parametrize(
    ("points", "fault"),
    [
        ([point(1, 0.0), point(0.5, 1.0)], "point 1 is at 0.5 s, but the point before it is at 1 s"),
        ([point(1, float("nan"))], "NaN or infinite"),
        ([TrajectoryPoint(0, (1.0, 2.0))], "2 numbers for 1 joint names"),
        ([point(1, 0.0), point(1, 0.0)], ""),
        ([], ""),
    ],
)
def test_the_fault_of_an_unusable_trajectory_is_described(points: list[TrajectoryPoint], fault: str) -> None:
    assert fault in trajectory_faults(["a"], points) if fault else not trajectory_faults(["a"], points)
