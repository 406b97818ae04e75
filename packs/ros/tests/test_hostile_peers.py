"""Nodes that die, flood, send bytes that are no message, or use other types: the run goes on and obeys good nodes."""

from __future__ import annotations

import os
import subprocess
import textwrap
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from .conftest import FOLDER, TIMEOUT, ros_environment

pytestmark = [pytest.mark.ros, pytest.mark.fuzz]
SimkitRun = Callable[..., Any]
RosNode = Callable[[str], Any]
SECONDS = min(float(os.environ.get("SIMKIT_FUZZ_SECONDS", "60")) / 10, 20.0)
GROWTH = 100  # [MiB] that an attack may add to the run and to its bridge

HEAD = """
import os, random, time
chance, end = random.Random(0), time.monotonic() + {seconds}
from geometry_msgs.msg import Twist
from std_msgs.msg import String
client = Client("attacker")
node = client.node
turn = lambda: rclpy.spin_once(node, timeout_sec=0.0)
"""
BYTES = """
from geometry_msgs.msg import PoseStamped
from sensor_msgs.msg import JointState
publisher = node.create_publisher(Twist, "/cmd_vel", 10)
client.until(lambda: publisher.get_subscription_count())
count = 0
while time.monotonic() < end:
    body = chance.randbytes(chance.choice((0, 1, 3, 4, 5, 20, 51, 52, 53, 1000, 60000)))
    head = chance.choice((b"", b"\\0\\1\\0\\0", b"\\0\\0\\0\\0", b"\\0\\3\\0\\0", b"\\xff\\xff\\xff\\xff"))
    try:
        publisher.publish(head + body)
        count += 1
    except Exception:
        pass  # larger than a message of this type may be: ROS itself refuses it
    turn()
tell(count)
"""
FLOOD = """
from contextlib import suppress
from rclpy._rclpy_pybind11 import RCLError
from std_srvs.srv import Empty
publisher = node.create_publisher(Twist, "/cmd_vel", 1000)
clients = [node.create_client(Empty, name) for name in ("/pause_physics", "/unpause_physics")]
client.until(lambda: publisher.get_subscription_count() and all(c.service_is_ready() for c in clients))
message, count = Twist(), 0
message.linear.x = 1e300
while time.monotonic() < end:
    for _ in range(100):
        with suppress(RCLError):  # a reliable publisher refuses a message if the reader is behind for 100 ms
            publisher.publish(message)
    for one in clients:
        one.call_async(Empty.Request())
    count += 102
client.call(Empty, "/unpause_physics")
tell(count)
"""
OTHER_TYPES = """
from sensor_msgs.msg import Image
from std_srvs.srv import SetBool
count = 0
while time.monotonic() < end:
    made = [node.create_publisher(chance.choice((String, Image)), "/cmd_vel", 10)]
    heard = [node.create_subscription(String, name, lambda _: None, 10) for name in ("/scan", "/odom", "/tf")]
    asked = node.create_client(SetBool, "/pause_physics")
    offered = [node.create_service(SetBool, f"/own{count}", lambda _, answer: answer)]
    for one in made:
        one.publish(String(data="x" * 1000) if one.msg_type is String else Image())
    for _ in range(20):
        turn()
    for one in (*made, *heard):
        (node.destroy_publisher if one in made else node.destroy_subscription)(one)
    node.destroy_client(asked), node.destroy_service(offered[0])
    count += 1
tell(count)
"""
REQUESTS = """
from simkit_ros.opaque_types import service_class
kinds = {"/get_model_list": "gazebo_msgs/srv/GetModelList", "/spawn_entity": "gazebo_msgs/srv/SpawnEntity"}
clients = [(node.create_client(service_class(kind), name), service_class(kind)) for name, kind in kinds.items()]
client.until(lambda: any(one.service_is_ready() for one, _ in clients))
count = 0
while time.monotonic() < end:
    for one, kind in clients:
        if one.service_is_ready():
            head = chance.choice((b"", b"\\0\\1\\0\\0"))
            future = one.call_async(kind.Request(head + chance.randbytes(chance.randrange(60))))
            stop = time.monotonic() + 5
            while not future.done() and time.monotonic() < stop:
                rclpy.spin_once(node, timeout_sec=0.05)
            count += 1
tell(count)
"""
DEATH = """
from sensor_msgs.msg import LaserScan
from std_srvs.srv import Empty
client.call(Empty, "/unpause_physics")  # the node before may have died between its two calls
publisher = node.create_publisher(Twist, "/cmd_vel", 10)
scans = client.hear("/scan", LaserScan, rclpy.qos.qos_profile_sensor_data)
asked = node.create_client(Empty, "/pause_physics")
client.until(lambda: scans and asked.service_is_ready())
asked.call_async(Empty.Request())
node.create_client(Empty, "/unpause_physics").call_async(Empty.Request())
publisher.publish(Twist())
tell(1)
os.kill(os.getpid(), 9)
"""
DRIVE = """
from nav_msgs.msg import Odometry
from std_srvs.srv import Empty
client.call(Empty, "/unpause_physics")
odometry, publisher, command = client.hear("/odom", Odometry), node.create_publisher(Twist, "/cmd_vel", 10), Twist()
client.until(lambda: odometry)
start, command.linear.x = odometry[-1].pose.pose.position, 0.1
moved = lambda: abs(odometry[-1].pose.pose.position.x - start.x) + abs(odometry[-1].pose.pose.position.y - start.y)
client.publish_until(publisher, command, lambda: moved() > 0.02)
tell(moved())
"""


