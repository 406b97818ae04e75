"""PID controller of Gazebo's joint systems."""

from __future__ import annotations

import pytest

from simkit.plugins.joints.pid import Pid


def test_the_first_derivative_starts_at_zero_and_the_integral_term_is_limited() -> None:
    pid = Pid(2.0, 10.0, 0.1, 0.5, -0.5, 100.0, -100.0)
    # p = 2, i = 10 · 0.01, d = 0.1 · 1 / 0.01
    assert pid.update(1.0, 0.01) == pytest.approx(-(2.0 + 0.1 + 10.0))
    assert pid.update(1.0, 0.01) == pytest.approx(-(2.0 + 0.2))
    for _ in range(100):
        pid.update(1.0, 0.01)
    assert pid.integral == 0.5
    assert pid.update(1.0, 0.01) == pytest.approx(-2.5)


def test_a_nan_error_or_a_zero_step_changes_nothing() -> None:
    pid = Pid(2.0, 10.0, 0.1, 0.5, -0.5, 100.0, -100.0)
    pid.update(1.0, 0.01)
    before = pid.integral, pid.last
    assert pid.update(float("nan"), 0.01) == 0.0
    assert pid.update(float("inf"), 0.01) == 0.0
    assert pid.update(3.0, 0.0) == 0.0
    assert (pid.integral, pid.last) == before


def test_crossed_limits_have_no_effect() -> None:
    free = Pid(1e6, 1e6, 0.0, -1.0, 0.0, -1.0, 0.0)
    assert free.update(1.0, 0.5) == pytest.approx(-1.5e6)
    bounded = Pid(1e6, 0.0, 0.0, 1.0, -1.0, 7.0, -3.0, offset=2.0)
    assert bounded.update(1.0, 0.5) == -3.0
    assert bounded.update(-1.0, 0.5) == 7.0
    assert bounded.update(0.0, 0.5) == 2.0


@pytest.mark.parametrize(("growth", "is_unstable"), [(0.9, False), (1.0, False), (1.1, True)])
def test_a_loop_with_growing_oscillations_is_unstable(growth: float, is_unstable: bool) -> None:
    pid = Pid(1.0, 0.0, 0.0, 1.0, -1.0, 1000.0, -1000.0)
    for k in range(40):
        pid.update((-growth) ** k, 0.001)
    assert pid.swings.is_unstable is is_unstable


def test_a_loop_that_oscillates_between_its_limits_is_unstable() -> None:
    pid = Pid(1e5, 0.0, 0.0, 1.0, -1.0, 10.0, -10.0)
    for k in range(40):
        pid.update((-1.0) ** k, 0.001)
    assert pid.swings.is_unstable
    pid.restart()
    assert not pid.swings.is_unstable
