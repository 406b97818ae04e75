"""A free body that leaves its world is reported once, with its time and the likely cause."""

from __future__ import annotations

import pytest

import simkit

GROUND = """<model name="ground"><static>true</static><link name="l"><collision name="c"><geometry>{}</geometry>
  </collision></link></model>"""
PLANE, FLOOR = GROUND.format("<plane/>"), GROUND.format("<box><size>4 4 0.2</size></box>")
ROUND = "<inertia><ixx>0.004</ixx><iyy>0.004</iyy><izz>0.004</izz></inertia>"


def ball(pose: str, inertia: str = ROUND, more: str = "", name: str = "ball") -> str:
    return f"""<model name="{name}"><pose>{pose}</pose><link name="l"><inertial><mass>1</mass>{inertia}</inertial>
      <collision name="c"><geometry><sphere><radius>0.1</radius></sphere></geometry></collision></link>{more}</model>"""


def world(*models: str, top: str = "") -> str:
    return f'<sdf version="1.9"><world name="w">{top}{"".join(models)}</world></sdf>'


def strays(sim: simkit.Simulation) -> list[simkit.Diagnostic]:
    return [d for d in sim.diagnostics if d.code == "SK-PHYS-032"]


def test_a_body_that_flies_away_is_named_once_with_time_and_speed() -> None:
    with simkit.load(world(PLANE, ball("0 0 1 0 0 0"), ball("3 0 0.1 0 0 0", name="other"))) as sim:
        sim.run(1.0)
        assert not strays(sim)
        sim.model("ball").set_velocity((300.0, 0.0, 50.0))
        sim.run(2.0)
        (warning,) = strays(sim)
        assert warning.severity == "warning"
        assert warning.line > 0
        assert "ball::l leaves the world: at t = 1.10 s it is 2" in warning.message
        assert "with 30" in warning.message
        sim.reset()
        sim.model("ball").set_velocity((300.0, 0.0, 50.0))
        sim.run(1.0)
        assert len(strays(sim)) == 1


def test_a_slow_body_is_reported_where_it_is_a_kilometre_away() -> None:
    with simkit.load(world(FLOOR, ball("0 0 1 0 0 0"), top="<gravity>0 0 0</gravity>")) as sim:
        sim.model("ball").set_velocity((90.0, 0.0, 0.0))
        sim.run(11.0)
        assert not strays(sim)
        sim.run(0.5)
        (warning,) = strays(sim)
        assert "at t = 11.20 s it is 1006 m away from everything, with 90 m/s" in warning.message


def test_a_long_way_over_a_plane_and_a_fast_body_inside_of_the_world_are_no_reason() -> None:
    walls = FLOOR.replace("ground", "walls").replace("4 4 0.2", "9000 9000 0.2")
    for ground in (PLANE, walls):
        with simkit.load(world(ground, ball("0 0 5 0 0 0"), top="<gravity>0 0 0</gravity>")) as sim:
            sim.model("ball").set_velocity((95.0 if ground is PLANE else 400.0, 0.0, 0.0))
            sim.run(11.0)
            assert float(sim.model("ball").pose.position[0]) > 1040
            assert not strays(sim)


def test_a_body_that_falls_beside_the_ground_gets_the_ground_as_remedy() -> None:
    with simkit.load(world(FLOOR, ball("5 0 1 0 0 0"))) as sim:
        sim.run(10.1)
        assert not strays(sim)
        sim.run(0.5)
        (warning,) = strays(sim)
        assert "it falls freely since about t = 0.0" in warning.message
        assert "ground_plane" in warning.hint


def test_a_body_with_too_small_moments_has_them_as_the_cause() -> None:
    tiny = "<inertia><ixx>1e-8</ixx><iyy>1e-8</iyy><izz>1e-8</izz></inertia>"
    with simkit.load(world(PLANE, ball("0 0 1 0 0 0", tiny))) as sim:
        sim.model("ball").set_velocity((0.0, 0.0, 200.0))
        sim.run(0.2)
        (warning,) = strays(sim)
        assert "moments of inertia, (1e-08, 1e-08, 1e-08) kg m2, which are too small for its size" in warning.message


def test_a_large_command_is_the_cause() -> None:
    plugin = """<plugin filename="gz-sim-velocity-control-system" name="gz::sim::systems::VelocityControl">
      <topic>cmd_vel</topic></plugin>"""
    with simkit.load(world(PLANE, ball("0 0 1 0 0 0", more=plugin))) as sim:
        sim.publish("/cmd_vel", {"linear": {"x": 400.0}})
        sim.run(0.2)
        (warning,) = strays(sim)
        assert "the last command on /cmd_vel" in warning.message
        assert "linear.x = 400" in warning.message


@pytest.mark.parametrize("sleep", [False, True])
def test_the_check_changes_no_bit(sleep: bool) -> None:
    text = world(PLANE, ball("0 0 0.5 0 0 0"), ball("0.15 0 1 0 0 0", name="other"))
    states = []
    for is_checked in (False, True):
        with simkit.load(text, sleep=sleep) as sim:
            if not is_checked:
                sim.engine.stray_bodies.look = lambda _tick=0: None  # type: ignore[method-assign]
                sim.engine.reschedule()
            sim.run(3.0)
            states.append(sim.mj_data.qpos.tobytes() + sim.mj_data.qvel.tobytes())
    assert states[0] == states[1]
