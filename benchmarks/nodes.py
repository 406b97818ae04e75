"""Cost of nodes in lock-step: nodes on a lidar beside the same run without them, hand-overs, busy loops, the start.

python benchmarks/nodes.py [--world NAME] [--rounds N]

Each case has its own simulation in this process. Each simulates a part of 0.1 s in turn, in which the lidar measures
once; the times are CPU times of the process. Of each case, the lower quarter of the times is used: other programs on
the computer hardly count then. In all cases the robot drives in a circle, and a script subscribes to the scans.

A hand-over is a wait of a program for the next step. Its cost contains the change of the process between the values of
the simulation and those of the program; the cost of the same steps, one by one and without programs, is subtracted.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import statistics
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import simkit

PART = 0.1  # [s]
LIDAR_RATE = 10.0  # [Hz]
HEADER = """
import time
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import LaserScan

rclpy.init()
"""
FOLLOWER = """
class Follower(Node):
    def __init__(self):
        super().__init__("follower")
        self.publisher = self.create_publisher(Twist, "command", 10)
        self.create_subscription(LaserScan, "scan", self.on_scan, qos_profile_sensor_data)

    def on_scan(self, scan):
        command = Twist()
        if min(scan.ranges[:20] + scan.ranges[-20:]) > 0.6:
            command.linear.x = 0.2
        else:
            command.angular.z = 0.8
        self.publisher.publish(command)


rclpy.spin(Follower())
"""
NODE = """
node = rclpy.create_node("busy")
publisher = node.create_publisher(Twist, "command", 10)
node.create_subscription(LaserScan, "scan", lambda scan: None, 10)
"""
LOOPS = {
    "while rclpy.ok(): publish": "while rclpy.ok():\n    publisher.publish(Twist())\n",
    "while time.time() < t: pass": "while time.time() < 1e9: pass\n",
    "while ok: spin_once(timeout_sec=0)": "while rclpy.ok(): rclpy.spin_once(node, timeout_sec=0)\n",
}
WAITS = "while True: time.sleep(1e-9)\n"  # until the next step


class Case:
    """Simulation that is measured in parts.

    Args:
        world: world.
        program: text of the program; empty for none.
        number: number of nodes with this program.
        is_stepped: True if the script makes each step with a call.

    Attributes:
        times: CPU times of the parts [s].
        hand_overs: hand-overs per part.
    """

    def __init__(self, world: str, program: str = "", number: int = 1, *, is_stepped: bool = False) -> None:
        overrides = {"**::base_scan::*.update_rate": LIDAR_RATE}
        self.sim = simkit.load(world, overrides=overrides if world == "turtlebot3_world" else {})
        self.sim.subscribe("/scan", lambda scan: None)
        self.sim.advertise("/cmd_vel", "geometry_msgs/msg/Twist").publish({"linear": {"x": 0.1}, "angular": {"z": 0.3}})
        self._folder = tempfile.TemporaryDirectory()
        file = Path(self._folder.name, "program.py")
        file.write_text(program)
        self._nodes = [self.sim.add_node(file, name=f"n{k}") for k in range(number)] if program else []
        self._run: Callable[[], Any] = self._step if is_stepped else lambda: self.sim.run(PART)
        self._run()
        self.times: list[float] = []
        self.hand_overs = 0

    def _step(self) -> None:
        for _ in range(round(PART / self.sim.timestep)):
            self.sim.step()

    def measure(self) -> None:
        """Simulate a part."""
        before = sum(node.hand_overs for node in self._nodes)
        begun = time.process_time()
        self._run()
        self.times.append(time.process_time() - begun)
        self.hand_overs = sum(node.hand_overs for node in self._nodes) - before

    @property
    def time(self) -> float:
        """CPU time of a part [s]."""
        return statistics.median(sorted(self.times)[: max(1, len(self.times) // 4)])

    def close(self) -> None:
        """End the simulation."""
        self.sim.close()
        self._folder.cleanup()


def measured(cases: dict[str, Case], rounds: int) -> dict[str, Case]:
    """Measure the cases in turn, and close them."""
    for _ in range(rounds):
        for case in cases.values():
            case.measure()
    for case in cases.values():
        case.close()
    return cases


def report_start(world: str) -> None:
    """Print the CPU times of the first node and of a second one, up to the end of their first step."""
    with simkit.load(world) as sim, tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "program.py")
        file.write_text(HEADER + FOLLOWER)
        sim.step()
        for name in ("first", "second"):
            begun = time.process_time()
            sim.add_node(file, name=name)
            sim.step()
            print(f"{f'start of the {name} node':44} {(time.process_time() - begun) * 1e3:8.1f} ms")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--world", default="turtlebot3_world")
    parser.add_argument("--rounds", type=int, default=60)
    args = parser.parse_args()
    report_start(args.world)
    nodes = {number: Case(args.world, HEADER + FOLLOWER if number else "", number) for number in (0, 1, 20)}
    nodes = measured(nodes, args.rounds)
    print(f"{'no node':44} {PART / nodes[0].time:8.1f} × real time")
    for number, aim in ((1, "ratio >= 0.80"), (20, ">= 5 × real time")):
        ratio = nodes[0].time / nodes[number].time
        name = f"nodes on a lidar of {LIDAR_RATE:g} Hz: {number}"
        print(f"{name:44} {PART / nodes[number].time:8.1f} × real time, ratio {ratio:5.2f}   aim {aim}")
    loops = {name: Case(args.world, HEADER + NODE + text) for name, text in LOOPS.items()}
    for name, case in measured(loops, args.rounds // 4).items():
        print(f"{name:44} {PART / case.time:8.1f} × real time   aim >= 10")
    waits = {number: Case("empty", "import time\n" + WAITS, number) for number in (1, 20)}
    alone = Case("empty", is_stepped=True)
    measured({"alone": alone, **{str(number): case for number, case in waits.items()}}, args.rounds // 2)
    for number, case in waits.items():
        cost = (case.time - alone.time) / case.hand_overs
        print(f"{f'hand-over, {number} waiting programs':44} {cost * 1e6:8.1f} µs   aim <= 15")


if __name__ == "__main__":
    with open(os.devnull, "w") as nothing, contextlib.redirect_stderr(nothing):
        main()
