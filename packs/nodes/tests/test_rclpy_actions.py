"""Action servers and clients of rclpy: programs with each other, with plugins and with scripts."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import simkit
from simkit.msgs.goal_status import GoalStatus
from simkit_nodes.programs import NodeProgram
from simkit_verification.testing.bundles import keep, replay, write_bundle

EMPTY = '<sdf version="1.9"><world name="w"/></sdf>'
FIBONACCI = "example_interfaces/action/Fibonacci"

SERVER = '''
import sys
import time

import rclpy
from example_interfaces.action import Fibonacci
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node


class Server(Node):
    """Fibonacci numbers, one each 100 ms; `order` 13 is rejected, 99 raises, 98 sets no status."""

    def __init__(self):
        super().__init__("fibonacci_server")
        self.server = ActionServer(
            self, Fibonacci, "fibonacci", self.execute, callback_group=ReentrantCallbackGroup(),
            goal_callback=self.decide, cancel_callback=lambda goal: CancelResponse.ACCEPT,
        )

    def decide(self, request):
        return GoalResponse.REJECT if request.order == 13 else GoalResponse.ACCEPT

    def execute(self, goal):
        if goal.request.order == 99:
            raise ValueError("too large")
        if goal.request.order == 98:
            return Fibonacci.Result()
        feedback = Fibonacci.Feedback()
        feedback.sequence = [0, 1]
        for i in range(1, goal.request.order):
            if goal.is_cancel_requested:
                goal.canceled()
                self.get_logger().info("canceled")
                return Fibonacci.Result(sequence=feedback.sequence)
            feedback.sequence.append(feedback.sequence[i] + feedback.sequence[i - 1])
            goal.publish_feedback(feedback)
            time.sleep(0.1)
        goal.succeed()
        result = Fibonacci.Result()
        result.sequence = feedback.sequence
        return result


def main():
    rclpy.init()
    rclpy.spin(Server(), executor=MultiThreadedExecutor(4))


if __name__ == "__main__":
    main()
'''

CLIENT = """
import rclpy
from action_msgs.msg import GoalStatus
from example_interfaces.action import Fibonacci
from rclpy.action import ActionClient
from rclpy.node import Node


class Client(Node):
    def __init__(self):
        super().__init__("fibonacci_client")
        self.declare_parameter("order", 4)
        self.declare_parameter("cancel_after", 0.0)
        self.client = ActionClient(self, Fibonacci, "fibonacci")

    def send_goal(self):
        self.client.wait_for_server()
        goal = Fibonacci.Goal(order=self.get_parameter("order").value)
        self.future = self.client.send_goal_async(goal, feedback_callback=self.on_feedback)
        self.future.add_done_callback(self.on_response)

    def on_response(self, future):
        self.goal = future.result()
        self.get_logger().info(f"accepted {self.goal.accepted}")
        if not self.goal.accepted:
            rclpy.shutdown()
            return
        self.goal.get_result_async().add_done_callback(self.on_result)
        seconds = self.get_parameter("cancel_after").value
        if seconds:
            self.timer = self.create_timer(seconds, self.cancel)

    def cancel(self):
        self.timer.cancel()
        self.goal.cancel_goal_async().add_done_callback(self.on_cancel)

    def on_cancel(self, future):
        self.get_logger().info(f"canceling {len(future.result().goals_canceling)}")

    def on_feedback(self, message):
        self.get_logger().info(f"feedback {list(message.feedback.sequence)}")

    def on_result(self, future):
        status = future.result().status
        self.get_logger().info(f"result {status} {list(future.result().result.sequence)}")
        rclpy.shutdown()


def main():
    rclpy.init()
    node = Client()
    node.send_goal()
    rclpy.spin(node)


if __name__ == "__main__":
    main()
