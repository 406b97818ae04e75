"""Node of ROS 1 whose work plugins of simkit do: amcl, move_base, fake_localization, a filter of robot_localization.

The plugins are parts of a static model without a shape.
"""

import sys

import rospy
from actionlib import SimpleActionServer
from geometry_msgs.msg import PoseStamped
from move_base_msgs.msg import MoveBaseAction, MoveBaseActionGoal, MoveBaseFeedback, MoveBaseGoal, MoveBaseResult

from simkit.errors import SimkitError
from simkit.extend import Where
from simkit.msgs.goal_status import GoalStatus
from simkit_navigation.move_base_parameters import ROS1_NODES
from simkit_navigation.nav2_parameters import ModelOfPlugins
from simkit_navigation.plugins.navigation.node_values import shortened
from simkit_nodes.host import current_host

PERIOD = 0.05  # [s] between two looks at a goal
GLOBAL_TOPICS = ("cmd_vel", "odom", "map", "scan")
"""Topics of `move_base` that are not below its name."""


def add_plugins(executable):
    """Add the plugins of the node to the world; end the program if their parameters have errors."""
    simulation, name = current_host().simulation, rospy.get_name()
    if simulation is None:
        sys.exit(f"{sys.argv[0]} runs only in the process of a simulation: start it with simkit launch or simkit run")
    plugins = ROS1_NODES[executable](rospy.get_param("~", {}))
    is_alone = len(plugins) == 1
    space = rospy.get_namespace().rstrip("/") if is_alone else name  # as in /move_base/global_costmap
    if is_alone:
        plugins[0].name = name.rpartition("/")[2]
        rules = remappings()
    else:
        rules = [(f"{space}/{topic}", rospy.resolve_name(topic)) for topic in GLOBAL_TOPICS]
    ros = f"<namespace>{space}</namespace>" if space else ""
    ros += "".join(f"<remapping>{old}:={new}</remapping>" for old, new in rules)
    model = ModelOfPlugins(name.strip("/").replace("/", "_"), ros)
    for plugin in plugins:
        model.add(plugin, {})
    try:
        simulation.spawn(model.text)
    except SimkitError as error:
        sys.exit(str(error))
    reports, where = simulation.engine.reports, Where(sys.argv[0])
    for sentence in (sentence for plugin in plugins for sentence in plugin.parameters.told):
        reports.warning("SK-NAV-001", f"{name}: {sentence}", where)
    if model.unused:
        reports.warning("SK-NAV-002", f"{name}: no effect here: {shortened(model.unused)}", where)
    return simulation


def remappings():
    """Return the old and the new names of topics in the arguments."""
    return [(old, new) for old, new in sorted(rospy.names.get_mappings().items()) if not old.startswith("_")]


class MoveBase:
    """Action `move_base` and topic `move_base_simple/goal` of ROS 1 in front of the navigator.

    Args:
        simulation: simulation with the plugins.
    """

    def __init__(self, simulation):
        self._simulation = simulation
        self._server = SimpleActionServer(rospy.get_name(), MoveBaseAction, self._execute, auto_start=False)
        self._server.start()
        self._goals = rospy.Publisher(f"{rospy.get_name()}/goal", MoveBaseActionGoal, queue_size=1)
        rospy.Subscriber("move_base_simple/goal", PoseStamped, self._on_simple_goal)

    def _on_simple_goal(self, pose):
        goal = MoveBaseActionGoal(goal=MoveBaseGoal(target_pose=pose))
        goal.header.stamp = rospy.Time.now()
        self._goals.publish(goal)

    def _execute(self, goal):
        pose = goal.target_pose
        at, turn = pose.pose.position, pose.pose.orientation
        fields = {
            "position": {"x": at.x, "y": at.y, "z": at.z},
            "orientation": {"x": turn.x, "y": turn.y, "z": turn.z, "w": turn.w},
        }
        stamped = {"header": {"frame_id": pose.header.frame_id.lstrip("/")}, "pose": fields}
        task = self._simulation.send_goal(f"{rospy.get_name()}/navigate_to_pose", {"pose": stamped})
        while not task.is_done:
            if self._server.is_preempt_requested() or rospy.is_shutdown():
                task.cancel()
                self._server.set_preempted()
                return
            if task.feedback is not None:
                self._server.publish_feedback(_feedback(task.feedback.current_pose))
            rospy.sleep(PERIOD)
        if task.status is GoalStatus.SUCCEEDED:
            self._server.set_succeeded(MoveBaseResult(), "Goal reached.")
        else:
            self._server.set_aborted(MoveBaseResult(), task.reason)


def _feedback(current):
    """Return the feedback of a pose of simkit."""
    feedback = MoveBaseFeedback()
    feedback.base_position.header.frame_id = current.header.frame_id
    feedback.base_position.header.stamp = rospy.Time.now()
    for name in ("x", "y", "z"):
        setattr(feedback.base_position.pose.position, name, getattr(current.pose.position, name))
    for name in ("x", "y", "z", "w"):
        setattr(feedback.base_position.pose.orientation, name, getattr(current.pose.orientation, name))
    return feedback


def main():
    """Run the node."""
    executable = sys.argv[0].rpartition("/")[2]
    rospy.init_node(executable)
    simulation = add_plugins(executable)
    server = MoveBase(simulation) if executable == "move_base" else None
    rospy.spin()
    del server


if __name__ == "__main__":
    main()
