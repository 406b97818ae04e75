"""Commands of a bag drive a world again: the same bits where simkit recorded them, by their times where ROS did."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

import simkit
from simkit import msgs
from simkit.errors import InputError
from simkit.recording.bags.playback import Playback
from simkit.recording.bags.recorder import Recorder
from simkit.recording.command_script import Command, Commands
from simkit.runtime.engine.snapshot import state_hash

EPOCH = 1_700_000_000 * 1_000_000_000  # a day in 2023
CART = """<sdf version="1.9"><world name="w">
  <physics type="ode"><max_step_size>0.003</max_step_size></physics>
  <model name="cart"><link name="base"><inertial><mass>2</mass></inertial></link>
    <plugin filename="gz-sim-velocity-control-system" name="gz::sim::systems::VelocityControl">
      <topic>/cmd_vel</topic></plugin>
    <plugin filename="gz-sim-odometry-publisher-system" name="gz::sim::systems::OdometryPublisher">
      <odom_topic>/odom</odom_topic><odom_frame>odom</odom_frame><robot_base_frame>base</robot_base_frame></plugin>
  </model></world></sdf>"""
DRIVE = [
    Command(0.0, "/cmd_vel", {"linear": {"x": 0.1}}),
    Command(0.0, "/cmd_vel", {"linear": {"x": 0.3}}),  # two in one step: the later counts
    Command(0.1004, "/cmd_vel", {"linear": {"x": 0.2}, "angular": {"z": 0.5}}, until=0.9, rate=7.0),
    Command(0.5, "/cmd_vel", {"angular": {"z": -1.0}}),
]


def driven(sim: Any, sender: Any, steps: int = 400) -> str:
    for _ in range(steps):
        sender.send_due()
        sim.step()
    return state_hash(sim)


def test_a_recorded_run_is_repeated_bit_by_bit(tmp_path: Path) -> None:
    with simkit.load(CART) as sim, Recorder(sim, tmp_path / "a.mcap"):
        wanted = driven(sim, Commands(sim, DRIVE))
    with simkit.load(CART) as sim, Playback(sim, tmp_path / "a.mcap") as played, Recorder(sim, tmp_path / "b.mcap"):
        assert played.names == {"/cmd_vel": "/cmd_vel"} and played.next_tick == 0
        assert played.duration == pytest.approx(1.2, abs=0.03)
        assert driven(sim, played) == wanted
        assert played.next_tick is None and played.sent == 9
    assert (tmp_path / "a.mcap").read_bytes() == (tmp_path / "b.mcap").read_bytes()


def by_ros(path: Path, storage: Any, type_name: str = "geometry_msgs/msg/Twist", **compression: Any) -> None:
    """As ROS 2 records it: by the calendar, with a type store of its own."""
    store = get_typestore(Stores.ROS2_HUMBLE)
    types = store.types
    vector, twist = types["geometry_msgs/msg/Vector3"], types["geometry_msgs/msg/Twist"]
    stamped, header = types["geometry_msgs/msg/TwistStamped"], types["std_msgs/msg/Header"]
    writer = Writer(path, version=9, storage_plugin=storage)
    if compression:
        writer.set_compression(**compression)
    with writer:
        clock = writer.add_connection("/clock", "rosgraph_msgs/msg/Clock", typestore=store)
        connection = writer.add_connection("/cmd_vel", type_name, typestore=store)
        stamp = types["builtin_interfaces/msg/Time"]
        writer.write(clock, EPOCH, store.serialize_cdr(types["rosgraph_msgs/msg/Clock"](stamp(0, 0)), clock.msgtype))
        for k in range(3):
            message = twist(vector(0.1 * k, 0.0, 0.0), vector(0.0, 0.0, 0.25))
            if type_name.endswith("Stamped"):
                message = stamped(header(stamp(k, 0), "base"), message)
            writer.write(connection, EPOCH + k * 300_000_000, store.serialize_cdr(message, type_name))


@pytest.mark.parametrize(
    ("storage", "mode"),
    [
        (StoragePlugin.SQLITE3, None),
        (StoragePlugin.SQLITE3, CompressionMode.FILE),
        (StoragePlugin.SQLITE3, CompressionMode.MESSAGE),
        (StoragePlugin.MCAP, None),
        (StoragePlugin.MCAP, CompressionMode.STORAGE),
    ],
)
def test_a_bag_of_ros_2_is_played_from_its_beginning(storage: Any, mode: Any, tmp_path: Path) -> None:
    given = {} if mode is None else {"mode": mode, "fmt": CompressionFormat.ZSTD}
    by_ros(tmp_path / "ros", storage, **given)
    with simkit.load(CART) as sim, Playback(sim, tmp_path / "ros") as played:
        heard = sim.subscribe("/cmd_vel")
        assert played.names == {"/cmd_vel": "/cmd_vel"}
        driven(sim, played, 150)
        assert [m.linear.x for m in heard.messages] == [0.0, 0.1]
        driven(sim, played, 60)
        assert [m.linear.x for m in heard.messages] == [0.0, 0.1, 0.2]


def test_a_stamped_velocity_is_converted_if_the_world_needs_no_header(tmp_path: Path) -> None:
    by_ros(tmp_path / "ros", StoragePlugin.SQLITE3, "geometry_msgs/msg/TwistStamped")
    heard: list[Any] = []
    with simkit.load(CART.replace("/cmd_vel", "/other")) as sim:
        sim.communication.bus.listen("/cmd_vel", ("geometry_msgs/msg/Twist",), heard.append)
        with Playback(sim, tmp_path / "ros") as played:
            driven(sim, played, 210)
            assert "TwistStamped" in played.notes[0]
    assert [m.angular.z for m in heard] == [0.25] * 3


def test_topics_can_be_renamed_for_playback(tmp_path: Path) -> None:
    with simkit.load(CART) as sim, Recorder(sim, tmp_path / "a.mcap"):
        driven(sim, Commands(sim, DRIVE), 50)
    other = CART.replace("/cmd_vel", "/robot/go")
    with simkit.load(other) as sim:
        with pytest.raises(InputError, match=r"SK-BAG-016 .*inputs: /robot/go"):
            Playback(sim, tmp_path / "a.mcap")
        with Playback(sim, tmp_path / "a.mcap", ["cmd_vel:=/robot/go"]) as played:
            driven(sim, played, 50)
        assert sim.model("cart").pose.position[0] > 0.02
        for text, code in (
            ("/cmd_vl", "SK-CLI-030 no topic '/cmd_vl' in .*did you mean '/cmd_vel'"),
            ("/cmd_vel:=/robot/goo", "SK-CLI-030 no topic '/robot/goo' in the world"),
            ("/odom:=/robot/go", "SK-BAG-015"),
            ("/cmd_vel:=", "SK-CLI-018"),
        ):
            with pytest.raises(InputError, match=code):
                Playback(sim, tmp_path / "a.mcap", [text])


def test_sensor_readings_of_the_world_are_not_played_back(tmp_path: Path) -> None:
    class Echo(simkit.WorldPlugin):
        def load(self, parent: Any, params: Any) -> None:
            self.heard = 0
            self.subscribe("/odom", self.on_odom)

        def on_odom(self, message: Any) -> None:
            self.heard += 1

    with simkit.load(CART) as sim, Recorder(sim, tmp_path / "a.mcap"):
        driven(sim, Commands(sim, DRIVE), 100)
    echo = Echo()
    with simkit.load(CART, plugins=[echo]) as sim, Playback(sim, tmp_path / "a.mcap") as played:
        assert played.names == {"/cmd_vel": "/cmd_vel"}


def test_a_truncated_bag_is_played_up_to_its_end(tmp_path: Path) -> None:
    with simkit.load(CART) as sim, Recorder(sim, tmp_path / "a.mcap"):
        driven(sim, Commands(sim, DRIVE), 800)
    data = (tmp_path / "a.mcap").read_bytes()
    (tmp_path / "cut.mcap").write_bytes(data[: len(data) * 2 // 3])
    with simkit.load(CART) as sim, Playback(sim, tmp_path / "cut.mcap") as played:
        assert "cut off" in played.notes[0]
        driven(sim, played, 400)
        assert played.sent > 3


def test_a_message_with_the_bags_own_definition_is_converted_by_field_names(tmp_path: Path) -> None:
    """A Twist with its parts the other way round, as another distribution could have it."""
    store = get_typestore(Stores.EMPTY)
    text = (
        "geometry_msgs/Vector3 angular\ngeometry_msgs/Vector3 linear\n" + "=" * 80
        + "\nMSG: geometry_msgs/Vector3\nfloat32 z\nfloat32 y\nfloat32 x"
    )  # fmt: skip
    store.register(get_types_from_msg(text, "geometry_msgs/msg/Twist"))
    vector, twist = store.types["geometry_msgs/msg/Vector3"], store.types["geometry_msgs/msg/Twist"]
    with Writer(tmp_path / "bag", version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        connection = writer.add_connection("/cmd_vel", "geometry_msgs/msg/Twist", typestore=store)
        message = twist(vector(np.float32(0.5), 0.0, 0.0), vector(0.0, 0.0, np.float32(0.25)))
        writer.write(connection, EPOCH, store.serialize_cdr(message, "geometry_msgs/msg/Twist"))
    with simkit.load(CART) as sim, Playback(sim, tmp_path / "bag") as played:
        heard = sim.subscribe("/cmd_vel")
        driven(sim, played, 3)
    (found,) = heard.messages
    assert (found.linear.x, found.angular.z) == (0.25, 0.5)
    assert isinstance(found, msgs.type_of("geometry_msgs/msg/Twist"))