"""


@pytest.fixture
def files(tmp_path: Path) -> Callable[[str, str], Path]:
    """Function that writes a program."""

    def write(name: str, text: str) -> Path:
        path = tmp_path / f"{name}.py"
        path.write_text(text)
        return path

    return write


def texts(program: NodeProgram) -> list[str]:
    """Return the logged texts without level, time and name."""
    return [line.split("]: ", 1)[1] for line in program.log if "]: " in line]


def run_client(files: Any, seconds: float = 5.0, **params: Any) -> list[str]:
    with simkit.load(EMPTY) as sim:
        server = sim.add_node(files("server", SERVER))
        client = sim.add_node(files("client", CLIENT), params=params)
        sim.run_until(lambda _: client.done, seconds)
        assert client.done and client.error is None
        assert server.error is None and not server.done
        return texts(client)


def test_acceptance_feedback_and_result_arrive_in_this_order(files: Any) -> None:
    assert run_client(files, order=4) == [
        "accepted True",
        "feedback [0, 1, 1]",
        "feedback [0, 1, 1, 2]",
        "feedback [0, 1, 1, 2, 3]",
        "result 4 [0, 1, 1, 2, 3]",
    ]


def test_a_goal_is_rejected(files: Any) -> None:
    assert run_client(files, order=13) == ["accepted False"]


def test_a_goal_is_cancelled_while_it_is_executed(files: Any) -> None:
    lines = run_client(files, order=50, cancel_after=0.25)
    assert "canceling 1" in lines
    assert lines[-1] == "result 5 [0, 1, 1, 2, 3]"


def test_an_exception_or_no_status_aborts_the_goal(files: Any) -> None:
    for order in (99, 98):
        assert run_client(files, order=order) == ["accepted True", "result 6 []"]


def test_the_server_logs_what_rclpy_logs_for_goals_without_a_status(files: Any) -> None:
    with simkit.load(EMPTY) as sim:
        server = sim.add_node(files("server", SERVER))
        sim.run(0.1)
        goal = sim.send_goal("/fibonacci", {"order": 99})
        sim.run(0.1)
        assert goal.status is GoalStatus.ABORTED
        lines = texts(server)
        assert lines[0] == "Error raised in execute callback: too large"
        assert lines[1].startswith("Goal state not set, assuming aborted. Goal ID: [")
        assert "[fibonacci_server.action_server]" in server.log[0]


def test_a_script_uses_the_action_of_a_program_and_a_program_that_of_a_script(files: Any) -> None:
    with simkit.load(EMPTY) as sim:
        sim.add_node(files("server", SERVER))
        sim.run(0.1)
        feedback: list[Any] = []
        goal = sim.send_goal("/fibonacci", {"order": 3}, lambda message: feedback.append(list(message.sequence)))
        sim.run(1.0)
        assert goal.status is GoalStatus.SUCCEEDED and list(goal.result.sequence) == [0, 1, 1, 2]
        assert feedback == [[0, 1, 1], [0, 1, 1, 2]]
    goals: list[Any] = []
    with simkit.load(EMPTY) as sim:
        sim.act("/fibonacci", FIBONACCI, goals.append, lambda goal: goal.canceled({"sequence": [1]}))
        client = sim.add_node(files("client", CLIENT), params={"order": 7, "cancel_after": 0.5})
        sim.run(0.3)
        assert goals[0].request.order == 7
        goals[0].publish_feedback({"sequence": [4]})
        sim.run(1.0)
        assert texts(client) == ["accepted True", "feedback [4]", "result 5 [1]"], "the program ends with the result"


def test_the_goals_of_a_run_have_the_same_identifiers_in_each_run(files: Any) -> None:
    log_id = "self.get_logger().info(str(list(goal.goal_id.uuid)))"
    program = files(
        "ids", SERVER.replace("feedback = Fibonacci.Feedback()", f"feedback = Fibonacci.Feedback(); {log_id}")
    )
    runs = []
    for _ in range(2):
        with simkit.load(EMPTY, seed=3) as sim:
            server = sim.add_node(program)
            sim.add_node(files("client", CLIENT), params={"order": 2})
            sim.run(0.2)
            sim.send_goal("/fibonacci", {"order": 2})
            sim.run(0.5)
            runs.append(texts(server))
    assert runs[0] == runs[1] and len(set(runs[0])) == 2


SYNCHRONOUS = """
import threading

import rclpy
from example_interfaces.action import Fibonacci
from rclpy.action import ActionClient

