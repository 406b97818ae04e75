"""Reference frame of the IMU's orientation, and Classic's options, compared with rotation matrices."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
import pytest
from sensor_worlds import sensor, world

import simkit
from simkit.pose import quat_from_rpy, quat_to_matrix

Matrix = npt.NDArray[np.float64]
EARTH = (
    "<spherical_coordinates><surface_model>EARTH_WGS84</surface_model><latitude_deg>45</latitude_deg>"
    "<longitude_deg>7</longitude_deg><elevation>0</elevation><heading_deg>{}</heading_deg></spherical_coordinates>"
)
POST = """<model name="post"><static>true</static><pose>5 0 0 0 0 0.7</pose>
  <link name="top"><pose>0 0 1 0.2 0 0</pose></link></model>"""


def turned(roll: float, pitch: float, yaw: float) -> Matrix:
    return np.asarray(quat_to_matrix(quat_from_rpy(roll, pitch, yaw)))


def reference(localization: str, content: str = "") -> str:
    words = f"<localization>{localization}</localization>" if localization else ""
    return f"<imu><orientation_reference_frame>{words}{content}</orientation_reference_frame></imu>"


def scene(block: str, pose: str = "0 0 1 0.3 -0.2 0.5", mount: str = "0.1 0 0 0 0 0.4", top: str = "") -> str:
    body = '<frame name="rig"><pose>0 0 0 0 0.6 0</pose></frame>'
    text = world(sensor("imu", block, pose=mount), pose=pose, others=POST, top=top)
    return text.replace('<link name="l">', body + '<link name="l">', 1)


def measured(text: str) -> Matrix:
    """Return the measured orientation as a matrix, whose columns are the sensor's axes in the reference frame."""
    with simkit.load(text) as sim:
        sim.run(0.02)
        q = sim.sensor("m::l::s").latest.orientation
        return np.asarray(quat_to_matrix((q.w, q.x, q.y, q.z)))


MODEL = turned(0.3, -0.2, 0.5)
OWN = MODEL @ turned(0, 0, 0.4)
RPY = "0.1 0.2 0.3"
TURN = turned(0.1, 0.2, 0.3)


@pytest.mark.parametrize(
    ("localization", "axes"),
    [
        # the columns are the reference's axes in east, north, up
        ("ENU", [[1, 0, 0], [0, 1, 0], [0, 0, 1]]),
        ("NED", [[0, 1, 0], [1, 0, 0], [0, 0, -1]]),
        ("NWU", [[0, -1, 0], [1, 0, 0], [0, 0, 1]]),
    ],
)
@pytest.mark.parametrize("heading", [0.0, 30.0])
def test_named_axes_follow_the_maps_heading(localization: str, axes: list[list[float]], heading: float) -> None:
    expected = (turned(0, 0, math.radians(heading)) @ np.array(axes, float)).T @ OWN
    np.testing.assert_allclose(measured(scene(reference(localization), top=EARTH.format(heading))), expected, atol=1e-9)


@pytest.mark.parametrize(
    ("parent", "frame"),
    [
        ("", OWN),
        ("world", np.eye(3)),
        ("m", MODEL),
        ("l", MODEL),
        ("m::l", MODEL),
        ("__model__", MODEL),
        ("rig", MODEL @ turned(0, 0.6, 0)),
        ("m::rig", MODEL @ turned(0, 0.6, 0)),
        ("post", turned(0, 0, 0.7)),
        ("post::top", turned(0, 0, 0.7) @ turned(0.2, 0, 0)),
    ],
)
def test_a_custom_reference_is_turned_from_its_parent_frame(parent: str, frame: Matrix) -> None:
    block = reference("CUSTOM", f'<custom_rpy parent_frame="{parent}">{RPY}</custom_rpy>')
    np.testing.assert_allclose(measured(scene(block)), (frame @ TURN).T @ OWN, atol=1e-9)


def test_an_empty_reference_is_the_attitude_at_the_start() -> None:
    for block in (reference(""), reference("CUSTOM"), "<imu/>"):
        np.testing.assert_allclose(measured(scene(block)), np.eye(3), atol=1e-9)


