"""Services and parameters of rclpy programs together with the simulation, its tools and its command line."""

from __future__ import annotations

import threading
from collections.abc import Callable
from pathlib import Path
from textwrap import dedent
from typing import Any

import pytest

import simkit
from simkit.errors import InputError
from simkit.live import Client, Server
from simkit_nodes.programs import NodeProgram

BALL = """<sdf version="1.9"><world name="yard"><gravity>0 0 0</gravity>
<model name="ball"><link name="l"/></model></world></sdf>"""

ADDER = """
import time

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.node import Node


class Adder(Node):
    def __init__(self):
        super().__init__("adder")
        self.declare_parameter("delay", 0.0)
        self.declare_parameter("gains.p", 2)
        self.create_service(AddTwoInts, "add", self.add)

    def add(self, request, response):
        if self.get_parameter("delay").value:
            time.sleep(self.get_parameter("delay").value)
        response.sum = request.a + request.b
        return response


def main():
    rclpy.init()
    rclpy.spin(Adder())


if __name__ == "__main__":
    main()
"""


@pytest.fixture
def write(tmp_path: Path) -> Callable[[str, str], Path]:
    """Function that writes a program."""

    def write(name: str, text: str) -> Path:
        path = tmp_path / f"{name}.py"
        path.write_text(text)
        return path

    return write


def texts(program: NodeProgram) -> list[str]:
    """Return the logged texts without level, time and name."""
    return [line.split("]: ", 1)[1] for line in program.log if "]: " in line]


def run(program: Path, seconds: float = 10.0, world: str = BALL) -> list[str]:
    """Run a program until it ends and return the texts that it has logged."""
    with simkit.load(world) as sim:
        node = sim.add_node(program)
        assert sim.run_until(lambda _: node.done, seconds)
        assert node.error is None
        return texts(node)


def test_a_script_calls_the_service_of_a_program(write: Any) -> None:
    with simkit.load(BALL) as sim:
        sim.add_node(write("adder", ADDER))
        sim.run(0.1)
        assert sim.call("/add", {"a": 2, "b": 40}).sum == 42


def test_programs_use_the_services_of_the_simulation(write: Any) -> None:
    text = """
        import rclpy
        from gazebo_msgs.srv import GetModelList, SpawnEntity
        from geometry_msgs.msg import Pose
        from ros_gz_interfaces.msg import Entity
        from ros_gz_interfaces.srv import SetEntityPose
        from std_srvs.srv import Empty

        rclpy.init()
        node = rclpy.create_node("caller")


        def call(kind, service, **fields):
            client = node.create_client(kind, service)
            assert client.wait_for_service(timeout_sec=1.0), service
            future = client.call_async(kind.Request(**fields))
            rclpy.spin_until_future_complete(node, future)
            return future.result()


        pose = Pose()
        pose.position.x = 3.0
        entity = Entity(name="ball", type=Entity.MODEL)
        node.get_logger().info(str(call(SetEntityPose, "/world/yard/set_pose", entity=entity, pose=pose).success))
        xml = '<sdf version="1.9"><model name="cube"><link name="l"/></model></sdf>'
        node.get_logger().info(str(call(SpawnEntity, "/spawn_entity", name="cube", xml=xml).success))
        node.get_logger().info(str(sorted(call(GetModelList, "/get_model_list").model_names)))
        call(Empty, "/unpause_physics")
        rclpy.shutdown()
    """
    with simkit.load(BALL) as sim:
        node = sim.add_node(write("caller", dedent(text)))
        assert sim.run_until(lambda _: node.done, 10.0)
        assert node.error is None
        assert texts(node) == ["True", "True", "['ball', 'cube']"]
        assert sim.model("ball").pose.position[0] == pytest.approx(3.0)


def test_a_blocking_call_in_a_callback_of_the_same_thread_is_reported_as_a_deadlock(write: Any) -> None:
    blocking = ADDER.replace("rclpy.spin(Adder())", "node = Adder(); ask(node)").replace(
        "def main():",
        """def ask(node):
    client = node.create_client(AddTwoInts, "add_more")

    def call():
        node.get_logger().info("calls")
        client.call(AddTwoInts.Request(a=1))
        node.get_logger().info("never")

    node.create_timer(0.5, call)
    rclpy.spin(node)


def main():""",
    )
    with simkit.load(BALL) as sim:
        sim.offer("/add_more", "example_interfaces/srv/AddTwoInts", lambda request: {"sum": request.a + 1})
        node = sim.add_node(write("blocking", blocking))
        sim.run(5.0)
        assert texts(node) == ["calls"]
        sim.run(5.0)
        assert len(node.log) == 2, "the deadlock is reported once, and the call is never answered"
        assert "call() of '/add_more' waits for 5 s for a response that has arrived" in node.log[1]
        assert "deadlock" in node.log[1] and "MultiThreadedExecutor" in node.log[1]
        assert not node.done


