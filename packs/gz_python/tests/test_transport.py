"""gz.transport's Node and gz.msgs over the simulation's own topics and services."""

from __future__ import annotations

import copy
from collections.abc import Iterator
from typing import Any

import pytest

import simkit
from simkit import msgs
from simkit_gz_python.msgs import contents_of, message_class
from simkit_gz_python.msgs.ros_conversion import _all_twins, from_ros, to_ros
from simkit_gz_python.plugins.gz_system_plugin import GzSystem
from simkit_gz_python.transport import AdvertiseMessageOptions, Node

WORLD = """<sdf version="1.9"><world name="w"><model name="body"><link name="link">
  <sensor name="imu" type="imu"><update_rate>100</update_rate></sensor></link></model></world></sdf>"""
Pose, Twist, Clock, Double, Header = map(message_class, ("Pose", "Twist", "Clock", "Double", "Header"))


# ---------------------------------------------------------------------- messages


def test_a_message_has_its_fields_from_the_start() -> None:
    pose = Pose()
    pose.position.x = 1
    pose.header.stamp.sec = 3
    assert pose.position.x == 1.0 and pose.orientation.w == 0.0 and pose.name == ""
    assert str(pose) == "header {\n  stamp {\n    sec: 3\n  }\n}\nposition {\n  x: 1.0\n}\n"


def test_fields_can_be_given_and_copied() -> None:
    pose = Pose(name="a", position={"x": 2})
    other = Pose()
    other.CopyFrom(pose)
    other.position.x = 9
    assert pose == copy.deepcopy(pose) and pose.position.x == 2 and other != pose


def test_repeated_fields_are_lists_that_make_their_own_messages() -> None:
    many = message_class("Pose_V")()
    many.pose.add(name="a").position.y = 4
    many.pose.add().name = "b"
    assert [p.name for p in many.pose] == ["a", "b"] and many.pose[0].position.y == 4


def test_a_wrong_field_names_the_closest_and_a_wrong_value_its_kind() -> None:
    with pytest.raises(AttributeError, match=r"gz\.msgs\.Pose has no field 'positon'; did you mean 'position'"):
        Pose().positon  # noqa: B018
    with pytest.raises(TypeError, match=r"sec of gz\.msgs\.Time is a whole number"):
        message_class("Time")().sec = 1.5
    with pytest.raises(AttributeError, match="use CopyFrom"):
        Pose().position = 3


@pytest.mark.parametrize("kind", sorted(_all_twins()))
def test_every_message_goes_to_ros_and_back(kind: str) -> None:
    made = message_class(kind)()
    for number, (name, form) in enumerate(message_class(kind).FIELDS.items(), 1):
        if form == "f":
            setattr(made, name, number + 0.5)
        elif form == "i":
            setattr(made, name, number)
        elif form == "Vector3d":
            getattr(made, name).y = number + 0.25
    for twin in _all_twins()[kind]:
        there = to_ros(made, twin.ros)
        assert msgs.type_name(there) == twin.ros and msgs.serialize(there) is not None
        back = from_ros(message_class(kind), there)
        assert msgs.serialize(to_ros(back, twin.ros)) == msgs.serialize(there)


def test_a_frame_and_a_stamp_survive() -> None:
    made = Header()
    made.stamp.sec, made.stamp.nsec = 5, 7
    made.data.add(key="frame_id", value=["base"])
    there = to_ros(made, "std_msgs/msg/Header")
    assert (there.stamp.sec, there.stamp.nanosec, there.frame_id) == (5, 7, "base")
    assert from_ros(Header, there) == made


def test_a_modules_contents_are_its_message() -> None:
    assert contents_of("vector3d_pb2")["Vector3d"] is message_class("Vector3d")


# ---------------------------------------------------------------------- topics


