"""`ros_gz_sim remove`: removes a model, and ends."""

from __future__ import annotations

import sys

import rclpy
from rclpy.utilities import remove_ros_args

from simkit.errors import SimkitError
from simkit_launch.model_spawning import FlagError, parse_flags
from simkit_launch.program_simulation import current_simulation

_FLAGS = {"world": "", "entity_name": "", "name": ""}


def main() -> int:
    """Remove the model; return the exit code."""
    rclpy.init(args=sys.argv)
    node = rclpy.create_node("ros_gz_sim")
    log, sim = node.get_logger(), current_simulation()
    try:
        values = parse_flags(remove_ros_args(sys.argv)[1:], _FLAGS)
    except FlagError as error:
        sys.stderr.write(f"ERROR: {error}\n")
        return 1
    name = str(node.declare_parameter("entity_name", "").value or values["entity_name"] or values["name"])
    if not name:
        log.error("Entity to remove name is not provided, entity will not be removed.")
        return 1
    try:
        sim.remove(name)
    except (KeyError, SimkitError) as error:
        log.error(f"Entity [{name}] cannot be removed: {error}")
        return 1
    log.info("Entity removal successful.")
    return 0


if __name__ == "__main__":
    sys.exit(main())
