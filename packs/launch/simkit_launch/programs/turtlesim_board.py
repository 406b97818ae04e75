"""turtlesim's node: it adds a square with turtles to the world, beside those of other such nodes."""

from __future__ import annotations

import sys

from rclpy.logging import get_logger

from simkit import Pose
from simkit_launch.plugin_arguments import ros_element
from simkit_launch.program_simulation import current_simulation, ros1_parameter
from simkit_nodes.host import current_host, current_program

WIDTH = 11.088889
"""Side of the square [m]."""

DISTANCE = 12.0
"""Distance between the corners of two squares [m]."""

SQUARE = """<sdf version="1.12"><model name="{name}"><static>true</static><link name="link">
<visual name="visual"><pose>{half} {half} -0.01 0 0 0</pose>
<geometry><box><size>{width} {width} 0.02</size></box></geometry>
<material><ambient>0.27 0.337 1 1</ambient><diffuse>0.27 0.337 1 1</diffuse></material></visual></link>
<plugin filename="libsimkit_turtlesim.so" name="{node}">{ros}</plugin></model></sdf>"""


def main() -> int:
    """Add the square and wait for the end of the run."""
    program, simulation = current_program(), current_simulation()
    names = program.ros_arguments
    node = program.options.name or names.node_name("turtlesim")
    namespace = "/" + (program.options.namespace or names.namespace("turtlesim", "/")).strip("/")
    full = f"{namespace.rstrip('/')}/{node}"
    name = "turtlesim" if full == "/turtlesim" else full.strip("/").replace("/", "_")
    log = get_logger(node)
    log.info(f"Starting turtlesim with node name {full}")
    for channel in ("background_r", "background_g", "background_b"):
        value = ros1_parameter(full, channel)
        if value is not None:
            program.options.params.setdefault(channel, value)
    ros = ros_element(program, namespace, frozenset(("use_sim_time",)))
    shared = current_host().graph.shared
    boards = shared.setdefault("turtlesim boards", {})
    number = boards.setdefault(name, len(boards))
    if name in simulation.models:
        simulation.remove(name)
    text = SQUARE.format(name=name, node=node, ros=ros, half=WIDTH / 2, width=WIDTH)
    simulation.spawn(text, name, Pose((0.0, -DISTANCE * number, 0.0)))
    log.info("Spawning turtle [turtle1] at x=[5.544445], y=[5.544445], theta=[0.000000]")
    current_host().wait()
    return 0


if __name__ == "__main__":
    sys.exit(main())