@pytest.mark.parametrize("gravity", [(0, 0, -9.8), (1.0, -2.0, -3.0)])
@pytest.mark.parametrize(
    ("direction", "parent", "frame"), [("1 0 0", "world", np.eye(3)), ("0 1 0.5", "", OWN), ("1 2 3", "m", MODEL)]
)
def test_by_gravity_z_is_its_direction_and_x_the_level_part_of_a_vector(
    gravity: tuple[float, float, float], direction: str, parent: str, frame: Matrix
) -> None:
    top = "<gravity>{} {} {}</gravity>".format(*gravity)
    for localization, sign in (("GRAV_UP", -1.0), ("GRAV_DOWN", 1.0)):
        block = reference(localization, f'<grav_dir_x parent_frame="{parent}">{direction}</grav_dir_x>')
        z = sign * np.array(gravity) / np.linalg.norm(gravity)
        wanted = frame @ np.array([float(v) for v in direction.split()])
        x = wanted - z * (wanted @ z)
        x /= np.linalg.norm(x)
        expected = np.stack((x, np.cross(z, x), z)) @ OWN
        np.testing.assert_allclose(measured(scene(block, top=top)), expected, atol=1e-9)


def test_at_rest_gravity_up_makes_the_specific_force_its_z_axis() -> None:
    with simkit.load(scene(reference("GRAV_UP"))) as sim:
        sim.run(0.02)
        message = sim.sensor("m::l::s").latest
        q, a = message.orientation, message.linear_acceleration
        force = quat_to_matrix((q.w, q.x, q.y, q.z)) @ (a.x, a.y, a.z)
        np.testing.assert_allclose(force, (0, 0, 9.8), atol=1e-9)


@pytest.mark.parametrize(
    ("block", "top", "code", "words"),
    [
        (reference("CUSTOM", f'<custom_rpy parent_frame="pots">{RPY}</custom_rpy>'), "", "SK-SENSOR-070", "'post'"),
        (reference("CUSTOM", f'<custom_rpy parent_frame="rigg">{RPY}</custom_rpy>'), "", "SK-SENSOR-070", "'rig'"),
        (reference("GRAV_UP", '<grav_dir_x parent_frame="world">0 0 2</grav_dir_x>'), "", "SK-SENSOR-071", "parallel"),
        (reference("GRAV_UP"), "<gravity>0 0 0</gravity>", "SK-SENSOR-071", "no gravity"),
        (reference("UPWARDS"), "", "SK-PARAM-002", "GRAV_DOWN"),
    ],
)
def test_an_undefined_reference_is_an_error(block: str, top: str, code: str, words: str) -> None:
    with pytest.raises(simkit.LoadError) as caught:
        simkit.load(scene(block, top=top))
    found = [d for d in caught.value.diagnostics if d.code == code]
    assert len(found) == 1
    assert words in str(found[0])
    assert found[0].line


@pytest.mark.parametrize(
    ("block", "says"),
    [
        (reference("GRAV_UP"), 1),
        (reference("CUSTOM", f'<custom_rpy parent_frame="post">{RPY}</custom_rpy>'), 1),
        (reference("CUSTOM"), 0),
    ],
)
def test_with_gazebos_quirks_an_unsupported_reference_is_the_attitude_at_the_start(block: str, says: int) -> None:
    text = scene(block, top="<gazebo_quirks>true</gazebo_quirks>")
    np.testing.assert_allclose(measured(text), np.eye(3), atol=1e-9)
    with simkit.load(text) as sim:
        assert [d.severity for d in sim.diagnostics if d.code == "SK-SENSOR-002"] == ["warning"] * says


def test_a_spawned_robot_measures_orientation_relative_to_its_spawn_pose() -> None:
    with simkit.load(scene("<imu/>")) as sim:
        block = reference("CUSTOM", '<custom_rpy parent_frame="base">0 0 0</custom_rpy>')
        robot = f'<sdf version="1.9"><model name="r"><link name="base"/><link name="l">{sensor("imu", block)}</link>'
        robot += '<joint name="j" type="fixed"><parent>base</parent><child>l</child></joint></model></sdf>'
        sim.spawn(robot, name="r2", pose=simkit.Pose.from_rpy(0, 0, 3, 0.1, 0.2, 0.3))
        sim.run(0.01)
        assert abs(sim.sensor("r2::l::s").latest.orientation.w) == pytest.approx(1.0)


# ---------------------------------------------------------------------- orientation noise


