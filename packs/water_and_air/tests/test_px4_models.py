"""Vehicles with the numbers of PX4's models open without a warning and fly: quadrotor, aeroplane, VTOL."""

from __future__ import annotations

import math

import numpy as np
import px4_worlds
import pytest

import simkit

G = 9.8


def send(sim: simkit.Simulation, model: str, *speeds: float) -> None:
    sim.publish(f"/{model}/command/motor_speed", {"velocity": list(speeds)})


@pytest.mark.parametrize("text", [px4_worlds.x500(), px4_worlds.advanced_plane(), px4_worlds.standard_vtol()])
def test_the_models_open_without_a_warning(text: str) -> None:
    with simkit.load(text) as sim:
        assert [str(found) for found in sim.diagnostics if found.severity != "note"] == []
        sim.step(5)


def test_the_x500_takes_off_and_hovers_by_speeds_of_its_rotors() -> None:
    with simkit.load(px4_worlds.x500()) as sim:
        mass = 2.0 + 4 * 0.016
        hover = math.sqrt(mass * G / (4 * px4_worlds.THRUST))
        body = sim.link("x500::base_link")
        for _ in range(300):  # an altitude controller at 50 Hz; the attitude needs none without disturbances
            error, speed = 2.0 - float(body.pose.position[2]), float(body.linear_velocity[2])
            force = mass * (G + 4 * error - 4 * speed)
            send(sim, "x500", *[math.sqrt(max(force, 0) / (4 * px4_worlds.THRUST))] * 4)
            sim.run(0.02)
        assert body.pose.position[2] == pytest.approx(2.0, abs=0.01)
        assert 10 * sim.joint("x500::rotor_0_joint").velocity == pytest.approx(hover, rel=5e-3)
        assert np.abs(body.pose.rpy).max() < 1e-3


def test_the_aeroplane_flies_straight_and_rolls_at_the_rate_of_its_ailerons() -> None:
    with simkit.load(px4_worlds.advanced_plane()) as sim:
        mass, speed, area, span = 1.016, 15.0, 0.34, math.sqrt(0.34 * 6.5)
        pressed = 0.5 * 1.2041 * speed**2 * area
        lift = mass * G / pressed
        alpha = (lift - 0.15188) / 5.015
        drag = 0.029 + lift**2 / (math.pi * 6.5 * 0.97)
        # the moment of the lift about the centre of mass, 0.12 m before the reference point, and the wing's own moment
        moment = 0.12 * lift / 0.22 - (0.075 - 0.463966 * alpha) + 0.3 * 0.016 * G / pressed / 0.22
        elevator = math.radians(moment / 0.025798)
        plane, body = sim.model("advanced_plane"), sim.link("advanced_plane::base_link")
        plane.set_pose(simkit.Pose.from_rpy(0, 0, 100, 0, -alpha, 0))
        plane.set_velocity((speed, 0, 0), (0, 0, 0))
        sim.joint("advanced_plane::servo_2").set_position(elevator)
        sim.publish("/model/advanced_plane/servo_2", {"data": elevator})
        send(sim, "advanced_plane", math.sqrt(drag * pressed / px4_worlds.PULL))
        sim.run(5.0)
        assert np.linalg.norm(body.linear_velocity) == pytest.approx(speed, rel=0.1)
        assert body.pose.position[2] == pytest.approx(100, abs=10)
        assert abs(body.pose.rpy[0]) < 0.2
        flown = float(np.linalg.norm(body.linear_velocity))
        for servo, angle in (("servo_0", 0.1), ("servo_1", -0.1)):
            sim.publish(f"/model/advanced_plane/{servo}", {"data": angle})
        sim.run(0.7)
        rolling = float((np.asarray(body.pose.matrix).T @ body.angular_velocity)[0])
        steady = -2 * math.degrees(0.1) * 0.003331 / 0.487407 * 2 * flown / span
        assert rolling == pytest.approx(steady, rel=0.25)


@pytest.mark.slow  # slow: a controller in Python for 11 s of flight
def test_the_wing_of_the_vtol_relieves_its_rotors_in_forward_flight() -> None:
    with simkit.load(px4_worlds.standard_vtol(20.0)) as sim:
        mass = 1.0 + 5 * 0.016
        model, body = sim.model("standard_vtol"), sim.link("standard_vtol::base_link")

        def hold(seconds: float, pull: float) -> float:
            """Hold altitude and attitude by the rotors; return their mean lift [N]."""
            lifts = []
            for _ in range(round(seconds / 0.02)):
                axes = np.asarray(body.pose.matrix)
                spin, (roll, pitch, _) = axes.T @ body.angular_velocity, body.pose.rpy
                error, rise = 20.0 - float(body.pose.position[2]), float(body.linear_velocity[2])
                lift = max(mass * (G + 2 * error - 3 * rise), 0.0)
                torques = -0.2 * np.array((40 * roll, 40 * pitch, 0)) - 0.2 * np.array((10, 10, 2)) * spin
                squares = []
                for x, y, way in px4_worlds.ROTORS:
                    sign = 1 if way == "ccw" else -1
                    share = lift / 4 + torques[0] * y / (4 * 0.174**2) - torques[1] * x / (4 * 0.174**2)
                    squares.append((share - sign * torques[2] / (4 * 0.016)) / px4_worlds.THRUST)
                speeds = [math.sqrt(min(max(square, 0.0), 1e6)) for square in squares]
                send(sim, "standard_vtol", *speeds, math.sqrt(pull / px4_worlds.PULL))
                lifts.append(lift)
                sim.run(0.02)
            return float(np.mean(lifts[-25:]))

        hovering = hold(3.0, 0.0)
        assert hovering == pytest.approx(mass * G, rel=0.05)
        assert np.linalg.norm(body.linear_velocity) < 0.5
        flying = hold(8.0, 3.0)
        speed = float(body.linear_velocity[0])
        assert speed > 10
        along, _, down = np.asarray(body.pose.matrix).T @ body.linear_velocity
        alpha = math.atan2(-down, along)
        wing = 0.5 * 1.2041 * speed**2 * 0.34 * (0.15188 + 5.015 * alpha)
        turning = [10 * sim.joint(f"standard_vtol::rotor_{i}_joint").velocity for i in range(4)]
        rotors = px4_worlds.THRUST * sum(value**2 for value in turning)
        assert wing + rotors == pytest.approx(mass * G, rel=0.1)
        assert flying < 0.7 * hovering
        assert model.pose.position[2] == pytest.approx(20, abs=2)
