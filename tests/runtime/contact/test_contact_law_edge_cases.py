"""Edge cases of the contact law: bodies exactly on a surface, and hits within a window."""

from __future__ import annotations

import pytest

import simkit

PLANE = """<model name="ground"><static>true</static><link name="l"><collision name="c"><geometry><plane>
<normal>0 0 1</normal><size>50 50</size></plane></geometry></collision></link></model>"""
WALL = """<model name="wall"><static>true</static><pose>5.3 0 5 0 0 0</pose><link name="l"><collision name="c">
<geometry><box><size>0.02 0.2 0.2</size></box></geometry></collision></link></model>"""


def body(name: str, geometry: str, pose: str, mu: float = 0.5) -> str:
    return f"""<model name="{name}"><pose>{pose}</pose><link name="l"><inertial><mass>1</mass><inertia><ixx>0.005</ixx>
      <iyy>0.005</iyy><izz>0.005</izz></inertia></inertial><collision name="c"><geometry>{geometry}</geometry><surface>
      <friction><ode><mu>{mu}</mu><mu2>{mu}</mu2></ode></friction></surface></collision></link></model>"""


def world(*models: str, step: float = 0.001) -> str:
    return f"""<sdf version="1.9"><world name="w"><physics type="ode"><max_step_size>{step}</max_step_size></physics>
      {"".join(models)}</world></sdf>"""


@pytest.mark.parametrize("step", [0.0005, 0.001, 0.002, 0.004])
def test_a_ball_that_starts_exactly_on_the_ground_slides_without_lift(step: float) -> None:
    """The distance is zero, so the engine lists a contact that has no force yet."""
    ball = body("b", "<sphere><radius>0.11</radius></sphere>", "0 0 0.11 0 0 0", mu=0.2)
    with simkit.load(world(PLANE, ball, step=step)) as sim:
        sim.model("b").set_velocity((5, 0, 0), (0, -60, 0))
        highest = 0.0
        for _ in range(round(0.2 / step)):
            sim.step()
            highest = max(highest, float(sim.model("b").pose.position[2]))
        assert highest < 0.11 + 5e-5


@pytest.mark.parametrize("step", [0.001, 0.002, 0.004])
@pytest.mark.parametrize("others", [0, 70])
def test_a_box_that_lands_on_a_plane_while_another_body_is_fast_does_not_sink(step: float, others: int) -> None:
    """The law is computed on plain numbers for few contacts and on arrays for many."""
    box = "<box><size>0.2 0.2 0.2</size></box>"
    ball = body("fast", "<sphere><radius>0.02</radius></sphere>", "5 0 5 0 0 0")
    rest = [body(f"r{i}", box, f"{-1 - i} 0 0.1 0 0 0") for i in range(others // 4)]
    with simkit.load(world(PLANE, WALL, ball, body("b", box, "0 0 0.5 0 0 0"), *rest, step=step)) as sim:
        sim.model("b").set_velocity((0, 0, -2), (0, 0, 0))
        lowest = 1.0
        for _ in range(round(0.5 / step)):
            sim.model("fast").set_pose(simkit.Pose((5, 0, 5)))
            sim.model("fast").set_velocity((120, 0, 0), (0, 0, 0))
            sim.step()
            lowest = min(lowest, float(sim.model("b").pose.position[2]))
        assert lowest > 0.1 - 3.5 * step  # the box arrives at 3.4 m/s, and a hit is detected below the surface
        assert sim.model("b").pose.position[2] == pytest.approx(0.1, abs=1e-4)


@pytest.mark.parametrize("phase", range(8))
def test_a_ball_that_rolls_into_a_wall_stops_in_every_step_of_a_window(phase: int) -> None:
    """Before the hit, the ball touches the ground and does not slide. Each phase hits in another step of a window."""
    wall = """<model name="barrier"><static>true</static><pose>1.1 0 1 0 0 0</pose><link name="l"><collision name="c">
      <geometry><box><size>0.2 2 2</size></box></geometry></collision></link></model>"""
    ball = body("b", "<sphere><radius>0.1</radius></sphere>", f"{0.7 + 0.005 * phase} 0 0.1 0 0 0")
    with simkit.load(world(PLANE, wall, ball)) as sim:
        sim.model("b").set_velocity((5, 0, 0), (0, 50, 0))
        slowest = 5.0
        for _ in range(100):
            sim.step()
            slowest = min(slowest, float(sim.link("b::l").linear_velocity[0]))
        assert -0.06 < slowest < 0.01


@pytest.mark.filterwarnings("error::RuntimeWarning")
@pytest.mark.parametrize("velocity", [1e155, 1e300])
def test_a_velocity_whose_square_overflows_diverges_without_a_warning_of_numpy(velocity: float) -> None:
    box = body("box", "<box><size>1 1 1</size></box>", "0 0 0.5 0 0 0")
    with simkit.load(world(PLANE, box)) as sim:
        sim.step(5)
        sim.model("box").set_velocity((velocity, velocity, velocity))
        with pytest.raises(simkit.SimulationDiverged):
            sim.step()