def test_values_of_the_command_line_files_and_add_node_replace_those_of_a_program(tmp_path: Path, write: Any) -> None:
    program = write(
        "show",
        """
import rclpy

rclpy.init()
node = rclpy.create_node("show", namespace="robot")
for name, value in (("a", 0), ("b", 0.0), ("c.d", ""), ("e", [0]), ("f", "")):
    node.get_logger().info(f"{name} {node.declare_parameter(name, value).value!r}")
rclpy.shutdown()
""",
    )
    file = tmp_path / "params.yaml"
    file.write_text(
        "/**:\n  ros__parameters: {a: 1, b: 1.5, c: {d: wild}}\n"
        "other:\n  ros__parameters: {a: 9}\n"
        "/robot/show:\n  ros__parameters: {a: 2, e: [1, 2]}\n"
        "robot:\n  show:\n    ros__parameters: {f: 'nested'}\n"
    )
    with simkit.load(BALL) as sim:
        plain = sim.add_node(program)
        filed = sim.add_node(program, args=["--ros-args", "--params-file", str(file), "-p", "c.d:=line"])
        keyed = sim.add_node(
            program, args=["--ros-args", "--params-file", str(file)], params={"a": 7, "c": {"d": "key"}}
        )
        sim.run(0.1)
        assert texts(plain) == ["a 0", "b 0.0", "c.d ''", "e [0]", "f ''"]
        assert texts(filed) == ["a 2", "b 1.5", "c.d 'line'", "e [1, 2]", "f 'nested'"]
        assert texts(keyed) == ["a 7", "b 1.5", "c.d 'key'", "e [1, 2]", "f 'nested'"]


@pytest.mark.parametrize(
    ("words", "code", "reason"),
    [
        (["-p", "a:=[1, 2.5]"], "SK-NODE-030", "values of different types"),
        (["-p", "a:=[1"], "SK-NODE-030", "expected a value in YAML"),
        (["-p", "a"], "SK-NODE-030", "Couldn't parse parameter override rule: '-p a'"),
        (["-p", "a-b:=1"], "SK-NODE-030", "Couldn't parse parameter override rule: '-p a-b:=1'"),
        (["-p", "a:={x: 1}"], "SK-NODE-030", "found a mapping for parameter 'a'; expected a value or a list"),
        (["-r", "scan"], "SK-NODE-030", "Couldn't parse remap rule: '-r scan'"),
        (["--params-file", "/no/such/file.yaml"], "SK-NODE-031", "cannot be read"),
    ],
)
def test_a_wrong_argument_of_ros_is_an_error_of_the_user_before_the_start(
    write: Any, words: list[str], code: str, reason: str
) -> None:
    with simkit.load(BALL) as sim:
        with pytest.raises(InputError) as caught:
            sim.add_node(write("adder", ADDER), args=["--ros-args", *words])
        assert caught.value.code == code and reason in str(caught.value)
        assert not sim.nodes


@pytest.mark.parametrize(
    ("options", "code", "reason"),
    [
        ({"args": "--ros-args -p delay:=1.0"}, "SK-INPUT-002", "args must be a list of texts"),
        ({"remap": ["scan:=x"]}, "SK-INPUT-002", "remap must be a dict"),
        ({"remap": {"scan": "bad name"}}, "SK-NODE-030", "Couldn't parse remap rule: '-r scan:=bad name'"),
        ({"params": {1: 2}}, "SK-INPUT-002", "a key of params must be a text"),
        ({"name": "bad name"}, "SK-INPUT-003", "name must be valid (node name must not contain"),
        ({"namespace": "9x"}, "SK-INPUT-003", "namespace must be valid (namespace must not have a token"),
        ({"latency": "5ms"}, "SK-INPUT-002", "latency must be a finite number [s]"),
        ({"latency": (0.02, 0.005)}, "SK-INPUT-003", "latency must be a finite number [s] of at least 0.02"),
        ({"latency": (1.0,)}, "SK-INPUT-003", "latency must be a number of seconds, or two"),
        ({"discovery": -1.0}, "SK-INPUT-003", "discovery must be"),
        ({"limit": 0}, "SK-INPUT-003", "limit must be"),
        ({"restart": float("nan")}, "SK-INPUT-003", "restart must be"),
        ({"keys": 3}, "SK-INPUT-002", "keys must be a list of pairs"),
        ({"keys": [(1.0,)]}, "SK-INPUT-003", "keys[0] must be a pair"),
        ({"keys": [("w", 1.0)]}, "SK-INPUT-002", "the time of keys[0] must be"),
        ({"args": ["--ros-args", "--bogus"]}, "SK-NODE-030", "unknown arguments after --ros-args: ['--bogus']"),
    ],
)
def test_a_wrong_option_of_a_node_is_an_error_of_the_user_before_the_start(
    write: Any, options: dict[str, Any], code: str, reason: str
) -> None:
    with simkit.load(BALL) as sim:
        with pytest.raises(InputError) as caught:
            sim.add_node(write("adder", ADDER), **options)
        assert caught.value.code == code and reason in str(caught.value)
        assert not sim.nodes


