"""Course of a motion: its points, times and speed limits."""

from __future__ import annotations

import numpy as np
import pytest

from simkit_motion.plugins.play_motion.motion import Motion
from simkit_motion.plugins.play_motion.motion_planning import Approach, course_from
from simkit_motion.plugins.play_motion.motion_timing import Course

LIMITS = np.array([1.0, 2.0])


def motion(
    *points: tuple[float, ...], times: tuple[float, ...], velocities: tuple[tuple[float, ...], ...] = ()
) -> Motion:
    return Motion("m", tuple(f"j{k}" for k in range(len(points[0]))), times, points, velocities)


def traced(course: Course) -> tuple[np.ndarray, np.ndarray]:
    """Return many times and positions along a course."""
    found = list(course.samples(np.full(course.positions.shape[1], 2e-3)))
    return np.array([t for t, _ in found]), np.array([p for _, p in found])


def speeds(course: Course) -> np.ndarray:
    times, places = traced(course)
    steps = np.diff(times) > 1e-9
    found: np.ndarray = np.abs(np.diff(places, axis=0)[steps] / np.diff(times)[steps, None])
    return found


def test_the_approach_takes_the_time_of_the_motion_if_that_is_enough() -> None:
    course = course_from(np.zeros(2), motion((0.1, 0.0), (0.2, 0.3), times=(1.0, 2.5)), LIMITS, Approach(0.5))
    assert course.times == pytest.approx([0.0, 1.0, 2.5])
    assert course.stretched == 1.0


def test_a_far_first_point_is_approached_slowly_and_later_intervals_stay() -> None:
    course = course_from(np.zeros(2), motion((0.0, 1.5), (0.1, 1.4), times=(0.5, 2.0)), LIMITS, Approach(0.5))
    assert course.times == pytest.approx([0.0, 3.0, 4.5])  # 1.5 rad at 0.5 rad/s


def test_the_limit_of_a_slow_joint_extends_the_approach() -> None:
    lift = course_from(np.zeros(1), motion((0.35,), times=(0.5,)), np.array([0.07]), Approach(0.5))
    assert lift.duration == pytest.approx(1.5 * 0.35 / 0.07)  # a cubic between two rests is 1.5 times as fast halfway
    assert speeds(lift).max() <= 0.07 * (1 + 1e-6)


def test_the_shortest_approach_time_counts_unless_the_point_is_reached() -> None:
    there = motion((0.0, 0.0), (0.1, 0.0), times=(0.0, 1.0))
    assert course_from(np.full(2, 0.05), there, LIMITS, Approach(0.5, 2.0)).times[1] == pytest.approx(2.0)
    assert course_from(np.zeros(2), there, LIMITS, Approach(0.5, 2.0)).times[1] == pytest.approx(1e-3)


def test_a_motion_that_is_too_fast_is_stretched_to_the_joint_limits() -> None:
    course = course_from(
        np.zeros(2), motion((0.0, 0.0), (2.0, 0.1), (2.0, 0.2), times=(0.0, 1.0, 2.0)), LIMITS, Approach()
    )
    assert course.times[2] - course.times[1] == pytest.approx(3.0, rel=1e-3)
    assert course.times[3] - course.times[2] == pytest.approx(1.0)  # only the interval that is too fast
    assert course.stretched == pytest.approx(2.0, rel=1e-3)
    assert speeds(course).max(axis=0)[0] <= 1.0 + 1e-3


def test_the_course_passes_every_point_and_overshoots_none() -> None:
    generator = np.random.default_rng(3)
    points = generator.uniform(-1, 1, (7, 3))
    times = tuple(np.cumsum(generator.uniform(0.3, 2.0, 7)))
    limits = np.full(3, 5.0)
    course = course_from(np.zeros(3), motion(*map(tuple, points), times=times), limits, Approach(1.0))
    assert course.positions[1:] == pytest.approx(points)
    assert not course.velocities[[0, -1]].any()
    when, places = traced(course)
    for k in range(len(course.times) - 1):
        inside = places[(when >= course.times[k] - 1e-9) & (when <= course.times[k + 1] + 1e-9)]
        low, high = np.minimum(*course.positions[k : k + 2]), np.maximum(*course.positions[k : k + 2])
        assert np.all(inside >= low - 1e-9) and np.all(inside <= high + 1e-9)
    assert speeds(course).max() <= 5.0 * (1 + 1e-3)


def test_the_course_does_not_stop_at_an_intermediate_point() -> None:
    course = course_from(
        np.zeros(1), motion((0.2,), (0.4,), (0.6,), times=(1.0, 2.0, 3.0)), np.array([9.0]), Approach()
    )
    assert course.velocities[2, 0] == pytest.approx(0.2)  # the same slope on both sides


def test_velocities_of_the_file_are_kept_or_all_reduced() -> None:
    given = motion((0.0,), (0.5,), times=(1.0, 2.0), velocities=((0.0,), (0.5,)))
    assert course_from(np.zeros(1), given, np.array([9.0]), Approach()).velocities[2, 0] == 0.5
    slowed = course_from(np.zeros(1), given, np.array([0.25]), Approach())
    assert slowed.velocities[2, 0] <= 0.25 + 1e-9
    assert speeds(slowed).max() <= 0.25 * (1 + 1e-3)
    assert slowed.stretched > 1.9


def test_an_approach_at_a_speed_near_zero_has_a_finite_duration() -> None:
    course = course_from(np.zeros(2), motion((0.1, 0.0), (0.2, 0.3), times=(1.0, 2.5)), LIMITS, Approach(1e-320))
    assert 2.0**31 < course.duration < 2.0**33


def test_a_way_near_zero_beside_a_long_one_has_velocities_of_zero() -> None:
    course = course_from(np.zeros(2), motion((1e-320, 0.0), (0.2, 0.3), times=(1.0, 2.5)), LIMITS, Approach(0.5))
    assert np.isfinite(course.velocities).all() and course.velocities[1, 0] == 0.0
