"""PX4's plugins of Gazebo Classic: hover over MAVLink, frames and units, lock-step, joints, and hostile peers."""

from __future__ import annotations

import math
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any

import numpy as np
import pytest
from pilot_peers import PLACES, G, MavlinkPeer, hover_shares, vehicle

import simkit
from simkit_water_and_air.plugins.autopilots.mavlink import encode
from simkit_water_and_air.plugins.classic.mavlink_interface import GazeboMavlinkInterface

THRUST, MOST, STEP = 5.84e-6, 1100.0, 0.004
THRUST_AT_FULL = THRUST * MOST**2
HOME = 47.397742, 8.545594, 488.0
MOTORS = "".join(
    f"""<plugin name="motor_{i}" filename="libgazebo_motor_model.so"><robotNamespace/>
      <jointName>rotor_{i}_joint</jointName><linkName>rotor_{i}</linkName><motorNumber>{i}</motorNumber>
      <turningDirection>{"ccw" if way > 0 else "cw"}</turningDirection><maxRotVelocity>{MOST}</maxRotVelocity>
      <timeConstantUp>0.0125</timeConstantUp><timeConstantDown>0.025</timeConstantDown>
      <motorConstant>{THRUST}</motorConstant><momentConstant>0.06</momentConstant>
      <commandSubTopic>/gazebo/command/motor_speed</commandSubTopic><rotorDragCoefficient>0.000175</rotorDragCoefficient>
      <rollingMomentCoefficient>1e-06</rollingMomentCoefficient><motorSpeedPubTopic>/motor_speed/{i}</motorSpeedPubTopic>
      <rotorVelocitySlowdownSim>10</rotorVelocitySlowdownSim></plugin>"""
    for i, (_, _, way) in enumerate(PLACES)
)
CHANNELS = "".join(
    f"""<channel name="rotor{i + 1}"><input_index>{i}</input_index><input_offset>0</input_offset>
      <input_scaling>1000</input_scaling><zero_position_disarmed>0</zero_position_disarmed>
      <zero_position_armed>100</zero_position_armed><joint_control_type>velocity</joint_control_type></channel>"""
    for i in range(4)
)
SENSORS = """<plugin name="imu" filename="libgazebo_imu_plugin.so"><robotNamespace/><linkName>base_link</linkName>
    <imuTopic>/imu</imuTopic><gyroscopeNoiseDensity>0.00018665</gyroscopeNoiseDensity>
    <gyroscopeRandomWalk>3.8785e-05</gyroscopeRandomWalk><gyroscopeBiasCorrelationTime>1000</gyroscopeBiasCorrelationTime>
    <gyroscopeTurnOnBiasSigma>0.0087</gyroscopeTurnOnBiasSigma>
    <accelerometerNoiseDensity>0.00186</accelerometerNoiseDensity><accelerometerRandomWalk>0.006</accelerometerRandomWalk>
    <accelerometerBiasCorrelationTime>300</accelerometerBiasCorrelationTime>
    <accelerometerTurnOnBiasSigma>0</accelerometerTurnOnBiasSigma></plugin>
  <plugin name="mag" filename="libgazebo_magnetometer_plugin.so"><robotNamespace/><pubRate>100</pubRate>
    <noiseDensity>0.0004</noiseDensity><randomWalk>6.4e-06</randomWalk><biasCorrelationTime>600</biasCorrelationTime>
    <magTopic>/mag</magTopic></plugin>
  <plugin name="baro" filename="libgazebo_barometer_plugin.so"><robotNamespace/><pubRate>50</pubRate>
    <baroTopic>/baro</baroTopic><baroDriftPaPerSec>0</baroDriftPaPerSec></plugin>
  <plugin name="truth" filename="libgazebo_groundtruth_plugin.so"><robotNamespace/></plugin>
  <plugin name="rosbag" filename="libgazebo_multirotor_base_plugin.so"><robotNamespace/><linkName>base_link</linkName>
    <rotorVelocitySlowdownSim>10</rotorVelocitySlowdownSim></plugin>
  <model name="gps0"><link name="link"><inertial><mass>0.01</mass><inertia><ixx>2e-6</ixx><iyy>2e-6</iyy><izz>2e-6</izz>
    </inertia></inertial><sensor name="gps" type="gps"><plugin name="gps_plugin" filename="libgazebo_gps_plugin.so">
    <robotNamespace/><gpsNoise>1</gpsNoise><gpsXYRandomWalk>2.0</gpsXYRandomWalk><gpsZRandomWalk>4.0</gpsZRandomWalk>
    <gpsXYNoiseDensity>0.0002</gpsXYNoiseDensity><gpsZNoiseDensity>0.0004</gpsZNoiseDensity>
    <gpsVXYNoiseDensity>0.2</gpsVXYNoiseDensity><gpsVZNoiseDensity>0.4</gpsVZNoiseDensity></plugin></sensor></link></model>
  <joint name="gps0_joint" type="fixed"><parent>base_link</parent><child>gps0::link</child></joint>"""


