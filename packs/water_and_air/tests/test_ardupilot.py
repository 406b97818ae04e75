"""ArduPilot's plugin: hover over the JSON interface, the state that is sent, lock-step, and hostile peers."""

from __future__ import annotations

import math
import os
import signal
import socket
import struct
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pilot_peers import PLACES, JsonPeer, hover_shares, vehicle

import simkit
from simkit_water_and_air.plugins.autopilots.servo_packet import decode_servo_packet
from simkit_water_and_air.plugins.gz.ardupilot import ArduPilotPlugin

BLADE = (
    "<a0>0.3</a0><alpha_stall>1.4</alpha_stall><cla>4.25</cla><cda>0.1</cda><area>0.002</area>"
    "<air_density>1.2041</air_density><cp>{cp} 0 0</cp><forward>0 {forward} 0</forward><upward>0 0 1</upward>"
)
BLADES = "".join(
    f'<plugin filename="gz-sim-lift-drag-system" name="gz::sim::systems::LiftDrag">'
    f"{BLADE.format(cp=0.084 * side, forward=side * way)}<link_name>rotor_{i}</link_name></plugin>"
    for i, (_, _, way) in enumerate(PLACES)
    for side in (1, -1)
)
ROTOR_CONTROL = """<control channel="{i}"><jointName>rotor_{i}_joint</jointName><type>VELOCITY</type>
  <multiplier>{speed}</multiplier><servo_min>1000</servo_min><servo_max>2000</servo_max>
  <p_gain>0.1</p_gain><cmd_max>2.5</cmd_max><cmd_min>-2.5</cmd_min></control>"""
NOISE = '<imu><angular_velocity><x><noise type="gaussian"><stddev>0.01</stddev></noise></x></angular_velocity></imu>'
FULL = 838.0
ROTORS = "".join(ROTOR_CONTROL.format(i=i, speed=FULL * way) for i, (_, _, way) in enumerate(PLACES))
SPEED_OF_TIP = 0.084 * FULL
THRUST_AT_FULL = 2 * 0.5 * 1.2041 * SPEED_OF_TIP**2 * 0.002 * 4.25 * 0.3  # two blades; lift slope · angle of attack


def ardupilot(more: str = "", lock: int = 1, content: str = ROTORS) -> str:
    return f"""<plugin name="ArduPilotPlugin" filename="ArduPilotPlugin"><fdm_port_in>0</fdm_port_in>
      <lock_step>{lock}</lock_step><imuName>base_link::imu_sensor</imuName>
      <gazeboXYZToNED degrees="true">0 0 0 180 0 90</gazeboXYZToNED>
      <modelXYZToAirplaneXForwardZDown degrees="true">0 0 0 180 0 0</modelXYZToAirplaneXForwardZDown>
      {content}{more}</plugin>"""


def plugin_of(sim: simkit.Simulation) -> ArduPilotPlugin:
    return next(p for p in sim.engine.structure.all_plugins() if isinstance(p, ArduPilotPlugin))


@contextmanager
def opened(text: str, channels: int = 16) -> Iterator[tuple[simkit.Simulation, JsonPeer]]:
    """Load a world, open the plugin's port by one step, and connect a peer that has sent nothing yet."""
    with simkit.load(text) as sim:
        sim.step(1)
        peer = JsonPeer(plugin_of(sim).port, channels)
        try:
            yield sim, peer
        finally:
            peer.close()


def codes(sim: simkit.Simulation) -> list[str]:
    return [d.code for d in sim.diagnostics if d.code.startswith("SK-PILOT")]


def widths(state: dict[str, Any], target: Any) -> np.ndarray:
    gyro = state["imu"]["gyro"]
    shares = hover_shares(
        state["position"], state["velocity"], state["quaternion"], gyro, target, THRUST_AT_FULL, yaw_gain=0.1
    )
    return np.rint(1000 + 1000 * shares)


def fly(sim: simkit.Simulation, peer: JsonPeer, steps: int, target: Any) -> dict[str, Any]:
    """Answer every state; the first packet is sent here if the peer has not begun."""
    if not peer.frame:
        peer.send([1000 + 1000 * math.sqrt(1.6 * 9.8 / 4 / THRUST_AT_FULL)] * 4)
    state: dict[str, Any] = {}
    for _ in range(steps):
        sim.step(1)
        state = peer.receive()
        peer.send(widths(state, target))
    return state


