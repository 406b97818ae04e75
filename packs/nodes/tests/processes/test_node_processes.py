"""Programs in processes of their own talk to the simulation and to each other."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from conftest import NodeProcess, RunningWorld

    RunNode = Callable[..., NodeProcess]

pytestmark = pytest.mark.slow

TALKER = """
    import rclpy
    from rclpy.node import Node
    from std_msgs.msg import String

    class Talker(Node):
        def __init__(self):
            super().__init__("talker")
            self.declare_parameter("greeting", "hello")
            self.publisher = self.create_publisher(String, "chatter", 10)
            self.create_timer(0.05, self.say)
            self.count = 0

        def say(self):
            self.count += 1
            self.publisher.publish(String(data=f"{self.get_parameter('greeting').value} {self.count}"))

    rclpy.init()
    rclpy.spin(Talker())
"""
LISTENER = """
    import rclpy
    from std_msgs.msg import String

    rclpy.init()
    node = rclpy.create_node("listener")
    node.create_subscription(String, "chatter", lambda message: node.get_logger().info(f"heard {message.data}"), 10)
    rclpy.spin(node)
"""


def test_two_programs_talk_over_the_simulation_which_lists_their_nodes(world: RunningWorld, run_node: RunNode) -> None:
    talker, listener = run_node(TALKER, name="talker"), run_node(LISTENER, name="listener")
    listener.wait_for("heard hello")
    nodes: dict[str, Any] = world.client.ask("nodes")
    assert nodes["/talker"]["publishers"]["/chatter"] == ["std_msgs/msg/String"]
    assert nodes["/listener"]["subscribers"]["/chatter"] == ["std_msgs/msg/String"]
    request = {"parameters": [{"name": "greeting", "value": {"type": 4, "string_value": "good morning"}}]}
    assert world.client.call("/talker/set_parameters", request).results[0].successful
    listener.wait_for("heard good morning")
    assert world.client.call("/talker/_ping").message == str(talker.process.pid)
    world.client.call("/talker/_kill")
    assert talker.exit_code() == 130
    assert talker.lines[-1] == "KeyboardInterrupt"
    assert "simkit_nodes" not in talker.text
    world.wait(lambda: "/talker" not in world.client.ask("nodes"))
    assert listener.end() == 130


def test_arguments_of_ros_rename_a_node_and_its_topics(world: RunningWorld, run_node: RunNode) -> None:
    words = ["--ros-args", "-r", "__node:=speaker", "-r", "__ns:=/r1", "-r", "chatter:=news", "-p", "greeting:=hi"]
    run_node(TALKER, *words)
    assert world.client.subscribe("/r1/news").get(60.0).message.data.startswith("hi ")
    assert "/r1/speaker" in world.client.ask("nodes")


def test_a_late_subscription_gets_the_last_message_of_a_transient_local_topic_only(
    world: RunningWorld, run_node: RunNode
) -> None:
    sender = run_node(
        """
        import rclpy
        from rclpy.qos import DurabilityPolicy, QoSProfile
        from std_msgs.msg import String

        rclpy.init()
        node = rclpy.create_node("sender")
        kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        publishers = [node.create_publisher(String, "kept", kept), node.create_publisher(String, "lost", 1)]
        for publisher in publishers:
            publisher.publish(String(data="early"))
        print("published", flush=True)
        rclpy.spin(node)
        """
    )
    sender.wait_for("published")
    receiver = run_node(
        """
        import rclpy
        from rclpy.qos import DurabilityPolicy, QoSProfile
        from std_msgs.msg import String

        rclpy.init()
        node = rclpy.create_node("receiver")
        kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        node.create_subscription(String, "kept", lambda message: print("volatile got", message.data, flush=True), 1)
        node.create_subscription(String, "lost", lambda message: print("lost got", message.data, flush=True), 1)
        node.create_subscription(String, "kept", lambda message: print("kept got", message.data, flush=True), kept)
        end = node.create_timer(1.0, lambda: print("end", flush=True))
        rclpy.spin(node)
        """,
        name="receiver",
    )
    receiver.wait_for("end")
    assert [line for line in receiver.lines if "got" in line] == ["kept got early"]


def test_a_client_of_another_process_calls_a_service_and_reads_its_parameters(
    world: RunningWorld, run_node: RunNode
) -> None:
    server = run_node(
        """
        import rclpy
        from rclpy.executors import ExternalShutdownException
        from example_interfaces.srv import AddTwoInts

        def add(request, response):
            response.sum = request.a + request.b
            return response

        rclpy.init()
        node = rclpy.create_node("adder")
        node.declare_parameter("gain", 2.5)
        node.create_service(AddTwoInts, "add_two_ints", add)
        try:
            rclpy.spin(node)
        except (KeyboardInterrupt, ExternalShutdownException):
            print("clean", flush=True)
        """,
        name="adder",
    )
    client = run_node(
        """
        import rclpy
        from example_interfaces.srv import AddTwoInts
        from rclpy.parameter_client import AsyncParameterClient

        rclpy.init()
        node = rclpy.create_node("asker")
        client = node.create_client(AddTwoInts, "add_two_ints")
        assert client.wait_for_service(timeout_sec=30.0)
        future = client.call_async(AddTwoInts.Request(a=41, b=1))
        rclpy.spin_until_future_complete(node, future)
        print("sum", future.result().sum)
        parameters = AsyncParameterClient(node, "adder")
        assert parameters.wait_for_services(30.0)
        future = parameters.get_parameters(["gain"])
        rclpy.spin_until_future_complete(node, future)
        print("gain", future.result().values[0].double_value)
        rclpy.shutdown()
        """,
        name="asker",
    )
    assert client.exit_code() == 0, client.text
    assert client.lines == ["sum 42", "gain 2.5"]
    assert world.client.call("/add_two_ints", {"a": 1, "b": 2}).sum == 3
    assert server.end() == 0
    assert server.lines == ["clean"]


def test_an_action_of_another_process_accepts_feeds_back_ends_and_is_cancelled(
    world: RunningWorld, run_node: RunNode
) -> None:
    server = run_node(
        """
        import time
        import rclpy
        from example_interfaces.action import Fibonacci
        from rclpy.action import ActionServer, CancelResponse
        from rclpy.executors import MultiThreadedExecutor

        def execute(goal):
            sequence = [0, 1]
            for _ in range(goal.request.order):
                if goal.is_cancel_requested:
                    goal.canceled()
                    return Fibonacci.Result(sequence=sequence)
                sequence.append(sequence[-1] + sequence[-2])
                goal.publish_feedback(Fibonacci.Feedback(sequence=sequence))
                time.sleep(0.02)
            goal.succeed()
            return Fibonacci.Result(sequence=sequence)

        rclpy.init()
        node = rclpy.create_node("counter")
        ActionServer(node, Fibonacci, "count", execute, cancel_callback=lambda goal: CancelResponse.ACCEPT)
        rclpy.spin(node, MultiThreadedExecutor())
        """,
        name="counter",
    )
    client = run_node(
        """
        import rclpy
        from example_interfaces.action import Fibonacci
        from rclpy.action import ActionClient

        def wait(future):
            rclpy.spin_until_future_complete(node, future)
            return future.result()

        rclpy.init()
        node = rclpy.create_node("asker")
        client = ActionClient(node, Fibonacci, "count")
        assert client.wait_for_server(30.0)
        feedback = []
        goal = wait(client.send_goal_async(Fibonacci.Goal(order=3), lambda message: feedback.append(message.feedback)))
        result = wait(goal.get_result_async())
        print("accepted", goal.accepted, "status", result.status, "sequence", list(result.result.sequence))
        print("feedback", [list(each.sequence) for each in feedback])
        goal = wait(client.send_goal_async(Fibonacci.Goal(order=2000)))
        response = wait(goal.cancel_goal_async())
        print("cancelling", len(response.goals_canceling), "status", wait(goal.get_result_async()).status)
        """,
        name="asker",
    )
    assert client.exit_code() == 0, client.text
    assert client.lines == [
        "accepted True status 4 sequence [0, 1, 1, 2, 3]",
        "feedback [[0, 1, 1], [0, 1, 1, 2], [0, 1, 1, 2, 3]]",
        "cancelling 1 status 5",
    ]
    goal = world.client.send_goal("/count", {"order": 1})
    assert goal.wait(30.0)
    assert list(goal.result.sequence) == [0, 1, 1]
    assert server.process.poll() is None


def test_a_callback_that_sleeps_does_not_stop_other_threads(world: RunningWorld, run_node: RunNode) -> None:
    program = run_node(
        """
        import threading
        import rclpy
        from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
        from rclpy.executors import MultiThreadedExecutor
        from std_srvs.srv import Trigger

        rclpy.init()
        node = rclpy.create_node("busy")
        groups = [MutuallyExclusiveCallbackGroup() for _ in range(2)]
        is_called = threading.Event()

        def answer(request, response):
            is_called.set()
            response.message = "now"
            return response

        def ask():
            timer.cancel()
            print("answer", client.call(Trigger.Request()).message, is_called.wait(5.0), flush=True)

        node.create_service(Trigger, "ask", answer, callback_group=groups[0])
        client = node.create_client(Trigger, "ask", callback_group=groups[1])
        client.wait_for_service()
        timer = node.create_timer(0.01, ask, callback_group=MutuallyExclusiveCallbackGroup())
        executor = MultiThreadedExecutor()
        executor.add_node(node)
        thread = threading.Thread(target=executor.spin, daemon=True)
        thread.start()
        rate = node.create_rate(50)
        for _ in range(3):
            rate.sleep()
        print("slept", flush=True)
        thread.join()
        """
    )
    program.wait_for("answer now True")
    program.wait_for("slept")


def test_a_node_with_use_sim_time_follows_the_clock_of_the_simulation(world: RunningWorld, run_node: RunNode) -> None:
    program = run_node(
        """
        import rclpy

        rclpy.init()
        node = rclpy.create_node("sleeper")
        node.create_timer(0.1, lambda: print("at", node.get_clock().now().nanoseconds, flush=True))
        rclpy.spin(node)
        """,
        "--ros-args",
        "-p",
        "use_sim_time:=true",
    )
    now = int(program.wait_for("at").split()[1])
    assert now <= world.client.state()["time_ns"]


def test_a_killed_process_leaves_the_run(world: RunningWorld, run_node: RunNode) -> None:
    talker = run_node(TALKER)
    world.wait(lambda: "/talker" in world.client.ask("nodes"))
    talker.process.kill()
    world.wait(lambda: "/talker" not in world.client.ask("nodes"))
    assert "/chatter" not in [row["name"] for row in world.client.topics() if row["publishers"]]


def test_a_second_node_of_the_same_name_is_reported_once(world: RunningWorld, run_node: RunNode) -> None:
    run_node(TALKER)
    world.wait(lambda: "/talker/_ping" in world.client.services())
    second = run_node(TALKER, name="second")
    line = second.wait_for("warning")
    assert line.startswith("warning SK-NODE-071: another program has a node '/talker', which answers")
    pid = world.client.call("/talker/_ping").message
    assert int(pid) != second.process.pid
    assert second.end() == 130, second.text
    assert second.text.count("warning") == 1


def test_a_program_ends_with_the_simulation(world: RunningWorld, run_node: RunNode) -> None:
    listener = run_node(LISTENER)
    asleep = run_node("import time\nprint('asleep', flush=True)\ntime.sleep(1000)", name="asleep")
    asleep.wait_for("asleep")
    world.wait(lambda: "/listener" in world.client.ask("nodes"))
    world.close()
    for process in (listener, asleep):
        assert process.exit_code() == 2
        assert process.lines[-1].startswith("error: SK-LIVE-005 simulation 'empty' has ended")
        assert "Traceback" not in process.text


@pytest.mark.parametrize("spin", ["rclpy.spin(node)", "executor.spin()"])
def test_spin_raises_if_the_simulation_ends_during_a_callback(
    world: RunningWorld, run_node: RunNode, spin: str
) -> None:
    program = run_node(
        f"""
        import time, rclpy
        from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor

        rclpy.init()
        node = rclpy.create_node("busy")
        executor = SingleThreadedExecutor()
        executor.add_node(node)

        def work():
            print("works", flush=True)
            while rclpy.ok():
                time.sleep(0.001)

        node.create_timer(0.01, work)
        try:
            {spin}
        except ExternalShutdownException:
            print("has raised", flush=True)
            raise
        """
    )
    program.wait_for("works")
    world.close()
    assert program.exit_code() == 2
    assert "has raised" in program.lines


@pytest.mark.parametrize(
    "call",
    [
        "rclpy.create_node('late')",
        "publisher.publish(String())",
        "node.create_timer(1.0, print)",
        "rclpy.spin_once(node)",
    ],
)
def test_a_call_after_the_end_of_the_simulation_prints_no_traceback(
    world: RunningWorld, run_node: RunNode, call: str
) -> None:
    """Some calls raise then, others do nothing."""
    program = run_node(
        f"""
        import time, rclpy
        from std_msgs.msg import String

        rclpy.init()
        node = rclpy.create_node("early")
        publisher = node.create_publisher(String, "chatter", 10)
        print("ready", flush=True)
        while rclpy.ok():
            time.sleep(0.001)
        {call}
        time.sleep(1000)
        """
    )
    program.wait_for("ready")
    world.close()
    assert program.exit_code() == 2
    assert program.lines[-1].startswith("error: SK-LIVE-005 simulation 'empty' has ended")
    assert "Traceback" not in program.text


@pytest.mark.parametrize("call", ["rclpy.create_node('n').destroy_node()", "publisher.publish(String())"])
def test_the_end_of_the_simulation_in_the_middle_of_a_call_prints_no_traceback(
    world: RunningWorld, run_node: RunNode, call: str
) -> None:
    program = run_node(
        f"""
        import rclpy
        from std_msgs.msg import String

        rclpy.init()
        node = rclpy.create_node("early")
        publisher = node.create_publisher(String, "chatter", 10)
        print("ready", flush=True)
        while True:
            {call}
        """
    )
    program.wait_for("ready")
    world.close()
    assert program.exit_code() == 2
    assert program.lines[-1].startswith("error: SK-LIVE-005 simulation 'empty' has ended")
    assert "Traceback" not in program.text


def test_an_exception_of_the_program_itself_after_the_end_of_the_simulation_is_printed(
    world: RunningWorld, run_node: RunNode
) -> None:
    program = run_node(
        """
        import time, rclpy

        rclpy.init()
        print("ready", flush=True)
        while rclpy.ok():
            time.sleep(0.001)
        raise ValueError("no way")
        """
    )
    program.wait_for("ready")
    world.close()
    assert program.exit_code() == 2
    assert "ValueError: no way" in program.text


def test_a_program_that_raises_ends_with_its_own_traceback(world: RunningWorld, run_node: RunNode) -> None:
    program = run_node(
        """
        import rclpy

        def fail():
            raise ValueError("no way")

        rclpy.init()
        node = rclpy.create_node("failing")
        node.create_timer(0.01, fail)
        rclpy.spin(node)
        """
    )
    assert program.exit_code() == 1
    assert program.lines[-1] == "ValueError: no way"
    assert program.lines[1].startswith(f'  File "{program.process.args[-1]}", line ')


def test_a_program_has_its_own_modules_and_those_of_its_package(
    world: RunningWorld, run_node: RunNode, tmp_path: Any
) -> None:
    (tmp_path / "helper.py").write_text("NUMBER = 7\n")
    for package in ("plain_msgs", "mixed"):
        (tmp_path / package / "msg").mkdir(parents=True)
        (tmp_path / package / "msg" / "Num.msg").write_text("int64 num\n")
        (tmp_path / package / "package.xml").write_text(f"<package><name>{package}</name></package>")
    (tmp_path / "mixed" / "mixed").mkdir()
    (tmp_path / "mixed" / "mixed" / "__init__.py").write_text("WORD = 'mixed'\n")
    program = run_node(
        """
        import sys, threading, time
        from helper import NUMBER
        from geometry_msgs.msg import Twist
        from mixed import WORD
        from mixed.msg import Num as Mixed
        from plain_msgs.msg import Num
        import rclpy.node, geometry_msgs.msg

        threading.Thread(target=lambda: (time.sleep(0.1), print("thread", flush=True))).start()
        print(NUMBER, WORD, Num(num=1).num + Mixed(num=2).num, sys.argv[1:], flush=True)
        print(sys.modules["__main__"].NUMBER, geometry_msgs.msg.Twist is Twist, flush=True)
        sys.exit(3)
        """,
        "word",
    )
    assert program.exit_code() == 3
    assert program.lines == ["7 mixed 3 ['word']", "7 True", "thread"]


def test_a_wrong_file_of_parameters_ends_the_command_before_the_program(
    world: RunningWorld, run_node: RunNode, tmp_path: Path
) -> None:
    (tmp_path / "params.yaml").write_text("/**:\n  ros_parameters:\n    speed: 0.2\n")
    program = run_node("print('started')", "--ros-args", "--params-file", str(tmp_path / "params.yaml"))
    assert program.exit_code() == 2
    assert "params.yaml:3 has a value outside of a block ros__parameters" in program.text
    assert "started" not in program.text and "Traceback" not in program.text


def test_without_a_simulation_a_program_does_not_start(run_node: RunNode) -> None:
    program = run_node(LISTENER, options=())
    assert program.exit_code() == 2
    assert program.lines[0].startswith("error: SK-LIVE-001 no simulation runs; start one with `simkit run WORLD`")


@pytest.mark.skipif(sys.platform == "win32", reason="signals end a process of Windows at once")
def test_ctrl_c_shuts_the_context_down(world: RunningWorld, run_node: RunNode) -> None:
    program = run_node(
        """
        import os, rclpy

        rclpy.init()
        node = rclpy.create_node("waiting")
        node.create_timer(0.01, lambda: print("spins", os.getpid(), flush=True))
        try:
            rclpy.spin(node)
        except KeyboardInterrupt:
            print("interrupted", rclpy.ok(), flush=True)
        """
    )
    pid = int(program.wait_for("spins").split()[1])
    os.kill(pid, signal.SIGINT)
    assert program.exit_code() == 0
    assert program.lines[-1] == "interrupted False"