class Talker:
    """Publishes what it hears of the clock as the stamp of a pose."""

    def __init__(self) -> None:
        self.node, self.heard = Node(), [0]

    def configure(self, entity: int, sdf: Any, ecm: Any, events: Any) -> None:
        self.out = self.node.advertise("body/pose", Pose)
        assert self.node.subscribe(Clock, "/clock", self.tick)
        assert self.node.subscribe(Twist, "/cmd", self.steer)

    def tick(self, message: Any) -> None:
        self.heard.append(message.sim.nsec)

    def steer(self, message: Any) -> None:
        self.speed = message.linear.x

    def post_update(self, info: Any, ecm: Any) -> None:
        message = Pose()
        message.position.x = info.iterations
        message.header.stamp.nsec = self.heard[-1]
        self.out.publish(message)


@pytest.fixture
def talker() -> Talker:
    return Talker()


@pytest.fixture
def sim(talker: Talker) -> Iterator[Any]:
    with simkit.load(WORLD, plugins=[GzSystem(talker)]) as made:
        yield made


def test_what_a_system_publishes_is_a_ros_message(sim: Any) -> None:
    poses = sim.subscribe("/body/pose")
    sim.step(2)
    assert sim.topics()["/body/pose"] == "geometry_msgs/msg/PoseStamped"
    assert [m.pose.position.x for m in poses.messages] == [1.0, 2.0]
    assert poses.latest.pose.orientation.w == 1.0  # gz's empty orientation is no rotation


def test_callbacks_run_between_two_steps(sim: Any, talker: Talker) -> None:
    sim.step(21)
    assert talker.heard[1:] == [10_000_000, 20_000_000]
    sim.publish("/cmd", {"linear": {"x": 0.5}})
    sim.step()
    assert talker.speed == 0.5


def test_a_callback_that_raises_is_the_systems_fault(sim: Any, talker: Talker) -> None:
    sim.publish("/cmd", {"linear": {"x": 0.5}})
    talker.steer = None  # type: ignore[assignment,method-assign]
    broken = lambda message: {}["speed"]  # noqa: E731
    talker.node._owner, owner = None, talker.node._owner
    talker.node._owner = owner
    talker.node.subscribe(Twist, "/cmd", broken)
    with pytest.raises(simkit.PluginError, match="its callback for '/cmd'.*speed"):
        sim.step()


def test_a_message_of_another_class_than_was_advertised_is_refused(sim: Any, talker: Talker) -> None:
    with pytest.raises(simkit.MessageError, match="was advertised for gz.msgs.Pose, got Double"):
        talker.out.publish(Double())


def test_a_subscription_can_be_closed(sim: Any, talker: Talker) -> None:
    assert talker.node.unsubscribe("/clock") and not talker.node.unsubscribe("/clock")
    sim.step(21)
    assert talker.heard == [0]


def test_a_node_lists_topics_and_what_it_does_itself(sim: Any, talker: Talker) -> None:
    assert "/clock" in talker.node.topic_list()
    assert talker.node.advertised_topics() == ["/body/pose"] and talker.node.subscribed_topics() == ["/clock", "/cmd"]


def test_sensor_readings_arrive_as_gz_messages() -> None:
    class Listener:
        def __init__(self) -> None:
            self.seen: list[float] = []

        def configure(self, entity: int, sdf: Any, ecm: Any, events: Any) -> None:
            topic = "/world/w/model/body/link/link/sensor/imu/imu"
            Node().subscribe(message_class("IMU"), topic, lambda m: self.seen.append(m.linear_acceleration.z))

    listener = Listener()
    with simkit.load(WORLD, plugins=[GzSystem(listener)]) as sim:
        sim.step(32)
    assert len(listener.seen) == 4 and listener.seen == pytest.approx([0.0] * 4, abs=1e-9)  # it falls freely


def test_a_node_without_a_simulation_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    from simkit_gz_python import simulation_context

    monkeypatch.setattr(simulation_context, "_latest", None)
    with pytest.raises(RuntimeError, match="this Node has no simulation yet"):
        Node().topic_list()