def memory(number: int) -> int:
    """Return the memory of a process in MiB."""
    return int(Path(f"/proc/{number}/status").read_text().partition("VmRSS:")[2].split()[0]) >> 10


def handles(number: int) -> int:
    return len(list(Path(f"/proc/{number}/fd").iterdir()))


@contextmanager
def attacked(simkit_run: SimkitRun, ros_node: RosNode) -> Iterator[Any]:
    """Yield a run that is attacked; afterwards it is small, has the same bridge, and obeys."""
    with simkit_run("turtlebot3_empty", "--rtf", "1") as run:
        assert ros_node(HEAD.format(seconds=0) + DRIVE) > 0.02
        processes = (run.process.pid, run.bridge())
        before = [(memory(number), handles(number)) for number in processes]
        yield run
        assert run.process.poll() is None, run.text[-3000:]
        assert run.bridge() == processes[1], run.text[-3000:]
        assert "Traceback" not in run.text, run.text[-3000:]
        assert len(run.text) < 50_000, run.text[:2000]
        assert ros_node(HEAD.format(seconds=0) + DRIVE) > 0.02
        after = [(memory(number), handles(number)) for number in processes]
        print(f"\nmemory [MiB] and file handles: {before} -> {after}")  # noqa: T201 -- read with -s
        for (size, files), (size_after, files_after) in zip(before, after, strict=True):
            assert size_after < size + GROWTH
            assert files_after < files + 30


@pytest.mark.parametrize("attack", [BYTES, FLOOD, OTHER_TYPES, REQUESTS], ids=["bytes", "flood", "types", "requests"])
def test_a_run_outlives_a_hostile_node(attack: str, simkit_run: SimkitRun, ros_node: RosNode) -> None:
    with attacked(simkit_run, ros_node):
        count = ros_node(HEAD.format(seconds=SECONDS) + attack)
        print(f"\n{count} in {SECONDS:.0f} s")  # noqa: T201 -- read with -s
        assert count > 0


def test_a_run_outlives_nodes_that_are_killed(simkit_run: SimkitRun, ros_node: RosNode, ros_python: Path) -> None:
    code = textwrap.dedent(HEAD.format(seconds=SECONDS) + DEATH)
    command = [str(ros_python), str(FOLDER / "ros_client.py"), code]
    with attacked(simkit_run, ros_node):
        end, killed, has_missed = time.monotonic() + SECONDS, 0, False
        while killed < 2 or time.monotonic() < end:
            found = subprocess.run(command, capture_output=True, text=True, env=ros_environment(), timeout=TIMEOUT)
            if found.returncode != -9:
                # Fast DDS 3.2 tells a node that starts when the lease of a killed one ends, 20 s after its death, only
                # a part of the endpoints. The next node gets all.
                assert not has_missed and "TimeoutError" in found.stderr, found.stderr
                has_missed = True
                continue
            killed, has_missed = killed + 1, False
        print(f"\n{killed} nodes killed")  # noqa: T201 -- read with -s