rclpy.init()
node = rclpy.create_node("client")
client = ActionClient(node, Fibonacci, "fibonacci")
thread = threading.Thread(target=rclpy.spin, args=(node,), daemon=True)
thread.start()
print_ = node.get_logger().info
print_(f"{client.wait_for_server(timeout_sec=5.0)} {client.server_is_ready()}")
response = client.send_goal(Fibonacci.Goal(order=3))
print_(f"{response.status} {list(response.result.sequence)}")
try:
    client.send_goal(Fibonacci.Result())
except TypeError:
    print_("TypeError")
client.destroy()
rclpy.shutdown()
thread.join()
"""


def test_a_goal_may_be_sent_without_a_callback_while_another_thread_spins(files: Any) -> None:
    with simkit.load(EMPTY) as sim:
        sim.add_node(files("server", SERVER))
        client = sim.add_node(files("synchronous", SYNCHRONOUS))
        sim.run_until(lambda _: client.done, 5.0)
        assert client.error is None
        assert texts(client) == ["True True", "4 [0, 1, 1, 2]", "TypeError"]


RESULTS = """
import time

import rclpy
from example_interfaces.action import Fibonacci
from rclpy.action import ActionClient, ActionServer

rclpy.init()
node = rclpy.create_node("results")
info = node.get_logger().info


def execute(goal):
    goal.succeed()
    return Fibonacci.Result(sequence=[7])


server = ActionServer(node, Fibonacci, "kept", execute, result_timeout=1)
client = ActionClient(node, Fibonacci, "kept")
client.wait_for_server()


def done(future):
    rclpy.spin_until_future_complete(node, future, timeout_sec=5.0)
    return future.result()


goal = done(client.send_goal_async(Fibonacci.Goal(order=1)))
for seconds in (0.3, 0.3, 1.0):
    time.sleep(seconds)
    response = done(goal.get_result_async())
    info(f"{response.status} {list(response.result.sequence)} {goal.status}")
response = done(goal.cancel_goal_async())
info(f"{response.return_code} {len(response.goals_canceling)}")
info(repr(goal)[:20])
rclpy.shutdown()
"""


def test_a_result_is_kept_for_its_timeout_and_an_ended_goal_is_not_cancelled(files: Any) -> None:
    with simkit.load(EMPTY) as sim:
        program = sim.add_node(files("results", RESULTS))
        sim.run_until(lambda _: program.done, 10.0)
        assert program.error is None
        assert texts(program) == ["4 [7] 4", "4 [7] 4", "0 [] 4", "3 0", "ClientGoalHandle <id"]


DEFERRED = """
import rclpy
from example_interfaces.action import Fibonacci
from rclpy.action import ActionClient, ActionServer, GoalResponse

rclpy.init()
node = rclpy.create_node("deferred")
info = node.get_logger().info
waiting = []


async def execute(goal):
    info(f"execute {goal.request.order} {goal.status}")
    goal.succeed()
    return Fibonacci.Result(sequence=[goal.request.order])


server = ActionServer(node, Fibonacci, "later", execute, handle_accepted_callback=waiting.append)
client = ActionClient(node, Fibonacci, "later")
client.wait_for_server()
goals = [client.send_goal_async(Fibonacci.Goal(order=order)) for order in (1, 2)]


def begin():
    if waiting:
        info(f"begin with {waiting[-1].request.order}, {waiting[-1].status}")
        waiting.pop().execute()


node.create_timer(0.5, begin)
handles = []
for future in goals:
    rclpy.spin_until_future_complete(node, future)
    handles.append(future.result())
results = [handle.get_result_async() for handle in handles]
for future in results:
    rclpy.spin_until_future_complete(node, future)
    info(f"result {list(future.result().result.sequence)}")
try:
    server.register_execute_callback(None)
except TypeError as error:
    info(str(error))
