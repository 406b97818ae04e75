"""Programs with rclpy in lock-step: time, discovery, latency, the simulation's topics, and the end of a run."""

from __future__ import annotations

import textwrap
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import simkit
from simkit.bridges.live.introspection import node_list, topic_list

WORLD = """<sdf version="1.9"><world name="empty"/></sdf>"""
BEGIN = """
import rclpy
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from std_msgs.msg import Header, Int32
LOCAL = QoSProfile(depth=3, durability=DurabilityPolicy.TRANSIENT_LOCAL)
rclpy.init()
node = Node("{name}")
log = node.get_logger().info
"""

AddProgram = Callable[..., Any]


@pytest.fixture
def sim(tmp_path: Path) -> simkit.Simulation:
    (tmp_path / "empty.sdf").write_text(WORLD)
    return simkit.load(tmp_path / "empty.sdf")


@pytest.fixture
def add(sim: simkit.Simulation, tmp_path: Path) -> AddProgram:
    """Add a program; its node has the name of the program."""

    def add_program(name: str, code: str, **options: Any) -> Any:
        file = tmp_path / f"{name}.py"
        file.write_text(BEGIN.format(name=name) + textwrap.dedent(code))
        return sim.add_node(file, **options)

    return add_program


def texts(node: Any) -> list[str]:
    """Texts that a program has logged, without the front part of each line."""
    assert node.error is None, node.log
    return [line.split("]: ", 1)[1] for line in node.log]


TALKER = """
publisher = node.create_publisher(Int32, "number", {qos})
publisher.publish(Int32(data=0))
count = [0]
def tick():
    count[0] += 1
    publisher.publish(Int32(data=count[0]))
node.create_timer(0.1, tick)
rclpy.spin(node)
"""
LISTENER = """
node.create_subscription(Int32, "number", lambda message: log(str(message.data)), {qos})
rclpy.spin(node)
"""


def test_what_is_published_before_the_discovery_is_lost(sim: simkit.Simulation, add: AddProgram) -> None:
    add("talker", TALKER.format(qos=10))
    listener = add("listener", LISTENER.format(qos=10))
    sim.run(0.35)
    assert texts(listener) == ["1", "2", "3"]


def test_transient_local_messages_of_before_the_discovery_arrive(sim: simkit.Simulation, add: AddProgram) -> None:
    add("talker", TALKER.format(qos="LOCAL"))
    listener = add("listener", LISTENER.format(qos="LOCAL"))
    sim.run(0.25)
    assert texts(listener) == ["0", "1", "2"]
    late = add("late", LISTENER.format(qos="LOCAL"))
    sim.run(0.25)
    assert texts(late)[:3] == ["0", "1", "2"]


def test_a_later_volatile_subscription_gets_only_new_messages(sim: simkit.Simulation, add: AddProgram) -> None:
    add("talker", TALKER.format(qos="LOCAL"))
    sim.run(0.25)
    late = add("late", LISTENER.format(qos=10))
    sim.run(0.25)
    assert texts(late) == ["3", "4", "5"]


def test_discovery_takes_the_time_that_the_user_sets(sim: simkit.Simulation, add: AddProgram) -> None:
    add("talker", TALKER.format(qos=10))
    listener = add("listener", LISTENER.format(qos=10), discovery=0.25)
    sim.run(0.5)
    assert texts(listener) == ["3", "4", "5"]


def test_a_message_of_another_program_arrives_at_the_same_simulated_time(
    sim: simkit.Simulation, add: AddProgram
) -> None:
    add("talker", TALKER.format(qos=10))
    listener = add("listener", LISTENER.format(qos=10))
    sim.run(0.25)
    assert [line.split()[1] for line in listener.log] == ["[0.100000000]", "[0.200000000]"]


def test_an_incompatible_quality_of_service_is_told_on_both_sides(sim: simkit.Simulation, add: AddProgram) -> None:
    best_effort = "QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)"
    talker = add("talker", TALKER.format(qos=best_effort))
    listener = add("listener", LISTENER.format(qos=10))
    sim.run(0.3)
    assert texts(listener) == [
        "New publisher discovered on topic 'number', offering incompatible QoS. "
        "No messages will be received from it. Last incompatible policy: RELIABILITY"
    ]
    assert texts(talker) == [
        "New subscription discovered on topic 'number', requesting incompatible QoS. "
        "No messages will be sent to it. Last incompatible policy: RELIABILITY"
    ]


CLOCK = """
node.set_parameters([Parameter("use_sim_time", value=True)])
log(f"now {node.get_clock().now().nanoseconds}")
node.create_timer(0.1, lambda: log(f"timer {node.get_clock().now().nanoseconds // 1000000}"))
rclpy.spin(node)
"""


