"""Node `move_group` of MoveIt, of ROS 2 and of ROS 1: a plugin of simkit answers its services and actions.

The plugin is a part of a static model without a shape. It is added as soon as the robot is in the world.
"""

import contextlib
import sys

import rclpy
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String

from simkit.errors import SimkitError
from simkit.extend import Where
from simkit_motion.move_group_parameters import (
    find_robot,
    plugin_elements,
    plugin_model,
    sentences_of_differences,
    unused_names,
)
from simkit_motion.plugins.move_group.error_codes import PlanningFailed, check_packages
from simkit_nodes.host import current_host, current_program
from simkit_nodes.parameter_overrides import flat_values, parameter_overrides
from simkit_nodes.robot_groups import DescriptionError, read_robot_groups
from simkit_nodes.ros1_parameters import parameter_server

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
PERIOD = 0.1  # [s] between two looks at the models of the world
PATIENCE = 100  # looks without the robot before a warning
TRANSFORMS = ("/tf", "/tf_static")
SEMANTIC = "robot_description_semantic"


class MoveGroupNode(Node):
    """Node that adds the plugin for a robot."""

    def __init__(self):
        super().__init__("move_group", allow_undeclared_parameters=True)
        self._values, self._is_ros1 = self._given_parameters()
        self._looks, self._groups, self._model = 0, None, ""
        self._description = str(self._values.get("robot_description", ""))
        self._semantic_topic = self.create_publisher(String, SEMANTIC, LATCHED)
        if not self._values.get(SEMANTIC):
            self.create_subscription(String, SEMANTIC, self._take_semantic, LATCHED)
        if not self._description:
            self.create_subscription(String, "robot_description", self._take_description, LATCHED)
        self._begin()
        self._timer = self.create_timer(PERIOD, self._look)

    def _given_parameters(self):
        """Return the parameters, and whether they are those of the parameter server of ROS 1."""
        program, name = current_program(), self.get_fully_qualified_name()
        values = parameter_overrides(name, self.context.arguments, program.options.params)
        server = parameter_server(current_host())
        found = server.search(name, SEMANTIC)
        if SEMANTIC in values or found is None or not server.has(found):
            return values, False
        parent = found.rpartition("/")[0]
        names = ("robot_description", SEMANTIC, "robot_description_planning")
        ros1 = {each: server.get(f"{parent}/{each}") for each in names if server.has(f"{parent}/{each}")}
        own = server.get(name) if server.has(name) else {}
        return {**dict(flat_values(ros1)), **dict(flat_values(own)), **values}, True

    def _take_semantic(self, message):
        if not self._values.get(SEMANTIC):
            self._values[SEMANTIC] = message.data
            self._begin()

    def _take_description(self, message):
        if not self._description:
            self._description = message.data
            self._begin()

    def _begin(self):
        """Read the descriptions once both are there."""
        semantic = str(self._values.get(SEMANTIC, ""))
        if self._groups is not None or not semantic or not self._description:
            return
        try:
            self._groups = read_robot_groups(self._description, semantic)
        except DescriptionError as error:
            self.get_logger().error(str(error))
            sys.exit(1)
        self._semantic_topic.publish(String(data=semantic))
        self.get_logger().info(f"Loading robot model '{self._groups.tree.name}'...")

    # ------------------------------------------------------------------ plugin

    def _look(self):
        """Add the plugin if the robot is in the world."""
        simulation = current_host().simulation
        robot = None if self._groups is None else find_robot(simulation, self._groups, self.get_namespace())
        if robot is not None:
            self._timer.cancel()
            self._add_plugin(simulation, robot)
            return
        self._looks += 1
        if self._looks == PATIENCE:
            missing = "no robot_description and robot_description_semantic came"
            if self._groups is not None:
                names = sorted({joint for group in self._groups.groups.values() for joint in group.active})
                missing = f"no model of the world has the joints of the groups: {', '.join(names)}"
            self._warn("SK-PLAN-004", f"{missing}; nothing is planned until then")

    def _add_plugin(self, simulation, robot):
        name, space = self.get_fully_qualified_name(), self.get_namespace().rstrip("/")
        self._model = name.strip("/").replace("/", "_")
        rules = []
        for rule in self.context.arguments.rules:
            is_name = rule.kind in ("any", "topic", "service") and rule.node in ("", self.get_name())
            if is_name and rule.old not in TRANSFORMS:
                rules.append((rule.old, rule.new))
        if self._is_ros1:
            rules.append(("move_action", "move_group"))
        elements = plugin_elements(self._groups, self._values, robot)
        try:
            simulation.spawn(plugin_model(self._model, elements, space, rules))
        except SimkitError as error:
            for line in str(error).splitlines():
                self.get_logger().error(line)
            sys.exit(1)
        for sentence in sentences_of_differences(self._groups, self._values):
            self._warn("SK-PLAN-002", sentence)
        unused = unused_names(self._groups, self._values)
        if unused:
            self._warn("SK-PLAN-003", f"no effect here: {', '.join(unused)}")
        try:
            check_packages()
        except PlanningFailed as error:
            self._warn("SK-PLAN-005", f"each request gets an error, because {error}")
        self.get_logger().info("You can start planning now!")

    def _warn(self, code, text):
        reports = current_host().simulation.engine.reports
        reports.warning(code, f"{self.get_fully_qualified_name()}: {text}", Where(sys.argv[0]))


def main():
    """Run the node."""
    rclpy.init()
    if current_host().simulation is None:
        sys.exit(f"{sys.argv[0]} runs only in the process of a simulation: start it with simkit launch or simkit run")
    node = MoveGroupNode()
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    with contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        executor.spin()
    rclpy.try_shutdown()


if __name__ == "__main__":
    main()
