"""Node in place of a server of Nav2 that simkit does not have: it has the states of a lifecycle node."""

import re
import sys

import rclpy
from node_support import run, warn
from rclpy.lifecycle import LifecycleNode

MISSING = {
    "docking_server": "robots do not dock: there is no action dock_robot",
    "opennav_docking": "robots do not dock: there is no action dock_robot",
    "opennav_following": "robots do not follow objects: there is no action follow_object",
    "following_server": "robots do not follow objects: there is no action follow_object",
    "route_server": "there are no routes on a graph: there is no action compute_route",
}
"""Sentences about the missing work, by the name of the executable."""


def main():
    """Run the node."""
    rclpy.init(args=sys.argv)
    name = sys.argv[0].rpartition("/")[2].rpartition("::")[2]
    executable = re.sub(r"(?<=[a-z])(?=[A-Z])", "_", name).lower()
    node = LifecycleNode(executable, automatically_declare_parameters_from_overrides=True)
    warn(node, "SK-NAV-004", MISSING.get(executable, "the node does nothing"))
    run(node)


if __name__ == "__main__":
    main()
