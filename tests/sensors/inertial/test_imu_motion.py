"""Readings of an IMU on moving bodies, against formulas."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
import pytest
from sensor_worlds import noise, xyz

import simkit
from simkit.pose import quat_from_rpy, quat_to_matrix

TOP = """<inertial><mass>2</mass><inertia><ixx>{0}</ixx><iyy>{1}</iyy><izz>{2}</izz></inertia></inertial>"""


def body(mount: str, inertia: tuple[float, float, float], *, gravity: str = "0 0 -9.8", link: str = "") -> str:
    """Return a world with a free body at a height of 100 m and an IMU that samples at every step of 0.1 ms."""
    return f"""<sdf version="1.9"><world name="w"><gravity>{gravity}</gravity>
      <physics name="p" type="ode"><max_step_size>0.0001</max_step_size></physics>
      <model name="m"><pose>0 0 100 0 0 0</pose><link name="l">{link}{TOP.format(*inertia)}
      <sensor name="s" type="imu"><pose>{mount}</pose><update_rate>0</update_rate><topic>i</topic></sensor>
      </link></model></world></sdf>"""


def felt(sim: simkit.Simulation) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    message = sim.sensor("m::l::s").latest
    return xyz(message.angular_velocity), xyz(message.linear_acceleration)


def test_a_falling_spinning_ball_measures_only_the_centripetal_acceleration() -> None:
    """In free fall, the specific force at r from the centre of mass is ω×(ω×r); the sensor is rotated too."""
    mount, turn = (0.3, -0.2, 0.1), (0.4, 0.5, -0.6)
    with simkit.load(body(" ".join(map(str, (*mount, *turn))), (0.1, 0.1, 0.1))) as sim:
        omega = np.array((3.0, -4.0, 5.0))
        sim.model("m").set_velocity((1.0, 2.0, 3.0), tuple(omega))
        sim.run(0.05)
        rate, force = felt(sim)
        back = np.asarray(quat_to_matrix(quat_from_rpy(*turn))).T
        # the rate of a ball is constant, also in its own axes
        expected = back @ np.cross(omega, np.cross(omega, mount))
        np.testing.assert_allclose(rate, back @ omega, atol=1e-5)
        np.testing.assert_allclose(force, expected, atol=1e-3)


def test_a_tumbling_body_measures_the_acceleration_of_eulers_equations() -> None:
    """The acceleration at r from the centre of mass is dω/dt × r + ω×(ω×r), with dω/dt = I⁻¹·(Iω × ω)."""
    inertia, mount = np.array((0.10, 0.14, 0.2)), np.array((0.1, 0.2, -0.3))
    with simkit.load(body("0.1 0.2 -0.3 0 0 0", tuple(inertia))) as sim:
        sim.model("m").set_velocity((0.0, 0.0, 0.0), (2.0, 5.0, 1.0))
        sub = sim.subscribe("/i")
        sim.run(0.3)
        for message in sub.messages[::500]:
            omega = xyz(message.angular_velocity)
            change = np.cross(inertia * omega, omega) / inertia
            expected = np.cross(change, mount) + np.cross(omega, np.cross(omega, mount))
            np.testing.assert_allclose(xyz(message.linear_acceleration), expected, atol=5e-3)
            assert np.linalg.norm(change) > 1.0


def test_on_a_turning_arm_a_slider_measures_the_coriolis_acceleration_once() -> None:
    """A slider is on a turntable: the acceleration is r'' - ω²r radially, and 2·r'·ω + α·r along the rotation."""
    text = """<sdf version="1.9"><world name="w"><gravity>0 0 0</gravity>
      <physics name="p" type="ode"><max_step_size>0.0001</max_step_size></physics><model name="m">
      <link name="base"/><joint name="f" type="fixed"><parent>world</parent><child>base</child></joint>
      <link name="arm"/>
      <joint name="j" type="revolute"><parent>base</parent><child>arm</child><axis><xyz>0 0 1</xyz></axis></joint>
      <link name="l"><pose>0.4 0 0 0 0 0</pose><inertial><mass>0.5</mass>
        <inertia><ixx>.01</ixx><iyy>.01</iyy><izz>.01</izz></inertia></inertial>
        <sensor name="s" type="imu"><update_rate>0</update_rate></sensor></link>
      <joint name="slide" type="prismatic"><parent>arm</parent><child>l</child><axis><xyz>1 0 0</xyz></axis></joint>
      </model></world></sdf>"""
    with simkit.load(text) as sim:
        sim.joint("m::j").set_velocity(3.0)
        sim.joint("m::slide").set_velocity(1.5)
        sim.run(0.1)
        model, data = sim.mj_model, sim.engine.physics.fresh()
        dofs = [sim.joint(name).mj_dofs[0] for name in ("m::j", "m::slide")]
        (omega, out), (alpha, faster) = (values[dofs].tolist() for values in (data.qvel, data.qacc))
        r = 0.4 + sim.joint("m::slide").position
        rate, force = felt(sim)
        np.testing.assert_allclose(rate, (0, 0, omega), atol=1e-9)
        # no force acts on the slider along the arm, so the specific force along the arm is zero
        np.testing.assert_allclose(force, (faster - omega**2 * r, 2 * out * omega + alpha * r, 0), atol=1e-6)
        np.testing.assert_allclose(force[0], 0.0, atol=1e-2)
        assert abs(force[1]) > 0.5
        assert model.nv >= 2