def test_a_node_created_before_the_simulation_connects_to_it(monkeypatch: pytest.MonkeyPatch) -> None:
    from simkit_gz_python import simulation_context
    from simkit_gz_python.sim.fixture import TestFixture

    monkeypatch.setattr(simulation_context, "_latest", None)
    node, heard = Node(), []
    node.subscribe(Clock, "/clock", lambda message: heard.append(message.sim.nsec))
    node.subscribe(Twist, "/never", heard.append)
    out = node.advertise("/speed", Double)
    assert out.publish(Double(data=1.0)) and node.unsubscribe("/never")
    fixture = TestFixture(WORLD)
    speeds = fixture.server().simulation.subscribe("/speed")
    fixture.server().run(True, 21, False)
    assert out.publish(Double(data=2.0))
    assert heard == [10_000_000, 20_000_000] and [m.data for m in speeds.messages] == [2.0]
    assert "/never" not in fixture.server().simulation.topics()


def test_an_image_arrives_as_a_gz_message() -> None:
    import numpy as np

    pixels = np.arange(6, dtype=np.uint8)
    picture = msgs.make("sensor_msgs/msg/Image", width=2, height=1, step=6, encoding="rgb8", data=pixels)
    found: Any = from_ros(message_class("Image"), picture)
    assert (found.width, found.step, found.pixel_format_type, found.data) == (2, 6, 3, bytes(range(6)))


def test_entities_have_gzs_types() -> None:
    entity: Any = message_class("Entity")
    assert (entity.MODEL, entity.LINK, entity.JOINT) == (2, 3, 7)


# ---------------------------------------------------------------------- services


def test_services_of_the_world_are_called_with_gzs_messages(sim: Any, talker: Talker) -> None:
    boolean, pose = message_class("Boolean"), Pose(name="body", position={"z": 7.0})
    done, answer = talker.node.request("/world/w/set_pose", pose, Pose, boolean, 1000)
    assert done and answer.data
    sim.step()
    assert sim.model("body").pose.position[2] == pytest.approx(7.0, abs=1e-4)


def test_a_service_that_is_not_there_is_not_called(sim: Any, talker: Talker) -> None:
    done, answer = talker.node.request("/world/w/dance", Pose(), Pose, message_class("Boolean"), 1000)
    assert not done and not answer.data


# ---------------------------------------------------------------------- as gz says it


def test_a_message_says_its_full_name() -> None:
    assert Pose.DESCRIPTOR.full_name == Pose().DESCRIPTOR.full_name == "gz.msgs.Pose"
    modules = ("altimeter", "battery_state", "contacts", "entity_factory", "laserscan", "navsat", "stringmsg", "pose_v")
    assert [next(iter(contents_of(f"{name}_pb2"))).lower().replace("_", "") for name in modules] == [
        name.replace("_", "") for name in modules
    ]


def test_contacts_go_both_ways() -> None:
    made = message_class("Contacts")()
    contact = made.contact.add(collision1={"id": 4, "name": "a"}, depth=[0.5])
    contact.position.add(x=1.0)
    contact.wrench.add(body_1_name="m").body_1_wrench.force.z = 3.0
    ros = to_ros(made, "ros_gz_interfaces/msg/Contacts")
    assert ros.contacts[0].wrenches[0].body_1_name.data == "m" and ros.contacts[0].positions[0].x == 1
    assert from_ros(type(made), ros) == made


def heard_poses(topic: str) -> set[str]:
    names: set[str] = set()

    class Listener:
        def configure(self, *_: Any) -> None:
            self.node = Node()
            self.node.subscribe(message_class("Pose_V"), topic, lambda m: names.update(p.name for p in m.pose))

    with simkit.load(WORLD, plugins=[GzSystem(Listener())]) as sim:
        sim.run(0.1)
    return names


def test_the_scene_broadcasters_poses_have_names_of_their_own() -> None:
    assert heard_poses("/world/w/pose/info") == heard_poses("/world/w/dynamic_pose/info") == {"body", "link"}


def test_a_rate_without_effect_is_a_warning() -> None:
    class Speaker:
        def configure(self, *_: Any) -> None:
            options = AdvertiseMessageOptions()
            options.msgs_per_sec = 5
            self.out = Node().advertise("/out", Double, options)

    with simkit.load(WORLD, plugins=[GzSystem(Speaker())]) as sim:
        found = [d for d in sim.diagnostics if d.code == "SK-PLUGIN-086"]
    assert len(found) == 1 and "msgs_per_sec = 5 for '/out' has no effect" in found[0].message