def test_a_quadrotor_flies_to_a_place_over_the_json_interface_and_hovers() -> None:
    with opened(vehicle(ardupilot() + BLADES, step=0.002)) as (sim, peer):
        fly(sim, peer, 1800, (0.2, -0.1, -2.2))  # north, east, down
        east, north, up = sim.model("quad").pose.position
        assert (north, east) == pytest.approx((0.2, -0.1), abs=0.02)
        assert up == pytest.approx(2.2, abs=0.05)
        base = sim.link("quad::base_link")
        assert base.linear_velocity == pytest.approx([0, 0, 0], abs=0.03)
        turning = sum(abs(sim.joint(f"quad::rotor_{i}_joint").velocity) for i in range(4)) / 4
        assert turning == pytest.approx(FULL * math.sqrt(1.6 * 9.8 / 4 / THRUST_AT_FULL), rel=0.02)
        assert not codes(sim)


def test_the_state_is_north_east_down_and_forward_right_down() -> None:
    flying = vehicle(ardupilot(), world="").replace("<pose>0 0 2.0 0 0 0</pose>", "<pose>3 7 2 0.1 0.2 0.5</pose>")
    with opened(flying.replace("max_step_size>0.001", "max_step_size>0.0001")) as (sim, peer):
        sim.model("quad").set_velocity((1.0, 2.0, 3.0), (0.0, 0.0, 0.4))
        peer.send()
        sim.step(1)
        state = peer.receive()
        assert state["timestamp"] == pytest.approx(2e-4, abs=1e-12)
        assert state["position"] == pytest.approx([7, 3, -2], abs=1e-3)
        assert state["velocity"] == pytest.approx([2, 1, -3], abs=2e-3)
        w, x, y, z = state["quaternion"]
        # the heading of the body's x axis: yaw 0.5 from east counter-clockwise is 90° - 0.5 clockwise from north
        assert math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)) == pytest.approx(math.pi / 2 - 0.5, abs=1e-3)
        assert math.asin(2 * (w * y - z * x)) == pytest.approx(
            -0.2, abs=1e-3
        )  # nose down in Gazebo is a positive pitch
        assert math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)) == pytest.approx(0.1, abs=1e-3)
        up = np.array(sim.link("quad::base_link").pose.matrix[2])
        assert state["imu"]["gyro"] == pytest.approx([0.4 * up[0], -0.4 * up[1], -0.4 * up[2]], abs=1e-3)
        assert np.abs(state["imu"]["accel_body"]).max() < 0.05  # free fall


@pytest.mark.parametrize(
    ("kind", "more", "command"),
    [
        ("EFFORT", "<multiplier>4</multiplier><offset>-0.5</offset>", 4 * (0.75 - 0.5)),
        ("POSITION", "<multiplier>2</multiplier>", 1.5),
        ("VELOCITY", "<turningDirection>cw</turningDirection><useForce>0</useForce>", -0.75),
        ("COMMAND", "<multiplier>2</multiplier><cmd_topic>/flap</cmd_topic>", 1.5),
    ],
)
def test_a_channel_commands_effort_position_velocity_or_a_topic(kind: str, more: str, command: float) -> None:
    gains = "<p_gain>0.02</p_gain><d_gain>0.004</d_gain><cmd_max>2.5</cmd_max><cmd_min>-2.5</cmd_min>"
    servo = "<servo_min>1200</servo_min><servo_max>1600</servo_max>"
    control = f"""<control channel="5"><jointName>rotor_0_joint</jointName><type>{kind}</type>{servo}{gains}{more}
      </control>"""
    heard: list[float] = []
    # the vehicle is fixed, so that the motion of the rotor has an analytic solution
    text = vehicle(ardupilot(content=control)).replace(
        '<model name="quad">',
        '<model name="quad"><joint name="mast" type="fixed"><parent>world</parent><child>base_link</child></joint>',
    )
    with opened(text) as (sim, peer):
        sim.subscribe("/flap", lambda message: heard.append(message.data))
        for _ in range(800 if kind == "POSITION" else 50):
            peer.send([1000] * 5 + [1500])  # three quarters of the way from 1200 to 1600
            sim.step(1)
        joint = sim.joint("quad::rotor_0_joint")
        if kind == "EFFORT":
            assert joint.velocity == pytest.approx(command / 1.67604e-4 * 50e-3, rel=1e-6)
        elif kind == "POSITION":
            assert joint.position == pytest.approx(command, abs=0.01)
        elif kind == "VELOCITY":
            assert joint.velocity == pytest.approx(command, abs=1e-5)
        else:
            assert heard == [command] * 50
        assert not codes(sim)


