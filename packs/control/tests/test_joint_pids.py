"""PIDs of several joints at once."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from simkit import Params
from simkit.extend import Diagnostics
from simkit_control.plugins.ros2_control.joint_pids import JointPids


def pid(**gains: Any) -> JointPids:
    return JointPids(Params.from_dict({"a": gains}, "gains", Diagnostics()), ("a",))


def run(pids: JointPids, errors: list[float], step: float = 0.1) -> list[float]:
    return [float(pids.update(np.array([e]), np.zeros(1), step)[0]) for e in errors]


def test_the_three_parts_add_up() -> None:
    pids = pid(p=2.0, i=1.0, d=0.5)
    assert float(pids.update(np.array([1.0]), np.array([-1.0]), 0.1)[0]) == pytest.approx(1.5)
    assert float(pids.update(np.array([1.0]), np.array([0.0]), 0.1)[0]) == pytest.approx(2.1)


def test_the_integral_stays_within_its_clamp() -> None:
    assert run(pid(i=10.0, i_clamp=0.5), [1.0] * 5)[-1] == 0.5
    assert run(pid(i=10.0, i_clamp_min=-0.2, i_clamp_max=0.3), [-1.0] * 5)[-1] == -0.2


def test_a_clamped_command_does_not_wind_up_with_an_antiwindup_strategy() -> None:
    back = {"p": 1.0, "i": 1.0, "u_clamp_max": 1.0}
    wound = run(pid(**back), [2.0] * 50 + [-0.5] * 10)
    careful = run(pid(**back, antiwindup_strategy="conditional_integration"), [2.0] * 50 + [-0.5] * 10)
    tracking = run(
        pid(**back, antiwindup_strategy="back_calculation", tracking_time_constant=0.2), [2.0] * 50 + [-0.5] * 10
    )
    assert wound[-1] == 1.0
    assert careful[-1] < 0.0
    assert tracking[-1] < 0.0


def test_an_error_within_the_deadband_adds_nothing() -> None:
    assert run(pid(i=1.0, error_deadband=0.1), [0.05] * 5)[-1] == 0.0


def test_restart_clears_the_integral() -> None:
    pids = pid(i=1.0)
    run(pids, [1.0] * 5)
    pids.restart()
    assert pids.integral.tolist() == [0.0]
