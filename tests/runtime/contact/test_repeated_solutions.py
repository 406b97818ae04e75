"""Repetition of the contact law: which contacts need it, where it starts, and when it ends."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import simkit
from simkit.runtime.contact.anderson_acceleration import IslandIterations
from simkit.runtime.contact.contact_law import LawUse
from simkit.runtime.engine.physics_step import VELOCITY

ROBOT = """<mujoco><option cone="elliptic" impratio="100" integrator="implicitfast" timestep="0.001"/>
<default><geom friction="0.8" solref="0.004 1"/></default>
<worldbody><geom type="plane" size="9 9 1"/><body name="base" pos="0 0 0.05"><freejoint/>
<geom type="box" size="0.1 0.1 0.01" mass="2" contype="0" conaffinity="0"/>
<geom type="sphere" size="0.02" pos="-0.1 0 -0.03" mass="0.1" condim="1" priority="1"/>
<body pos="0 0.14 0"><joint name="left" axis="0 1 0" armature="0.001"/><geom type="sphere" size="0.05" mass="0.1"/>
</body><body pos="0 -0.14 0"><joint name="right" axis="0 1 0" armature="0.001"/>
<geom type="sphere" size="0.05" mass="0.1"/></body></body></worldbody>
<actuator><velocity joint="left" kv="1"/><velocity joint="right" kv="1"/></actuator></mujoco>"""


@pytest.fixture(name="robot")
def driving_robot(tmp_path: Path) -> simkit.Simulation:
    """Return a robot with two wheels that drives an arc at 0.2 m/s and 1.8 rad/s."""
    path = tmp_path / "robot.xml"
    path.write_text(ROBOT)
    sim = simkit.load(path)
    sim.run(0.2)
    sim.mj_data.ctrl[:] = [(0.2 - 1.8 * 0.14) / 0.05, (0.2 + 1.8 * 0.14) / 0.05]
    sim.run(1.0)
    return sim


def test_wheels_that_creep_in_an_arc_do_not_count_as_sliding(robot: simkit.Simulation) -> None:
    """The centripetal force needs a creep of 0.7 mm/s, at which the velocity alone seems to be a slip."""
    physics = robot.engine.physics
    for _ in range(50):
        robot.step()
        data = physics.fresh()
        wheels = data.contact.efc_address[data.contact.dim == 3]
        slip = np.hypot(*data.efc_vel[wheels[:, None] + [1, 2]].T)
        assert 3e-4 < slip.max() < 2e-3
        assert not physics.law.needed_use(data)
    left, right = robot.mj_data.qvel[6:]
    assert robot.mj_data.qvel[5] == pytest.approx((right - left) * 0.05 / 0.28, rel=0.01)


def test_wheels_that_are_pushed_sideways_slide(robot: simkit.Simulation) -> None:
    data = robot.engine.physics.fresh()
    data.qvel[:2] += [0.5, 0.5]
    robot.engine.physics.changed(VELOCITY)
    assert robot.engine.physics.law.needed_use(robot.engine.physics.fresh())


def test_wide_wheels_in_an_arc_need_only_their_part_of_the_law(tmp_path: Path) -> None:
    """Both edges of a wheel slip, its shared friction point creeps; a reader sees the forces of the step."""
    path = tmp_path / "robot.xml"
    path.write_text(ROBOT.replace('"sphere" size="0.05" mass', '"cylinder" size="0.05 0.01" zaxis="0 1 0" mass'))
    sim = simkit.load(path)
    sim.run(0.2)
    physics = sim.engine.physics
    uses = [physics.window.uses_law]
    sim.mj_data.ctrl[:] = [(0.2 - 1.8 * 0.14) / 0.05, (0.2 + 1.8 * 0.14) / 0.05]
    sim.run(1.0)
    for _ in range(20):
        held, data = physics.hold(), physics.fresh()
        slip = np.hypot(*data.efc_vel[data.contact.efc_address[data.contact.dim == 3][:, None] + [1, 2]].T)
        forces = data.efc_force.copy()
        sim.step()
        uses.append(physics.window.uses_law)
        assert slip.max() < 2e-3
        assert np.array_equal(physics.data_of(held).efc_force, forces)
    left, right = sim.mj_data.qvel[6:]
    assert sim.mj_data.qvel[5] == pytest.approx((right - left) * 0.05 / 0.28, rel=0.01)
    sim.mj_data.qvel[:2] += [0.5, 0.5]
    physics.changed(VELOCITY)
    physics.fresh()
    assert [*uses, physics.window.uses_law] == [LawUse.NONE, *[LawUse.WHEELS] * 20, LawUse.WHOLE]


def test_a_forward_pass_keeps_the_acceleration_of_the_previous_step(robot: simkit.Simulation) -> None:
    """This acceleration is part of the state: the next step and every reader start from it."""
    data, law = robot.engine.physics.fresh(), robot.engine.physics.law
    data.qvel[:3] += [0.3, 0.5, -0.4]
    robot.engine.physics.changed(VELOCITY)
    robot.engine.physics.fresh_velocities()
    before = data.qacc_warmstart.copy()
    assert law.solve(data, None)
    assert np.array_equal(data.qacc_warmstart, before)


def test_the_iteration_of_an_island_does_not_depend_on_other_islands() -> None:
    """Each island x' = slope x + 1 converges to 1 / (1 - slope); a settled island keeps its iterate."""
    slopes, islands = [0.9, -0.8, 0.5, 0.7], [4, 2, 4, 2]

    def iterate(chosen: list[int]) -> list[float]:
        together = IslandIterations([islands[k] for k in chosen], [1.0] * len(chosen), ())
        values = [0.0] * len(chosen)
        for _ in range(6):
            results = [slopes[k] * x + 1.0 for k, x in zip(chosen, values, strict=True)]
            values = together.next(values, results, sorted({islands[k] for k in chosen}))
        assert together.next(values, [0.0] * len(chosen), []) == values
        return values

    both = iterate([0, 1, 2, 3])
    assert both == pytest.approx([10.0, 1.0 / 1.8, 2.0, 1.0 / 0.3], rel=1e-6)
    assert iterate([0, 2]) == [both[0], both[2]]
    assert iterate([1, 3]) == [both[1], both[3]]