def px4(more: str = "", channels: str = CHANNELS) -> str:
    return f"""<plugin name="mavlink_interface" filename="libgazebo_mavlink_interface.so"><robotNamespace/>
      <imuSubTopic>/imu</imuSubTopic><magSubTopic>/mag</magSubTopic><baroSubTopic>/baro</baroSubTopic>
      <mavlink_addr>INADDR_ANY</mavlink_addr><mavlink_tcp_port>0</mavlink_tcp_port>
      <mavlink_udp_port>14560</mavlink_udp_port><serialEnabled>0</serialEnabled><serialDevice>/dev/ttyACM0</serialDevice>
      <baudRate>921600</baudRate><qgc_addr>INADDR_ANY</qgc_addr><qgc_udp_port>14550</qgc_udp_port>
      <sdk_addr>INADDR_ANY</sdk_addr><sdk_udp_port>14540</sdk_udp_port><hil_mode>0</hil_mode>
      <hil_state_level>0</hil_state_level><vehicle_is_tailsitter>0</vehicle_is_tailsitter>
      <send_vision_estimation>0</send_vision_estimation><send_odometry>1</send_odometry>
      <enable_lockstep>1</enable_lockstep><use_tcp>1</use_tcp>
      <motorSpeedCommandPubTopic>/gazebo/command/motor_speed</motorSpeedCommandPubTopic>
      <control_channels>{channels}</control_channels>{more}</plugin>"""


def iris(more: str = "", channels: str = CHANNELS, sensors: str = SENSORS) -> str:
    place = f"""<spherical_coordinates><surface_model>EARTH_WGS84</surface_model><latitude_deg>{HOME[0]}</latitude_deg>
      <longitude_deg>{HOME[1]}</longitude_deg><elevation>{HOME[2]}</elevation></spherical_coordinates>"""
    return vehicle(MOTORS + px4(more, channels) + sensors, step=STEP, world=place)


def plugin_of(sim: simkit.Simulation) -> GazeboMavlinkInterface:
    return next(p for p in sim.engine.structure.all_plugins() if isinstance(p, GazeboMavlinkInterface))


@contextmanager
def connected(text: str) -> Iterator[tuple[simkit.Simulation, MavlinkPeer]]:
    """Load a world, open the plugin's port by one step, and connect a peer; the second step accepts it."""
    with simkit.load(text) as sim:
        sim.step(1)
        peer = MavlinkPeer(plugin_of(sim).port)
        sim.step(1)
        try:
            yield sim, peer
        finally:
            peer.close()


def codes(sim: simkit.Simulation) -> list[str]:
    return [d.code for d in sim.diagnostics if d.code.startswith("SK-PILOT")]