def test_in_free_flight_the_specific_force_is_zero() -> None:
    with simkit.load(body("0.3 0 0 0 0 0", (0.1, 0.1, 0.1), gravity="1 2 -5")) as sim:
        sim.model("m").set_velocity((0.0, 0.0, 8.0), (0.0, 0.0, 0.0))
        sim.run(0.1)
        np.testing.assert_allclose(felt(sim)[1], 0.0, atol=1e-9)


def test_a_link_without_gravity_measures_gravity_too() -> None:
    """The link hovers, so it has the specific force of a link at rest. Gazebo uses the world's gravity here too."""
    with simkit.load(body("0 0 0 0 0 0", (0.1, 0.1, 0.1), link="<gravity>false</gravity>")) as sim:
        sim.run(0.1)
        np.testing.assert_allclose(felt(sim)[1], (0, 0, 9.8), atol=1e-9)


STATIC = """<sdf version="1.9"><world name="w"><model name="m"><static>true</static><pose>1 2 3 0 0 0</pose>
  <link name="l"><pose>0 0 0 0.2 0 0</pose><sensor name="s" type="imu"><update_rate>100</update_rate><imu>
  <orientation_reference_frame><localization>ENU</localization></orientation_reference_frame></imu>
  </sensor></link></model></world></sdf>"""


def test_changed_gravity_is_measured_at_once() -> None:
    for text in (STATIC, body("0 0 0 0.2 0 0", (0.1, 0.1, 0.1), link="<gravity>false</gravity>")):
        with simkit.load(text) as sim:
            sim.run(0.01)
            sim.mj_model.opt.gravity[:] = (0.0, 0.0, -1.6)
            sim.run(0.02)
            np.testing.assert_allclose(felt(sim)[1], (0, 1.6 * math.sin(0.2), 1.6 * math.cos(0.2)), atol=1e-6)


def test_a_static_model_that_is_moved_measures_gravity_and_no_jump() -> None:
    with simkit.load(STATIC) as sim:
        sim.run(0.05)
        sim.model("m").set_pose(simkit.Pose.from_rpy(4, 5, 6, 0, 0.3, 0))
        sim.run(0.05)
        rate, force = felt(sim)
        there = np.asarray(quat_to_matrix(quat_from_rpy(0, 0.3, 0))) @ quat_to_matrix(quat_from_rpy(0.2, 0, 0))
        np.testing.assert_allclose(rate, 0.0, atol=1e-12)
        np.testing.assert_allclose(force, there.T @ (0, 0, 9.8), atol=1e-9)
        q = sim.sensor("m::l::s").latest.orientation
        np.testing.assert_allclose(quat_to_matrix((q.w, q.x, q.y, q.z)), there, atol=1e-9)


# ---------------------------------------------------------------------- who looks, and when

WALK = (
    "<dynamic_bias_stddev>0.2</dynamic_bias_stddev><dynamic_bias_correlation_time>1</dynamic_bias_correlation_time>"
    "<bias_stddev>0.1</bias_stddev>"
)
NOISY = f"""<imu><angular_velocity><x>{noise(0.1, more=WALK)}</x></angular_velocity>
  <linear_acceleration><z>{noise(0.2)}</z></linear_acceleration>
  <simkit:orientation>{noise(0.01)}</simkit:orientation></imu>"""
