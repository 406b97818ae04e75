"""The text of messages and handles is one readable line."""

from __future__ import annotations

import simkit
from simkit import msgs


def test_a_message_shows_its_fields_in_one_line() -> None:
    point = msgs.make("geometry_msgs/msg/PointStamped", header={"frame_id": "map"}, point={"x": 1.5})
    expected = (
        "PointStamped(header=Header(stamp=Time(sec=0, nanosec=0), frame_id='map'), point=Point(x=1.5, y=0.0, z=0.0))"
    )
    assert repr(point) == str(point) == expected


def test_long_arrays_lists_and_texts_are_shortened() -> None:
    scan = msgs.make("sensor_msgs/msg/LaserScan", ranges=[1.0] * 360, intensities=[0.25, 2.0])
    assert "ranges=<float32 array of shape (360,)>, intensities=[0.25, 2.0]" in repr(scan)
    names = msgs.make("sensor_msgs/msg/JointState", name=["a", "b", "c", "d"])
    assert "name=['a', 'b', 'c', … 4 items], position=[]" in repr(names)
    text = repr(msgs.make("std_msgs/msg/String", data="x" * 5000))
    assert text == f"String(data={'x' * 80!r}… (5000 characters))"
    assert repr(msgs.make("std_msgs/msg/Empty")) == "Empty()"


def test_constants_of_a_type_are_no_part_of_the_text() -> None:
    status = msgs.make("action_msgs/msg/GoalStatus", status=4)
    assert repr(status).endswith(", status=4)")


def test_types_of_the_user_have_the_same_text() -> None:
    msgs.add("repr_msgs/msg/Pair", "int32 left\nstring from")
    assert repr(msgs.make("repr_msgs/msg/Pair", left=2)) == "Pair(left=2, from_='')"


def test_a_simulation_and_its_handles_show_name_and_state() -> None:
    with simkit.load("empty") as sim:
        seen = sim.subscribe("/clock")
        publisher, listener = sim.advertise("/a", "std_msgs/msg/String"), sim.listen("/b", "std_msgs/msg/String", print)
        sim.run(0.5)
        assert repr(sim) == f"<Simulation 'empty': t=0.5 s, {len(sim.models)} model{'s' * (len(sim.models) != 1)}>"
        assert repr(seen) == "<Subscription '/clock', 50 messages>"
        assert repr(publisher) == "<Publisher '/a' std_msgs/msg/String, 0 subscribers>"
        assert repr(listener) == "<Listener '/b' std_msgs/msg/String>"
        assert repr(sim.snapshot()) == "<Snapshot at tick 500>"
        assert repr(sim.declare("gain", 2.0)) == "<Parameter 'gain' of '/script': 2.0>"
        assert repr(sim.offer("/go", "std_srvs/srv/Trigger", lambda _: None)) == "<Service '/go' std_srvs/srv/Trigger>"
        assert all("object at" not in repr(plugin) for plugin in sim.plugins.values())
    assert repr(sim) == "<Simulation 'empty': closed>"