def test_noise_on_the_orientation_turns_it_by_its_deviation() -> None:
    noise = '<orientation><noise type="gaussian"><stddev>0.02</stddev></noise><z><noise type="none"/></z></orientation>'
    with simkit.load(scene(f"<imu>{noise}</imu>")) as sim:
        sub = sim.subscribe("/world/w/model/m/link/l/sensor/s/imu")
        sim.run(20.0)
        q = np.array([(m.orientation.w, m.orientation.x, m.orientation.y, m.orientation.z) for m in sub.messages])
        np.testing.assert_allclose(np.linalg.norm(q, axis=1), 1.0, atol=1e-12)
        np.testing.assert_allclose(2 * q[:, 1:3].std(axis=0), 0.02, rtol=0.05)
        assert np.abs(2 * q[:, 3]).max() < 1e-3
        np.testing.assert_allclose(sub.latest.orientation_covariance[[0, 4, 8]], (4e-4, 4e-4, 0))
        assert sim.sensor("m::l::s").truth.orientation.w == pytest.approx(1.0)
        assert sub.latest.linear_acceleration.z == sim.sensor("m::l::s").truth.linear_acceleration.z


def test_noise_on_the_orientation_leaves_that_of_the_other_channels() -> None:
    rate = '<angular_velocity><x><noise type="gaussian"><stddev>0.1</stddev></noise></x></angular_velocity>'
    more = '<orientation><noise type="gaussian"><stddev>0.02</stddev></noise></orientation>'
    found = []
    for block in (rate, rate + more):
        with simkit.load(scene(f"<imu>{block}</imu>"), seed=5) as sim:
            sim.run(0.05)
            found.append(sim.sensor("m::l::s").latest.angular_velocity.x)
    assert found[0] == found[1] != 0


# ---------------------------------------------------------------------- Classic


def classic(plugin: str, pose: str = "0 0 1 0 0 0.5") -> str:
    block = f'<imu/><plugin name="node" filename="libgazebo_ros_imu_sensor.so">{plugin}</plugin>'
    return world(sensor("imu", block), pose=pose)


def test_classics_noise_is_on_everything_it_publishes() -> None:
    with simkit.load(classic("<gaussianNoise>0.05</gaussianNoise>")) as sim:
        sub = sim.subscribe("/node/out")
        sim.run(20.0)
        messages = sub.messages
        for get in (lambda m: m.angular_velocity, lambda m: m.linear_acceleration):
            values = np.array([(get(m).x, get(m).y, get(m).z) for m in messages])
            np.testing.assert_allclose(values.std(axis=0), 0.05, rtol=0.07)
        assert np.std([2 * m.orientation.x for m in messages]) == pytest.approx(0.05, rel=0.07)
        for name in ("orientation", "angular_velocity", "linear_acceleration"):
            np.testing.assert_allclose(getattr(messages[-1], name + "_covariance")[[0, 4, 8]], 0.0025)


def test_classics_offset_turns_the_orientation_before_the_sensors_own() -> None:
    with simkit.load(classic("<rpyOffset>0.3 0 0</rpyOffset>")) as sim:
        sim.run(0.02)
        q = sim.sensor("m::l::s").latest.orientation
        expected = turned(0.3, 0, 0) @ turned(0, 0, 0.5)
        np.testing.assert_allclose(quat_to_matrix((q.w, q.x, q.y, q.z)), expected, atol=1e-9)


def test_classics_rate_and_frames() -> None:
    plugin = "<updateRateHZ>20</updateRateHZ><bodyName>l</bodyName><frameName>imu_frame</frameName>"
    with simkit.load(classic(plugin)) as sim:
        sub = sim.subscribe("/node/out")
        sim.run(1.0)
        assert 20 <= len(sub.messages) <= 21
        assert sub.latest.header.frame_id == "imu_frame"
    with simkit.load(classic("<updateRateHZ>500</updateRateHZ><bodyName>torso</bodyName>")) as sim:
        sub = sim.subscribe("/node/out")
        sim.run(1.0)
        assert 100 <= len(sub.messages) <= 101
        assert sub.latest.header.frame_id == "torso"


def test_classics_position_offset_has_no_effect_and_is_reported() -> None:
    with simkit.load(classic("<xyzOffset>0 0 1</xyzOffset>")) as sim:
        assert [d.severity for d in sim.diagnostics if d.code == "SK-SENSOR-072"] == ["note"]
    with simkit.load(classic("<xyzOffset>0 0 0</xyzOffset>")) as sim:
        assert not [d for d in sim.diagnostics if d.code.startswith("SK-SENSOR")]