def controls_for(state: dict[str, Any], target: Any) -> np.ndarray:
    truth = state["HIL_STATE_QUATERNION"]
    north = math.radians(truth["lat"] * 1e-7 - HOME[0]) * 6.367e6
    east = math.radians(truth["lon"] * 1e-7 - HOME[1]) * 6.389e6 * math.cos(math.radians(HOME[0]))
    position = (north, east, HOME[2] - truth["alt"] * 1e-3)
    velocity = np.array([truth["vx"], truth["vy"], truth["vz"]]) * 0.01
    gyro = truth["rollspeed"], truth["pitchspeed"], truth["yawspeed"]
    attitude = truth["attitude_quaternion"]
    shares = hover_shares(position, velocity, attitude, gyro, target, THRUST_AT_FULL, yaw_gain=0.3)
    return np.maximum((shares * MOST - 100) / 1000, 0.0)


def fly(sim: simkit.Simulation, peer: MavlinkPeer, steps: int, target: Any) -> list[dict[str, Any]]:
    """Answer every state of some steps."""
    states = []
    for _ in range(steps):
        states.append(peer.receive())
        peer.send(controls_for(states[-1], target))
        sim.step(1)
    return states


@pytest.mark.slow
def test_a_quadrotor_flies_to_a_place_over_mavlink_and_hovers() -> None:
    with connected(iris()) as (sim, peer):
        states = fly(sim, peer, 1000, (0.3, -0.2, -2.3))
        east, north, up = sim.model("quad").pose.position
        assert (north, east, up) == pytest.approx((0.3, -0.2, 2.3), abs=0.05)
        assert sim.link("quad::base_link").linear_velocity == pytest.approx([0, 0, 0], abs=0.03)
        hover = math.sqrt(1.61 * G / (4 * THRUST)) / 10  # the joints turn ten times slower than the rotors
        turning = [abs(sim.joint(f"quad::rotor_{i}_joint").velocity) for i in range(4)]
        assert np.mean(turning) == pytest.approx(hover, rel=0.01)
        found = [d.code for d in sim.diagnostics if d.severity != "note"]
        assert not found
        check_sensors(states, up)


def check_sensors(states: list[dict[str, Any]], height: float) -> None:
    """Check rates, units and means of the sensors at a hover."""
    count = len(states)
    sensors = [state["HIL_SENSOR"] for state in states]
    assert [s["time_usec"] for s in sensors] == list(range(8000, 8000 + 4000 * count, 4000))
    with_field = [s for s in sensors if int(s["fields_updated"]) & 0x1C0]
    with_pressure = [s for s in sensors if int(s["fields_updated"]) & 0x200]
    assert len(with_field) == pytest.approx(count * STEP * 100, abs=3)
    assert len(with_pressure) == pytest.approx(count * STEP * 50, abs=3)
    fixes = [state["HIL_GPS"] for state in states if "HIL_GPS" in state]
    assert len(fixes) == pytest.approx(count * STEP * 5, abs=2)
    assert sum("HEARTBEAT" in state for state in states) == math.ceil(count * STEP)
    last = sensors[-250:]
    assert np.mean([s["zacc"] for s in last]) == pytest.approx(-G, abs=0.1)
    pressure = 1013.25 / (288.0 / (288.0 - 0.0065 * (488 + height))) ** 5.256
    assert np.mean([s["abs_pressure"] for s in with_pressure[-50:]]) == pytest.approx(pressure, abs=0.01)
    assert np.mean([s["pressure_alt"] for s in with_pressure[-50:]]) == pytest.approx(488 + height, abs=0.1)
    strength = np.mean([math.hypot(s["xmag"], s["ymag"], s["zmag"]) for s in with_field])
    assert strength == pytest.approx(0.486, abs=0.005)  # Zurich in 2025 [gauss]
    assert fixes[-1]["lat"] * 1e-7 == pytest.approx(HOME[0], abs=2e-5) and fixes[-1]["fix_type"] == 3
    assert fixes[-1]["alt"] == pytest.approx(1000 * (488 + height), abs=2000)
    late = [state["HIL_SENSOR"]["time_usec"] - state["HIL_GPS"]["time_usec"] for state in states if "HIL_GPS" in state]
    assert late[-1] == 120_000