def test_the_time_is_zero_before_the_first_clock_message(sim: simkit.Simulation, add: AddProgram) -> None:
    sim.run(0.5)
    node = add("clock", CLOCK)
    sim.run(0.35)
    lines = texts(node)
    assert lines[0] == "now 0"
    assert lines[1] == "timer 510"  # due since 0.1 s: once after the first message, then on the old grid
    assert lines[2:] == ["timer 600", "timer 700", "timer 800"]


STAMPS = """
publisher = node.create_publisher(Header, "stamp", 10)
node.create_timer(0.02, lambda: publisher.publish(Header(stamp=node.get_clock().now().to_msg())))
rclpy.spin(node)
"""
DELAYS = """
def hear(header):
    now = node.get_clock().now().nanoseconds
    log(f"{header.stamp.nanosec // 1000000} {(now - header.stamp.nanosec) / 1e6:.0f}")
node.create_subscription(Header, "stamp", hear, 10)
rclpy.spin(node)
"""


def test_latency_delays_the_delivery_and_not_the_stamp(sim: simkit.Simulation, add: AddProgram) -> None:
    add("sender", STAMPS)
    receiver = add("receiver", DELAYS, latency=0.005)
    sim.run(0.07)
    assert texts(receiver) == ["20 5", "40 5", "60 5"]


def test_drawn_latencies_keep_the_order_and_repeat(tmp_path: Path) -> None:
    (tmp_path / "empty.sdf").write_text(WORLD)
    runs = []
    for seed in (1, 1, 2):
        sim = simkit.load(tmp_path / "empty.sdf", seed=seed)
        for name, code in (("sender", STAMPS), ("receiver", DELAYS)):
            (tmp_path / f"{name}.py").write_text(BEGIN.format(name=name) + code)
        sim.add_node(tmp_path / "sender.py")
        receiver = sim.add_node(tmp_path / "receiver.py", latency=(0.001, 0.05))
        sim.run(1)
        runs.append(texts(receiver))
        sim.close()
    stamps = [int(line.split()[0]) for line in runs[0]]
    delays = {int(line.split()[1]) for line in runs[0]}
    assert stamps == sorted(stamps)
    assert len(delays) > 10 and min(delays) >= 1 and max(delays) <= 51
    assert runs[0] == runs[1] != runs[2]


def test_scripts_and_programs_hear_each_other(sim: simkit.Simulation, add: AddProgram) -> None:
    heard = sim.subscribe("/answer")
    node = add(
        "echo",
        """
        publisher = node.create_publisher(Int32, "answer", 10)
        def hear(message):
            log(f"{message.data} {publisher.get_subscription_count()} {node.count_publishers('number')}")
            publisher.publish(Int32(data=2 * message.data))
        node.create_subscription(Int32, "number", hear, 10)
        rclpy.spin(node)
        """,
    )
    sim.run(0.01)
    sim.publish("/number", simkit.msgs.make("std_msgs/msg/Int32", data=21))
    sim.run(0.01)
    assert texts(node) == ["21 1 1"]
    assert [message.data for message in heard.messages] == [42]


def test_a_program_hears_its_own_messages_once(sim: simkit.Simulation, add: AddProgram) -> None:
    node = add("both", LISTENER.format(qos=10).replace("rclpy.spin(node)", "") + TALKER.format(qos=10))
    sim.run(0.25)
    assert texts(node) == ["0", "1", "2"]


def test_a_subscription_that_is_destroyed_in_its_callback_gets_no_further_message(
    sim: simkit.Simulation, add: AddProgram
) -> None:
    listener = add(
        "listener",
        """
        def receive(message):
            log(str(message.data))
            subscription.destroy()

        subscription = node.create_subscription(Int32, "number", receive, 10)
        node.create_timer(0.3, lambda: log("alive"))
        rclpy.spin(node)
        """,
    )
    add(
        "talker",
        """
        publisher = node.create_publisher(Int32, "number", 10)
        node.create_timer(0.1, lambda: [publisher.publish(Int32(data=number)) for number in range(3)])
        rclpy.spin(node)
        """,
    )
    sim.run(0.5)
    assert texts(listener) == ["0", "alive"]


def test_the_end_of_the_run_is_a_keyboard_interrupt(sim: simkit.Simulation, add: AddProgram) -> None:
    node = add(
        "main",
        """
        try:
            rclpy.spin(node)
        except KeyboardInterrupt:
            log("interrupted")
        finally:
            node.destroy_node()
            rclpy.shutdown()
            print("end")
        """,
    )
    sim.run(0.1)
    sim.close()
    assert node.log[0].endswith("[main]: interrupted")
    assert node.error is None
    assert node.done