def test_32_channels_and_the_range_finder() -> None:
    rays = """<link name="eye"><pose>0 0 0 0 1.570796 0</pose><sensor name="down" type="gpu_lidar">
      <topic>down</topic><lidar><scan><horizontal><samples>1</samples><min_angle>0</min_angle><max_angle>0</max_angle>
      </horizontal></scan><range><min>0.1</min><max>{}</max></range></lidar></sensor></link>
      <joint name="e" type="fixed"><parent>base_link</parent><child>eye</child></joint>"""
    plane = "<geometry><plane/></geometry>"
    ground = f"""<model name="ground"><static>true</static><link name="l"><collision name="c">{plane}</collision>
      <visual name="v">{plane}</visual></link></model>"""
    control = ROTOR_CONTROL.format(i=0, speed=100).replace('channel="0"', 'channel="31"')
    more = (
        "<have_32_channels>1</have_32_channels><sensor><type>range</type><index>1</index><topic>down</topic></sensor>"
    )
    for most, expected in ((10, 2.0), (1.5, 3.0)):
        with opened(vehicle(ardupilot(more, content=control) + rays.format(most), world=ground), 32) as (sim, peer):
            for _ in range(3):
                peer.send([1000] * 31 + [1500])
                sim.step(1)
            assert peer.receive_all()[-1]["rng_1"] == pytest.approx(expected, abs=0.01)
            assert sim.joint("quad::rotor_0_joint").velocity > 10


def test_a_range_comes_from_range_messages_too_and_others_are_ignored() -> None:
    sensors = "".join(
        f"<sensor><type>r</type><index>{i}</index><topic>{t}</topic></sensor>" for i, t in ((1, "a"), (3, "b"))
    )
    with opened(vehicle(ardupilot(sensors))) as (sim, peer):
        near, odd = sim.advertise("/a", "sensor_msgs/msg/Range"), sim.advertise("/b", "std_msgs/msg/Float64")
        peer.send()
        for measured, expected in ((0.7, 0.7), (math.inf, 8.0)):
            near.publish({"range": measured, "max_range": 4.0})
            odd.publish({"data": 1.0})
            sim.step(1)
            state = peer.receive()
            peer.send()
            assert [state[f"rng_{i}"] for i in (1, 2, 3)] == [pytest.approx(expected), -1.0, -1.0]
        assert "SK-PLUGIN-041" in {d.code for d in sim.diagnostics}


def test_repeated_frames_get_one_answer_a_step() -> None:
    with opened(vehicle(ardupilot())) as (sim, peer):
        peer.send(frame=1)
        sim.step(1)
        for _ in range(20):
            peer.send(frame=1)
        peer.send(frame=2)
        sim.step(1)
        assert len(peer.receive_all()) == 3


def test_the_wind_vane_has_the_apparent_wind() -> None:
    vane = '<sensor name="vane" type="custom" gz:type="anemometer"><pose>0.1 0 0.2 0 0 0</pose></sensor></link>'
    wind = "<wind><linear_velocity>0 -3 0</linear_velocity></wind>"  # from the north
    more = "<anemometer>vane</anemometer>"
    text = vehicle(ardupilot(more), world=wind).replace("</sensor></link>", f"</sensor>{vane}", 1)
    with opened(
        text.replace('<sdf version="1.9">', '<sdf version="1.9" xmlns:gz="http://gazebosim.org/schema">')
    ) as found:
        sim, peer = found
        for turn, direction, speed in ((0.0, -math.pi / 2, 3.0), (math.pi / 2, 0.0, 3.0), (math.pi / 2, 0.0, 5.0)):
            sim.model("quad").set_pose(simkit.Pose.from_rpy(0, 0, 2, 0, 0, turn))
            sim.model("quad").set_velocity((0.0, speed - 3.0, 0.0))
            peer.send()
            sim.step(1)
            found_wind = peer.receive_all()[-1]["windvane"]
            # heading east (0): the wind from the north comes from the left; heading north: from ahead
            assert found_wind["speed"] == pytest.approx(speed, abs=0.01)
            assert found_wind["direction"] == pytest.approx(direction, abs=0.01)