def test_frames_of_a_state() -> None:
    text = iris(sensors="").replace("<pose>0 0 2.0 0 0 0</pose>", "<pose>3 7 2 0.1 0.2 0.5</pose>")
    with simkit.load(text) as sim:
        sim.step(1)
        sim.model("quad").set_velocity((1.0, 2.0, 3.0), (0.0, 0.0, 0.4))
        peer = MavlinkPeer(plugin_of(sim).port)
        sim.step(1)
        state = peer.receive()
        peer.close()
        truth, sensor = state["HIL_STATE_QUATERNION"], state["HIL_SENSOR"]
        assert (truth["vx"], truth["vy"], truth["vz"]) == pytest.approx(
            (200, 100, -296), abs=2
        )  # cm/s, one step falling
        w, x, y, z = truth["attitude_quaternion"]
        assert math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)) == pytest.approx(math.pi / 2 - 0.5, abs=3e-3)
        assert math.asin(2 * (w * y - z * x)) == pytest.approx(-0.2, abs=3e-3)
        assert math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)) == pytest.approx(0.1, abs=3e-3)
        up = sim.link("quad::base_link").pose.matrix[2]
        gyro = sensor["xgyro"], sensor["ygyro"], sensor["zgyro"]
        assert gyro == pytest.approx((0.4 * up[0], -0.4 * up[1], -0.4 * up[2]), abs=2e-3)
        assert abs(sensor["zacc"]) < 0.1  # free fall
        assert math.radians(truth["lat"] * 1e-7 - HOME[0]) * 6.367e6 == pytest.approx(7, abs=0.05)
        assert codes(sim) == ["SK-PILOT-005"]  # true values, because there is no plugin of an IMU


def test_the_airspeed_sensor_measures_the_wind_and_the_motion_along_its_link() -> None:
    air = """<plugin name="air" filename="libgazebo_airspeed_plugin.so"><robotNamespace/>
      <DiffPressureStdev>0</DiffPressureStdev></plugin>"""
    text = iris(sensors=SENSORS + air).replace(
        "<gravity>", "<wind><linear_velocity>-3 0 0</linear_velocity></wind><gravity>"
    )
    assert "<wind>" in text
    with simkit.load(text) as sim:
        sim.step(1)
        peer = MavlinkPeer(plugin_of(sim).port)
        sim.model("quad").set_velocity((12.0, 0.0, 0.0))
        readings = []
        for _ in range(100):
            sim.step(1)
            sensor = peer.receive()["HIL_SENSOR"]
            peer.send(np.zeros(4))
            if sensor["fields_updated"] & 1 << 10:
                readings.append(sensor["diff_pressure"])
        peer.close()
    assert 2 <= len(readings) <= 5  # 10 Hz in 0.4 s or less, and the first reading
    density = 1.225 / (288.0 / (288.0 - 0.0065 * 490.0)) ** 4.256
    assert readings[0] == pytest.approx(0.005 * density * 15.0**2, rel=0.02)


def test_disarmed_outputs_and_old_commands_stop_the_motors() -> None:
    with connected(iris("<simkit:peer_timeout>0.3</simkit:peer_timeout>")) as (sim, peer):
        peer.receive()
        peer.send([1.0] * 4, mode=0)
        sim.step(1)
        assert not any(plugin_of(sim)._targets)
        peer.send([0.5] * 4)
        sim.step(10)  # the second step waits in vain: the connection is lost, and the motors stop
        assert codes(sim) == ["SK-PILOT-003"] and not plugin_of(sim).is_connected
        sim.step(50)
        assert sim.joint("quad::rotor_0_joint").velocity == pytest.approx(0, abs=0.1)