rclpy.shutdown()
"""


def test_accepted_goals_may_be_executed_later_and_by_coroutines(files: Any) -> None:
    with simkit.load(EMPTY) as sim:
        program = sim.add_node(files("deferred", DEFERRED))
        sim.run_until(lambda _: program.done, 10.0)
        assert program.error is None
        assert texts(program) == [
            "begin with 2, 1",
            "execute 2 2",
            "begin with 1, 1",
            "execute 1 2",
            "result [1]",
            "result [2]",
            "Failed to register goal execution callback: not callable",
        ]


def test_an_execution_that_returns_no_result_is_an_error_of_the_program(files: Any) -> None:
    text = SERVER.replace("return Fibonacci.Result()", "return goal.succeed()")
    with simkit.load(EMPTY) as sim:
        server = sim.add_node(files("wrong", text.replace("executor=MultiThreadedExecutor(4)", "")))
        sim.run(0.1)
        sim.send_goal("/fibonacci", {"order": 98})
        sim.run(0.1)
        assert isinstance(server.error, AssertionError)
        assert "The 'result' field must be a sub message of type 'Fibonacci_Result'" in str(server.error)


ARM = """<sdf version='1.9'><world name='lab'><model name='arm'>
<joint name='fixed' type='fixed'><parent>world</parent><child>base</child></joint>
<link name='base'/><link name='upper'><inertial><pose>0 0 0.2 0 0 0</pose><mass>1</mass></inertial></link>
<joint name='shoulder' type='revolute'><parent>base</parent><child>upper</child><axis><xyz>0 1 0</xyz>
<limit><lower>-1.5</lower><upper>1.5</upper><effort>60</effort><velocity>2</velocity></limit></axis></joint>
<plugin filename='libgz_ros2_control-system.so' name='gz_ros2_control::GazeboSimROS2ControlPlugin'>
<parameters>arm.yaml</parameters></plugin></model></world></sdf>"""
CONTROLLERS = """
controller_manager:
  ros__parameters:
    update_rate: 100
    arm_controller: {type: joint_trajectory_controller/JointTrajectoryController}
arm_controller:
  ros__parameters: {joints: [shoulder], command_interfaces: [position], state_interfaces: [position, velocity]}
"""
MOVER = """
import rclpy
from builtin_interfaces.msg import Duration
from control_msgs.action import FollowJointTrajectory
from rclpy.action import ActionClient
from trajectory_msgs.msg import JointTrajectoryPoint

rclpy.init()
node = rclpy.create_node("mover")
client = ActionClient(node, FollowJointTrajectory, "/arm_controller/follow_joint_trajectory")
client.wait_for_server()
goal = FollowJointTrajectory.Goal()
goal.trajectory.joint_names = ["shoulder"]
goal.trajectory.points = [JointTrajectoryPoint(positions=[0.5], time_from_start=Duration(sec=1))]
feedback = []
future = client.send_goal_async(goal, feedback_callback=feedback.append)
rclpy.spin_until_future_complete(node, future)
result = future.result().get_result_async()
rclpy.spin_until_future_complete(node, result)
node.get_logger().info(f"{result.result().status} {result.result().result.error_code} {len(feedback) > 5}")
rclpy.shutdown()
"""


def test_a_program_moves_an_arm_by_the_action_of_a_controller(files: Any, tmp_path: Path) -> None:
    (tmp_path / "arm.yaml").write_text(CONTROLLERS)
    (tmp_path / "arm.sdf").write_text(ARM)
    with simkit.load(tmp_path / "arm.sdf") as sim:
        program = sim.add_node(files("mover", MOVER))
        assert sim.run_until(lambda _: program.done, 5.0)
        assert program.error is None
        assert texts(program) == ["4 0 True"]
        assert sim.joint("arm::shoulder").position == pytest.approx(0.5, abs=0.05)


def test_a_bundle_repeats_the_goals_of_programs_without_them(files: Any, tmp_path: Path) -> None:
    world = tmp_path / "yard.sdf"
    world.write_text("<sdf version='1.9'><world name='yard'><model name='ball'><link name='l'/></model></world></sdf>")
    with simkit.load(world) as sim, keep(sim):
        sim.add_node(files("server", SERVER))
        sim.add_node(files("client", CLIENT), params={"order": 3})
        sim.add_node(files("cancelling", CLIENT), params={"order": 9, "cancel_after": 0.2})
        sim.run(0.1)

        def move(goal: Any) -> None:
            sim.model("ball").set_velocity((0.1 * goal.result.sequence[-1], 0.0, 0.0), (0.0, 0.0, 0.0))

        sim.send_goal("/fibonacci", {"order": 4}, on_done=move)
        sim.run(1.0)
        bundle = write_bundle(sim, tmp_path / "run.zip")
    found = replay(bundle)
    assert found.is_same, (found.differences, found.refused)
    assert not found.refused