# ---------------------------------------------------------------------------------------------- lock-step, repetition


def states_and_bits(sim: simkit.Simulation, peer: JsonPeer, steps: int) -> tuple[list[dict[str, Any]], bytes]:
    """Fly with a proportional answer to each state, and return the states and the bits at the end."""
    states = []
    for _ in range(steps):
        sim.step(1)
        states.append(peer.receive())
        peer.send(widths(states[-1], (0.0, 0.0, -2.0)))
    return states, sim.mj_data.qpos.tobytes() + sim.mj_data.qvel.tobytes()


def test_equal_packets_give_equal_bits() -> None:
    runs = []
    for _ in range(2):
        with opened(
            vehicle(
                ardupilot(),
                NOISE,
            )
        ) as (sim, peer):
            peer.send([1500] * 4)
            runs.append(states_and_bits(sim, peer, 60))
    assert runs[0] == runs[1]


def test_in_lock_step_every_packet_counts_for_one_step() -> None:
    control = (
        ROTOR_CONTROL.format(i=0, speed=100)
        .replace("VELOCITY", "COMMAND")
        .replace("</type>", "</type><cmd_topic>/c</cmd_topic>")
    )
    with opened(vehicle(ardupilot(content=control))) as (sim, peer):
        heard: list[float] = []
        sim.subscribe("/c", lambda message: heard.append(round(message.data)))
        for width in (1100, 1200, 1300, 1400):
            peer.send([width])
        peer.send([1900], frame=4)  # a repeated frame counts once, and the last state is sent again
        peer.send([1500], frame=5)
        sim.step(5)
        assert heard == [10, 20, 30, 40, 50]
        assert len(peer.receive_all()) == 6


def test_after_a_restore_the_autopilot_gets_the_present_state_and_the_bits_repeat() -> None:
    with opened(vehicle(ardupilot())) as (sim, peer):
        peer.send([1500] * 4)
        states_and_bits(sim, peer, 20)
        snapshot = sim.snapshot()
        state = states_and_bits(sim, peer, 1)[0][0]
        after = states_and_bits(sim, peer, 30)
        sim.restore(snapshot)
        # the answer to the last state is dropped, and the state of the snapshot's time asks for another
        answered: list[dict[str, Any]] = []

        def answer() -> None:
            answered.append(peer.receive())
            peer.send(widths(answered[0], (0.0, 0.0, -2.0)))

        helper = threading.Thread(target=answer)
        helper.start()
        again = states_and_bits(sim, peer, 31)
        helper.join()
        assert answered[0]["timestamp"] == pytest.approx(state["timestamp"] - 1e-3, abs=1e-12)
        assert again[0][0] == state and again[0][1:] == after[0] and again[1] == after[1]


def test_a_reset_keeps_the_connection_and_the_timestamps_begin_again() -> None:
    with opened(vehicle(ardupilot())) as (sim, peer):
        peer.send([1500] * 4)
        states_and_bits(sim, peer, 10)
        sim.reset()
        sim.step(1)
        assert plugin_of(sim).is_connected
        state = peer.receive()
        assert state["timestamp"] == pytest.approx(1e-3) and state["position"] == pytest.approx([0, 0, -2], abs=1e-4)
        peer.send(widths(state, (0.0, 0.0, -2.0)))
        first = states_and_bits(sim, peer, 10)
        sim.reset()
        sim.step(1)
        assert peer.receive() == state
        peer.send(widths(state, (0.0, 0.0, -2.0)))
        assert states_and_bits(sim, peer, 10) == first


def test_a_removed_vehicle_keeps_its_port_for_a_restore_until_the_simulation_closes() -> None:
    with opened(vehicle(ardupilot())) as (sim, peer):
        snapshot, port = sim.snapshot(), plugin_of(sim).port
        sim.remove("quad")
        peer.send()
        sim.step(1)
        assert not peer.receive_all()
        sim.restore(snapshot)
        peer.send()
        sim.step(1)
        assert plugin_of(sim).port == port and len(peer.receive_all()) == 1
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", port))