def test_the_context_has_ended_when_the_end_of_the_run_is_seen(sim: simkit.Simulation, add: AddProgram) -> None:
    node = add(
        "main",
        """
        try:
            rclpy.spin(node)
        except KeyboardInterrupt:
            print(rclpy.ok())
        rclpy.try_shutdown()
        print("end")
        """,
    )
    sim.run(0.1)
    sim.close()
    assert node.log == ["False", "end"] and node.error is None


def test_a_callback_that_raises_ends_its_program_alone(sim: simkit.Simulation, add: AddProgram) -> None:
    bad = add("bad", "node.create_timer(0.1, lambda: 1 / 0)\nrclpy.spin(node)\n")
    good = add("good", "node.create_timer(0.1, lambda: log('tick'))\nrclpy.spin(node)\n")
    sim.run(0.35)
    assert isinstance(bad.error, ZeroDivisionError)
    assert texts(good) == ["tick", "tick", "tick"]


def test_a_reset_starts_the_programs_anew(sim: simkit.Simulation, add: AddProgram) -> None:
    add("talker", TALKER.format(qos=10))
    listener = add("listener", LISTENER.format(qos=10))
    sim.run(0.25)
    sim.reset()
    sim.run(0.35)
    assert texts(listener) == ["1", "2", "3"]


def test_each_spin_without_a_timeout_and_without_work_takes_a_step(sim: simkit.Simulation, add: AddProgram) -> None:
    node = add(
        "busy",
        """
        begun = node.get_clock().now()
        count = 0
        while (node.get_clock().now() - begun).nanoseconds < 1e8:
            count += 1
            rclpy.spin_once(node, timeout_sec=0)
        log(f"{99 <= count <= 101}")
        """,
    )
    sim.run(0.2)
    assert texts(node) == ["True"]
    assert node.done


def test_the_nodes_of_programs_are_listed(sim: simkit.Simulation, add: AddProgram) -> None:
    node = add(
        "list",
        """
        def tell():
            log(str(sorted(name for name in node.get_node_names() if "list" in name)))
            rclpy.shutdown()
        node.create_timer(0.1, tell)
        rclpy.spin(node)
        """,
        namespace="robot",
    )
    add("listener", LISTENER.format(qos=1))
    sim.run(0.2)
    assert texts(node) == ["['list', 'listener']"]


def test_commands_about_nodes_and_topics_show_programs(sim: simkit.Simulation, add: AddProgram) -> None:
    add("talker", TALKER.format(qos=10), namespace="robot")
    add("listener", LISTENER.format(qos=10), remap={"number": "/robot/number"})
    sim.run(0.1)
    nodes = node_list(sim, ())
    assert nodes["/robot/talker"]["publishers"]["/robot/number"] == ["std_msgs/msg/Int32"]
    assert nodes["/listener"]["subscribers"]["/robot/number"] == ["std_msgs/msg/Int32"]
    rows = {row["name"]: row for row in topic_list(sim, ())}
    assert [end["node"] for end in rows["/robot/number"]["subscribers"]] == ["/listener"]


def test_a_volatile_subscription_gets_no_earlier_message_of_a_latched_topic(
    sim: simkit.Simulation, add: AddProgram
) -> None:
    sim.advertise("/number", "std_msgs/msg/Int32", latched=True).publish({"data": 7})
    sim.run(0.1)
    volatile, local = add("volatile", LISTENER.format(qos=10)), add("local", LISTENER.format(qos="LOCAL"))
    sim.run(0.1)
    assert texts(volatile) == []
    assert texts(local) == ["7"]


def test_a_jump_back_of_the_time_fires_no_timer_before_a_period_has_passed(
    sim: simkit.Simulation, add: AddProgram
) -> None:
    node = add("timer", "node.create_timer(0.1, lambda: log('tick'))\nrclpy.spin(node)\n")
    beginning = sim.snapshot()
    sim.run(0.55)
    node.log.clear()
    sim.restore(beginning)
    sim.run(0.25)
    assert [line.split()[1] for line in node.log] == ["[0.100000000]", "[0.200000000]"]


def test_a_topic_of_another_type_is_told(sim: simkit.Simulation, add: AddProgram) -> None:
    sim.advertise("/number", "std_msgs/msg/String")
    listener, talker = add("listener", LISTENER.format(qos=10)), add("talker", TALKER.format(qos=10))
    sim.run(0.05)
    text = "Incompatible type on topic 'number', no messages will be sent to it."
    assert texts(listener) == texts(talker) == [text]
    assert "SK-NODE-010" in [item.code for item in sim.diagnostics]