TUMBLER = (
    body("0.1 0.2 -0.3 0.1 0.2 0.3", (0.10, 0.14, 0.2), gravity="0 0 -1")
    .replace("0.0001", "0.001")
    .replace("<topic>i</topic>", "<topic>i</topic>" + NOISY)
    .replace("<update_rate>0<", "<update_rate>130<")
    .replace("<sdf ", '<sdf xmlns:simkit="https://simkit" ')
)


def bits(message: object) -> tuple[float, ...]:
    orientation, stamp = message.orientation, message.header.stamp  # type: ignore[attr-defined]
    rate, force = message.angular_velocity, message.linear_acceleration  # type: ignore[attr-defined]
    return (
        stamp.sec * 1e9 + stamp.nanosec,
        *(orientation.w, orientation.x, orientation.y, orientation.z),
        *(rate.x, rate.y, rate.z, force.x, force.y, force.z),
    )


def run(how: str) -> list[tuple[float, ...]]:
    """Return all messages of one second, received in the way that `how` names."""
    got: list[tuple[float, ...]] = []
    with simkit.load(TUMBLER, seed=3) as sim:
        sim.model("m").set_velocity((0.0, 0.0, 0.0), (2.0, 5.0, 1.0))
        if how == "called back":
            sim.subscribe("/i", lambda message: got.append(bits(message)))
            sim.run(1.0)
        elif how == "looked at later":
            sub = sim.subscribe("/i")
            sim.run(1.0)
            got = [bits(m) for m in sub.messages]
        elif how == "looked at in between":
            sub = sim.subscribe("/i")
            for duration in (0.003, 0.2, 0.111, 0.5, 0.186):
                sim.run(duration)
                assert sub.latest is not None
            got = [bits(m) for m in sub.messages]
        elif how == "the newest kept":
            sub = sim.subscribe("/i", keep=1)
            for _ in range(1000):
                sim.step()
                if not got or bits(sub.latest) != got[-1]:
                    got.append(bits(sub.latest))
        elif how == "unread":
            for _ in range(1000):
                sim.step()
                message = sim.sensor("m::l::s").latest
                if not got or bits(message) != got[-1]:
                    got.append(bits(message))
        elif how == "who keeps comes first, who is called back later":
            sub = sim.subscribe("/i")
            sim.run(0.4)
            late: list[tuple[float, ...]] = []
            sim.subscribe("/i", lambda message: late.append(bits(message)))
            sim.run(0.6)
            got = [bits(m) for m in sub.messages]
            assert late == got[-len(late) :]
            assert len(late) == 78
        elif how == "restored":
            sim.run(0.25)
            snapshot = sim.snapshot()
            sub = sim.subscribe("/i")
            sim.run(0.3)
            sim.restore(snapshot)
            first = [bits(m) for m in sub.messages]
            sim.run(0.75)
            got = [bits(m) for m in sub.messages][len(first) :]
            assert first == got[: len(first)]
    return got


def test_readings_have_the_same_bits_for_any_subscriber_and_time() -> None:
    expected = run("called back")
    assert len(expected) == 131
    assert run("looked at later") == expected
    assert run("looked at in between") == expected
    assert run("the newest kept") == expected
    assert run("unread") == expected
    assert run("who keeps comes first, who is called back later") == expected
    restored = run("restored")
    assert restored == expected[-len(restored) :]


def test_a_closed_subscription_keeps_only_earlier_messages() -> None:
    with simkit.load(TUMBLER) as sim:
        sub, other = sim.subscribe("/i"), sim.subscribe("/i", keep=2)
        sim.run(0.1)
        sub.close()
        sim.run(0.1)
        assert len(sub.messages) == 14
        assert len(other.messages) == 2
        assert [m.header.stamp.nanosec for m in other.messages][-1] == 200_000_000
        sim.reset()
        assert len(sub.messages) == 14


@pytest.mark.parametrize("keep", [1, 5, 200])
def test_a_bounded_subscription_keeps_the_newest(keep: int) -> None:
    with simkit.load(TUMBLER) as sim:
        every, some = sim.subscribe("/i"), sim.subscribe("/i", keep=keep)
        sim.run(1.0)
        assert [bits(m) for m in some.messages] == [bits(m) for m in every.messages][-keep:]
