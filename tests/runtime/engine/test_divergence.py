"""A run that diverges names the joint in which it began, the time, the cause and a remedy, and leaves no file."""

from __future__ import annotations

from pathlib import Path

import pytest

import simkit

WHEEL = """<body pos="0 {y} 0"><joint name="wheel_{side}_joint" axis="0 1 0"/>
<inertial pos="0 0 0" mass="0.1" diaginertia="7e-5 1.25e-4 7e-5"/>
<geom type="cylinder" size="0.033 0.009" euler="90 0 0"/>
</body>"""
BASE = f"""<mujoco><option timestep="0.002"/><worldbody><geom type="plane" size="5 5 0.1"/>
<body name="base" pos="0 0 0.04"><freejoint/><geom type="box" size="0.1 0.08 0.02" mass="1"/>
<geom type="sphere" size="0.01" pos="-0.08 0 -0.023" mass="0.01" friction="0.01"/>
{WHEEL.format(y=0.1, side="left")}{WHEEL.format(y=-0.1, side="right")}</body></worldbody><actuator>
<velocity name="left" joint="wheel_left_joint" kv="1"/><velocity name="right" joint="wheel_right_joint" kv="1"/>
</actuator></mujoco>"""


def test_a_wheel_with_a_large_gain_is_named_and_not_its_base(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """MuJoCo's own loop would reset the state 23 times in 500 steps, and go on."""
    monkeypatch.chdir(tmp_path)
    with simkit.load(BASE) as sim:
        sim.mj_data.ctrl[:] = 5.0
        with pytest.raises(simkit.SimulationDiverged) as caught:
            sim.run(1.0)
    assert (caught.value.joint, caught.value.time) == ("wheel_left_joint", 0.01)
    assert 'use at most 0.121, <option integrator="implicitfast"/>' in caught.value.hint
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_the_same_wheels_run_with_an_implicit_integrator() -> None:
    with simkit.load(BASE.replace("<option ", '<option integrator="implicitfast" ')) as sim:
        sim.mj_data.ctrl[:] = 5.0
        sim.run(10.0)
        assert sim.joint("base::wheel_left_joint").velocity == pytest.approx(5.0, abs=0.01)