def test_loading_and_checking_open_no_port() -> None:
    with simkit.load(vehicle(ardupilot())) as sim:
        assert plugin_of(sim).port == 0
        sim.step(1)
        assert plugin_of(sim).port > 0
        with pytest.raises(OSError, match=r"."), socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
            taken.bind(("127.0.0.1", plugin_of(sim).port))


# --------------------------------------------------------------------------------------------------- hostile and absent


def short(seconds: float, more: str = "") -> str:
    return ardupilot(f"<simkit:peer_timeout>{seconds}</simkit:peer_timeout>{more}")


def test_a_lost_autopilot_ends_the_wait_with_a_warning_and_may_come_back() -> None:
    with opened(vehicle(short(0.2))) as (sim, peer):
        peer.send([1900] * 4)
        sim.step(1)
        begun = time.monotonic()
        sim.step(100)
        assert 0.15 < time.monotonic() - begun < 2.0
        assert codes(sim) == ["SK-PILOT-003"] and not plugin_of(sim).is_connected
        speed = sim.joint("quad::rotor_0_joint").velocity
        sim.step(1)
        assert sim.joint("quad::rotor_0_joint").velocity == pytest.approx(speed, rel=1e-3)  # no effort any more
        other = JsonPeer(plugin_of(sim).port)
        other.send([1900] * 4)
        sim.step(1)
        assert plugin_of(sim).is_connected and other.receive()["timestamp"] > 0.1
        other.close()


def test_without_lock_step_the_autopilot_is_lost_after_the_counted_steps() -> None:
    with opened(vehicle(ardupilot("<connectionTimeoutMaxCount>3</connectionTimeoutMaxCount>", lock=0))) as (sim, peer):
        peer.send([1500] * 4)
        sim.step(4)
        assert plugin_of(sim).is_connected
        sim.step(1)
        assert not plugin_of(sim).is_connected and codes(sim) == ["SK-PILOT-003"]


HOSTILE = {
    "empty": b"",
    "one byte": b"\x1a",
    "wrong magic": struct.pack("<HHI16H", 18459, 400, 1, *[1500] * 16),
    "32 channels": struct.pack("<HHI32H", 29569, 400, 1, *[1500] * 32),
    "half": struct.pack("<HHI16H", 18458, 400, 1, *[1500] * 16)[:21],
    "too long": struct.pack("<HHI16H", 18458, 400, 1, *[1500] * 16) + b"x",
    "text": b'{"timestamp": nan}',
    "large": bytes(60000),
}


@pytest.mark.parametrize("data", HOSTILE.values(), ids=HOSTILE)
def test_garbage_is_ignored_with_one_warning(data: bytes) -> None:
    with opened(vehicle(ardupilot())) as (sim, peer):
        for _ in range(300):
            peer.socket.send(data)
        sim.step(3)
        assert not plugin_of(sim).is_connected and codes(sim) == ["SK-PILOT-004"]
        peer.send([1500] * 4)
        sim.step(1)
        peer.socket.send(data)
        peer.send([1500] * 4)
        sim.step(1)
        assert plugin_of(sim).is_connected and len(peer.receive_all()) == 2


def test_random_bytes_never_count_as_a_packet_of_another_length() -> None:
    random = np.random.default_rng(3)
    for size in range(80):
        found = decode_servo_packet(b"\x1a\x48" + random.bytes(size), 16)
        assert isinstance(found, str) == (size != 38)


def test_a_second_autopilot_is_ignored_with_a_warning() -> None:
    with opened(vehicle(short(0.5))) as (sim, peer):
        peer.send([1500] * 4)
        sim.step(1)
        other = JsonPeer(plugin_of(sim).port)
        for _ in range(50):
            other.send([2000] * 4)
        peer.send([1000] * 4)
        sim.step(1)
        assert codes(sim) == ["SK-PILOT-004"] and not other.receive_all() and len(peer.receive_all()) == 2
        other.close()


FLOOD = """
import socket, struct, sys
peer = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
peer.connect(("127.0.0.1", int(sys.argv[1])))
frame = 0
print("begun", flush=True)
while True:
    frame += 1
    try:
        peer.send(b"garbage" if frame % 3 else struct.pack("<HHI16H", 18458, 400, frame, *[1500] * 16))
    except OSError:
        pass
"""