def test_channels_move_joints_by_a_pid_and_publish_on_topics() -> None:
    pid = "<joint_control_pid><p>0.02</p><d>0.004</d><cmdMax>2</cmdMax><cmdMin>-2</cmdMin></joint_control_pid>"
    channel = """<channel name="c"><input_index>{}</input_index><input_offset>1</input_offset>
      <input_scaling>0.5</input_scaling><joint_control_type>{}</joint_control_type><joint_name>rotor_{}_joint</joint_name>
      <gztopic>flap</gztopic>{}</channel>"""
    channels = "".join(
        channel.format(place, kind, place, pid.replace("<d>0.004</d>", "") if kind == "velocity" else pid)
        for place, kind in enumerate(("position", "velocity", "position_kinematic", "position_gztopic"))
    )
    channels += channel.format(5, "position", 9, pid)
    fixed = '<joint name="mast" type="fixed"><parent>world</parent><child>base_link</child></joint>'
    with connected(vehicle(px4("", channels) + fixed, step=0.001)) as (sim, peer):
        heard: list[float] = []
        sim.subscribe("/quad/flap", lambda message: heard.append(message.data))
        for _ in range(900):
            peer.receive()
            peer.send([0.5, 1.0, 0.2, -0.4])
            sim.step(1)
        assert sim.joint("quad::rotor_0_joint").position == pytest.approx(0.75, abs=0.01)
        assert sim.joint("quad::rotor_1_joint").velocity == pytest.approx(1.0, abs=0.01)
        assert sim.joint("quad::rotor_2_joint").position == pytest.approx(0.6, abs=1e-6)
        assert len(heard) > 890 and heard == pytest.approx([0.3] * len(heard))
        assert "SK-PILOT-006" in codes(sim)


# ---------------------------------------------------------------------------------------------- lock-step, repetition


def test_equal_commands_give_equal_messages_and_bits() -> None:
    runs = []
    for _ in range(2):
        with connected(iris()) as (sim, peer):
            states = fly(sim, peer, 60, (0.0, 0.0, -2.0))
            runs.append((states, sim.mj_data.qpos.tobytes()))
    assert runs[0] == runs[1]


def test_after_a_restore_and_a_reset_the_bits_repeat_and_the_clock_of_px4_goes_on() -> None:
    def bits(sim: simkit.Simulation) -> bytes:
        return bytes(sim.mj_data.qpos.tobytes() + sim.mj_data.qvel.tobytes())

    with connected(iris()) as (sim, peer):
        target = (0.0, 0.0, -2.0)
        fly(sim, peer, 20, target)
        snapshot, height = sim.snapshot(), sim.model("quad").pose.position[2]
        fly(sim, peer, 25, target)
        after = bits(sim)
        last = peer.receive()
        peer.send(controls_for(last, target))  # PX4 answers the last state; simkit drops this answer
        sim.restore(snapshot)
        again: list[dict[str, Any]] = []

        def answer() -> None:
            again.append(peer.receive())
            peer.send(controls_for(again[0], target))

        helper = threading.Thread(target=answer)
        helper.start()
        sim.step(1)
        helper.join()
        fly(sim, peer, 24, target)
        assert bits(sim) == after
        assert again[0]["HIL_SENSOR"]["time_usec"] == last["HIL_SENSOR"]["time_usec"] + 4000
        assert again[0]["HIL_STATE_QUATERNION"]["alt"] == pytest.approx(1000 * (HOME[2] + height), abs=1.5)

        sim.reset()
        first = peer.receive()
        peer.send(controls_for(first, target))
        sim.step(1)
        state = peer.receive()
        assert state["HIL_SENSOR"]["time_usec"] > first["HIL_SENSOR"]["time_usec"]
        assert state["HIL_STATE_QUATERNION"]["alt"] == pytest.approx(1000 * (HOME[2] + 2), abs=1.5)


# --------------------------------------------------------------------------------------------------- hostile and absent