def test_a_program_that_is_no_path_is_an_error_of_the_user() -> None:
    with simkit.load(BALL) as sim, pytest.raises(InputError, match="program must be a path"):
        sim.add_node(3)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("adder: {delay: 3}", ":1 has a value outside of a block ros__parameters"),
        ("/**:\n  ros_parameters:\n    delay: 3", ":3 has a value outside of a block ros__parameters"),
        ("adder:\n  ros__parameters: 3", ":2 has a value outside of a block ros__parameters"),
        ("- adder", ":1 has a value outside of a block ros__parameters"),
        ("other:\n  ros__parameters:\n    delay:", ":3 has no value for the parameter 'delay'"),
        ("adder: [1, 2", "is not valid YAML: expected ',' or ']', but got '<stream end>'"),
    ],
)
def test_a_file_of_parameters_that_ros_refuses_is_refused_with_its_line(
    write: Any, tmp_path: Path, text: str, reason: str
) -> None:
    file = tmp_path / "params.yaml"
    file.write_text(text)
    with simkit.load(BALL) as sim, pytest.raises(InputError, match="SK-NODE-031") as caught:
        sim.add_node(write("adder", ADDER), args=["--ros-args", "--params-file", str(file)])
    assert reason in str(caught.value)


@pytest.mark.parametrize("text", ["", "adder:\n  ros__parameters: {}\n", "word"])
def test_a_file_of_parameters_may_have_none(write: Any, tmp_path: Path, text: str) -> None:
    file = tmp_path / "params.yaml"
    file.write_text(text)
    with simkit.load(BALL) as sim:
        assert sim.add_node(write("adder", ADDER), args=["--ros-args", "--params-file", str(file)]).error is None


def test_tools_see_and_set_the_parameters_of_a_program(write: Any) -> None:
    results: list[Any] = []

    def ask(path: Path) -> None:
        with Client(path, node="tool") as client:
            results.append(list(client.call("/adder/list_parameters").result.names))
            value = {"type": 3, "double_value": 0.5}
            request = {"parameters": [{"name": "delay", "value": value}]}
            results.append(client.call("/adder/set_parameters", request).results[0].successful)
            results.append(client.call("/add", {"a": 1, "b": 2}).sum)
            results.append(sorted(client.ask("nodes")["/adder"]["services"])[:1])

    with simkit.load(BALL) as sim, Server(sim) as server:
        sim.add_node(write("adder", ADDER))
        sim.run(0.1)
        thread = threading.Thread(target=ask, args=(server.path,))
        thread.start()
        while thread.is_alive():
            server.poll(wait=0.01)
            sim.run(0.1)
    assert results[0][-2:] == ["delay", "gains.p"]
    assert results[1:] == [True, 3, ["/add"]], "the last response takes half a second of simulated time"


def test_a_reset_starts_the_services_anew(write: Any) -> None:
    with simkit.load(BALL) as sim:
        sim.add_node(write("adder", ADDER))
        sim.run(0.1)
        for _ in range(2):
            assert sim.call("/add", {"a": 2, "b": 40}).sum == 42
            sim.reset()
            sim.run(0.1)


LOUDER = """
import rclpy

rclpy.init()
node = rclpy.create_node("speaker", enable_logger_service=True)
node.create_timer(0.1, lambda: node.get_logger().debug("details"))
rclpy.spin(node)
"""


def test_the_levels_of_loggers_are_read_and_set_from_outside(write: Callable[[str, str], Path]) -> None:
    with simkit.load(BALL) as sim:
        node = sim.add_node(write("speaker", LOUDER))
        sim.run(0.25)
        assert node.log == []
        levels = [{"name": "speaker", "level": 10}, {"name": "speaker", "level": 11}]
        results = sim.call("/speaker/set_logger_levels", {"levels": levels}).results
        assert [bool(result.successful) for result in results] == [True, False]
        assert sim.call("/speaker/get_logger_levels", {"names": ["speaker"]}).levels[0].level == 10
        sim.run(0.2)
        assert len(node.log) == 2 and node.log[0].endswith("[speaker]: details")