@pytest.mark.parametrize("lock", [0, 1])
def test_a_flood_of_another_process_does_not_stop_the_run(lock: int) -> None:
    with simkit.load(vehicle(ardupilot(lock=lock))) as sim:
        sim.step(1)
        flood = subprocess.Popen([sys.executable, "-c", FLOOD, str(plugin_of(sim).port)], stdout=subprocess.PIPE)
        try:
            assert flood.stdout is not None and flood.stdout.readline() == b"begun\n"
            begun = time.monotonic()
            sim.step(50)
            assert time.monotonic() - begun < 20
        finally:
            flood.kill()
            flood.communicate()
        assert sim.time == pytest.approx(0.051)


def test_a_used_port_is_a_warning_and_the_run_continues() -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
        taken.bind(("127.0.0.1", 0))
        text = vehicle(ardupilot()).replace("<fdm_port_in>0<", f"<fdm_port_in>{taken.getsockname()[1]}<")
        with simkit.load(text) as sim:
            sim.step(3)
            assert codes(sim) == ["SK-PILOT-002"]


def test_an_address_in_a_file_opens_no_port_to_other_machines(monkeypatch: pytest.MonkeyPatch) -> None:
    text = vehicle(ardupilot("<fdm_addr>0.0.0.0</fdm_addr>"))
    with simkit.load(text) as sim:
        assert codes(sim) == ["SK-PILOT-001"]
        sim.step(1)
        assert plugin_of(sim)._connection._socket.getsockname()[0] == "127.0.0.1"
    monkeypatch.setenv("SIMKIT_AUTOPILOT_ADDRESS", "127.0.0.2")
    with simkit.load(text) as sim:
        sim.step(1)
        assert not codes(sim) and plugin_of(sim)._connection._socket.getsockname()[0] == "127.0.0.2"


def test_the_first_step_waits_for_the_autopilot_on_request() -> None:
    with simkit.load(vehicle(ardupilot("<simkit:connection_wait>0.2</simkit:connection_wait>"))) as sim:
        sim.step(2)
        assert codes(sim) == ["SK-PILOT-003"]


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="signals")
def test_ctrl_c_ends_the_wait(tmp_path: Path) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    text = vehicle(short(60)).replace("<fdm_port_in>0<", f"<fdm_port_in>{port}<")
    path = tmp_path / "quad.sdf"
    path.write_text(text, encoding="utf-8")
    command = [sys.executable, "-m", "simkit", "run", str(path), "--rtf", "1", "--duration", "100"]
    run = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    peer = JsonPeer(port)
    peer.socket.settimeout(0.1)
    try:
        end = time.monotonic() + 60
        while time.monotonic() < end and run.poll() is None:
            try:
                peer.send([1500] * 4)
                peer.receive()
                break
            except OSError:
                time.sleep(0.05)  # the other process is still starting
        peer.receive_all()  # from here the run waits for an answer
        run.send_signal(signal.SIGINT)
        asked = time.monotonic()
        output = run.communicate(timeout=30)[0].decode()
        assert run.returncode == 130, output
        assert time.monotonic() - asked < 10 and "Traceback" not in output
    finally:
        run.kill()
        run.communicate()
        peer.close()


@pytest.mark.parametrize(
    ("old", "new", "code"),
    [
        ("base_link::imu_sensor", "no_imu", "SK-PLUGIN-003"),
        ("rotor_0_joint</jointName>", "rotor_9_joint</jointName>", "SK-PLUGIN-003"),
        ("<type>VELOCITY</type>", "<type>SPEED</type>", "SK-PARAM-002"),
        ('channel="0"', 'channel="zero"', "SK-PARAM-002"),
        ("<servo_max>2000</servo_max>", "<servo_max>1000</servo_max>", "SK-PARAM-002"),
        ("<fdm_port_in>0<", "<fdm_port_in>70000<", "SK-PARAM-002"),
    ],
)
def test_a_wrong_parameter_is_an_error(old: str, new: str, code: str) -> None:
    with pytest.raises(simkit.InputError, match=code):
        simkit.load(vehicle(ardupilot()).replace(old, new, 1))


def test_a_channel_that_does_not_exist_and_an_unknown_element_are_warnings() -> None:
    text = vehicle(ardupilot("<lockstep>1</lockstep>")).replace('channel="3"', 'channel="16"')
    with simkit.load(text) as sim:
        found = {d.code: d.message for d in sim.diagnostics}
        assert "SK-PILOT-005" in found and any("lockstep" in message for message in found.values())