def test_without_px4_the_run_continues() -> None:
    with simkit.load(iris()) as sim:
        sim.step(20)
        assert not codes(sim) and sim.time == pytest.approx(20 * STEP)
    with simkit.load(iris("<simkit:connection_wait>0.2</simkit:connection_wait>")) as sim:
        sim.step(2)
        assert codes(sim) == ["SK-PILOT-003"]


def test_px4_may_end_and_come_back() -> None:
    with connected(iris()) as (sim, peer):
        fly(sim, peer, 5, (0.0, 0.0, -2.0))
        peer.close()
        sim.step(3)
        assert codes(sim) == ["SK-PILOT-003"] and not plugin_of(sim).is_connected
        other = MavlinkPeer(plugin_of(sim).port)
        sim.step(1)
        fly(sim, other, 5, (0.0, 0.0, -2.0))
        assert plugin_of(sim).is_connected
        other.close()


def test_a_second_px4_is_refused_with_a_warning() -> None:
    with connected(iris()) as (sim, peer):
        others = [MavlinkPeer(plugin_of(sim).port) for _ in range(3)]
        fly(sim, peer, 3, (0.0, 0.0, -2.0))
        assert codes(sim) == ["SK-PILOT-004"] and plugin_of(sim).is_connected
        for other in others:
            assert other.socket.recv(10) == b""
            other.close()


NAN_CONTROLS = encode("HIL_ACTUATOR_CONTROLS", {"controls": (math.nan,) * 16, "mode": 128}, 1)
WHOLE = encode("HIL_ACTUATOR_CONTROLS", {"controls": (0.5,) * 16, "mode": 128}, 1)
HOSTILE = {
    "text": b"GET / HTTP/1.1\r\n\r\n",
    "zeros": bytes(5000),
    "starts": b"\xfd" * 3000,
    "wrong checksum": WHOLE[:-1] + bytes([WHOLE[-1] ^ 1]),
    "half": WHOLE[:30],
    "random": np.random.default_rng(5).bytes(20000),
}


@pytest.mark.parametrize("data", HOSTILE.values(), ids=HOSTILE)
def test_garbage_is_skipped_and_the_next_command_counts(data: bytes) -> None:
    with connected(iris("<simkit:peer_timeout>0.3</simkit:peer_timeout>")) as (sim, peer):
        peer.socket.sendall(data)
        sim.step(2)
        assert not any(plugin_of(sim)._targets)
        peer.socket.sendall(WHOLE * 8)  # damaged data may hide the first frames after them
        sim.step(1)
        assert plugin_of(sim)._targets[0] == 600.0 and plugin_of(sim).is_connected
        assert set(codes(sim)) <= {"SK-PILOT-004"}


def test_nan_controls_are_ignored_with_a_warning() -> None:
    with connected(iris()) as (sim, peer):
        peer.socket.sendall(WHOLE)
        sim.step(1)
        peer.socket.sendall(NAN_CONTROLS)
        sim.step(1)
        assert plugin_of(sim)._targets[0] == 600.0
        assert "SK-PLUGIN-041" in {d.code for d in sim.diagnostics}


def test_a_px4_that_does_not_read_does_not_make_the_run_grow() -> None:
    with connected(iris("<simkit:peer_timeout>0.2</simkit:peer_timeout>")) as (sim, peer):
        peer.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        plugin_of(sim)._connection._peer.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 4096)
        for _ in range(400):
            with suppress(ConnectionError):
                peer.send([0.5] * 4)
            sim.step(1)
            assert len(plugin_of(sim)._connection._unsent) < 1000
        # states are dropped; on some systems the full queue also stops the commands, and the connection is lost
        assert set(codes(sim)) & {"SK-PILOT-003", "SK-PILOT-004"}


FLOOD = """
import socket, sys
peer = socket.create_connection(("127.0.0.1", int(sys.argv[1])))
print("begun", flush=True)
data = bytes.fromhex(sys.argv[2]) * 200 + b"garbage" * 1000
try:
    while True:
        peer.sendall(data)
except OSError:
    pass
"""


