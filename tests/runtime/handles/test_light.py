"""Moved lights: their handles, and their poses for the renderer."""

from __future__ import annotations

import math

import numpy as np
import pytest

import simkit
from simkit.pose import Pose
from simkit.runtime.handles.light import LightState

SUN = '<light name="sun" type="directional"><direction>0 0 -1</direction></light>'
POST = (
    '<model name="post"><static>true</static><pose>5 0 0 0 0 0</pose><link name="l">'
    '<light name="lamp" type="point"><pose>0 0 4 0 0 0</pose></light></link></model>'
)
BALL = (
    '<model name="ball"><pose>0 0 9 0 0 0</pose><link name="l"><collision name="c"><geometry>'
    "<sphere><radius>0.1</radius></sphere></geometry></collision></link></model>"
)


def opened(*parts: str) -> simkit.Simulation:
    return simkit.load(f'<sdf version="1.9"><world name="w">{"".join(parts)}</world></sdf>')


def drawn(sim: simkit.Simulation) -> tuple[np.ndarray, np.ndarray]:
    """Return position and direction of the only light for the renderer, world frame."""
    data = sim.engine.physics.fresh()
    return data.light_xpos[0].copy(), data.light_xdir[0].copy()


@pytest.mark.parametrize("others", [(), (BALL,)], ids=["all at rest", "something moves"])
def test_a_moved_light_of_the_world_is_drawn_at_the_pose_of_its_handle(others: tuple[str, ...]) -> None:
    with opened(SUN, *others) as sim:
        sim.run(0.1)
        sim.light("sun").set_pose(Pose.from_rpy(1, 2, 3, 1, 0, 0))
        for _ in range(2):
            position, direction = drawn(sim)
            np.testing.assert_allclose(position, (1, 2, 3))
            np.testing.assert_allclose(direction, (0, math.sin(1), -math.cos(1)), atol=1e-12)
            np.testing.assert_allclose(sim.light("sun").direction, direction, atol=1e-12)
            sim.step(3)
        sim.reset()
        np.testing.assert_allclose(drawn(sim)[1], (0, 0, -1), atol=1e-12)


def test_a_light_on_a_static_link_keeps_its_pose_in_a_reset_and_moves_with_the_link() -> None:
    with opened(POST) as sim:
        light = sim.light("post::l::lamp")
        for _ in range(2):
            np.testing.assert_allclose(drawn(sim)[0], (5, 0, 4))
            sim.step()
            sim.reset()
        sim.model("post").set_pose(Pose((0, 7, 0)))
        np.testing.assert_allclose(drawn(sim)[0], (0, 7, 4))
        np.testing.assert_allclose(light.pose.position, (0, 7, 4))
        light.set_pose(Pose((1, 1, 1)))
        np.testing.assert_allclose(drawn(sim)[0], (1, 1, 1))
        sim.reset()
        np.testing.assert_allclose(drawn(sim)[0], (5, 0, 4))


def test_a_light_follows_a_course_until_its_pose_is_set() -> None:
    def course(time_ns: int) -> LightState:
        return LightState(Pose((time_ns * 1e-9, 0, 0)), on=time_ns < 500_000_000, irradiance=7.0)

    with opened(SUN) as sim:
        light = sim.light("sun")
        assert light.on and light.irradiance is None
        light.follow(course)
        sim.run(0.2)
        snapshot = sim.snapshot()
        assert light.pose.position[0] == pytest.approx(0.2)
        assert light.on and light.irradiance == 7.0
        sim.run(0.4)
        assert not light.on
        light.set_pose(Pose((3, 0, 0)))
        assert not light.on and light.pose.position[0] == 3
        sim.restore(snapshot)
        sim.run(0.1)
        assert light.pose.position[0] == pytest.approx(0.3)
        sim.reset()
        assert light.pose.position[0] == 0 and light.irradiance is None


def test_a_light_that_is_off_in_the_file_is_off() -> None:
    with opened(SUN.replace("</light>", "<light_on>false</light_on></light>")) as sim:
        assert not sim.light("sun").on
        assert not sim.mj_model.light_active[0]