def test_a_flood_of_another_process_does_not_stop_the_run() -> None:
    with simkit.load(iris()) as sim:
        sim.step(1)
        command = [sys.executable, "-c", FLOOD, str(plugin_of(sim).port), WHOLE.hex()]
        flood = subprocess.Popen(command, stdout=subprocess.PIPE)
        try:
            assert flood.stdout is not None and flood.stdout.readline() == b"begun\n"
            begun = time.monotonic()
            sim.step(10)
            assert time.monotonic() - begun < 30
            assert len(plugin_of(sim)._connection._decoder._waiting) < 300
        finally:
            flood.kill()
            flood.communicate()


@pytest.mark.parametrize(
    ("old", "new", "code"),
    [
        ("<input_index>0</input_index>", "<input_index>16</input_index>", "SK-PARAM-002"),
        ("<input_index>0</input_index>", "", "SK-PARAM-001"),
        ("<joint_control_type>velocity</", "<joint_control_type>speed</", "SK-PARAM-002"),
        ("<linkName>base_link</linkName>\n    <imuTopic>", "<linkName>none</linkName><imuTopic>", "SK-PLUGIN-003"),
        ("<mavlink_tcp_port>0<", "<mavlink_tcp_port>-1<", "SK-PARAM-002"),
    ],
)
def test_a_wrong_parameter_is_an_error(old: str, new: str, code: str) -> None:
    assert old in iris()
    with pytest.raises(simkit.InputError, match=code):
        simkit.load(iris().replace(old, new, 1))


@pytest.mark.parametrize(("old", "new"), [("use_tcp>1", "use_tcp>0"), ("serialEnabled>0", "serialEnabled>1")])
def test_other_kinds_of_connections_are_a_warning(old: str, new: str) -> None:
    with simkit.load(iris().replace(old, new)) as sim:
        assert codes(sim) == ["SK-PILOT-005"]


def test_the_interface_moves_the_rotors_of_gz_as_well() -> None:
    motors = MOTORS.replace("libgazebo_motor_model.so", "gz-sim-multicopter-motor-model-system")
    for i in range(4):
        motors = motors.replace(f'name="motor_{i}"', 'name="gz::sim::systems::MulticopterMotorModel"')
    with connected(vehicle(motors + px4(), step=STEP)) as (sim, peer):
        states = fly(sim, peer, 100, (0.0, 0.0, -2.0))
        assert states[-1]["HIL_STATE_QUATERNION"]["vz"] == pytest.approx(0, abs=60)  # cm/s; a free fall has 400
        assert sim.joint("quad::rotor_0_joint").velocity > 50


def test_the_thrust_of_a_rotor_falls_to_zero_at_25_m_s() -> None:
    for speed, share in ((0.0, 1.0), (12.5, 0.5), (-12.5, 0.5), (30.0, 0.0)):
        with simkit.load(vehicle(MOTORS, step=STEP).replace("0 0 -9.8", "0 0 0")) as sim:
            sim.publish("/quad/gazebo/command/motor_speed", {"velocity": [500.0] * 4})
            sim.step(100)
            sim.model("quad").set_velocity((0.0, 0.0, speed))
            before = sim.link("quad::base_link").linear_velocity[2]
            sim.step(1)
            gained = sim.link("quad::base_link").linear_velocity[2] - before
            assert gained == pytest.approx(share * 4 * THRUST * 500**2 * STEP / 1.6, rel=0.02, abs=1e-6)


def test_a_rotor_turns_backwards_only_if_it_is_reversible() -> None:
    for more, speed in (("", 0.0), ("<reversible>1</reversible>", -20.0)):
        with simkit.load(vehicle(MOTORS.replace("<robotNamespace/>", f"<robotNamespace/>{more}"), step=STEP)) as sim:
            sim.publish("/quad/gazebo/command/motor_speed", {"velocity": [-200.0] * 4})
            sim.step(100)
            assert sim.joint("quad::rotor_0_joint").velocity == pytest.approx(speed, abs=0.01)
