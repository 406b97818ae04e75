"""Plugins that take something somewhere: followers, elevators, vacuum grippers."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import INERTIAL, model, python, world

_BASE = f'<link name="base">{INERTIAL}</link>\n'


def _gz(system: str, kind: str, parameters: str) -> str:
    return f'<plugin filename="gz-sim-{system}-system" name="gz::sim::systems::{kind}">\n  {parameters}\n</plugin>'


def _follower(parameters: str) -> str:
    return _gz("trajectory-follower", "TrajectoryFollower", f"<link_name>base</link_name>{parameters}")


def _after(target: str, parameters: str = "") -> str:
    return _gz("follow-actor", "FollowActor", f"<target>{target}</target>{parameters}")


_SLIDES = "".join(
    f'<link name="{child}">{INERTIAL}</link>\n<joint name="{name}" type="prismatic"><parent>base</parent>'
    f"<child>{child}</child><axis><xyz>0 0 1</xyz></axis></joint>\n"
    for name, child in (("lift", "cabin"), ("door_0", "leaf"))
)
_BOX = '<model name="box"><static>true</static><pose>3 0 0 0 0 0</pose><link name="base"/></model>'
_CLASSIC = (
    '<plugin name="elevator" filename="libElevatorPlugin.so">\n'
    "  <lift_joint>lift</lift_joint><door_joint>door_0</door_joint>\n</plugin>"
)
_TO_A_POSE = f"""
import simkit

with open("robot.sdf", "w") as file:
    file.write('''<sdf version="1.9"><model name="robot">
{_BASE}{_gz("drive-to-pose-controller", "DriveToPoseController", "")}
</model></sdf>''')
sim = simkit.load("robot.sdf")
sim.publish("/model/robot/cmd_pose", simkit.msgs.make("geometry_msgs/msg/Pose", position={{"x": 1.0}}))
sim.run(0.1)
"""

CODES: tuple[Code, ...] = (
    Code(
        "SK-PLUGIN-130",
        "warning",
        "a trajectory follower has no waypoints, and pushes nothing; or it has them in two ways, of which one counts",
        "one of `<waypoints>`, `<circle>` and `<line>`",
        model(_BASE + _follower("<force>10</force>")),
    ),
    Code(
        "SK-PLUGIN-131",
        "warning",
        "a trajectory follower is to stop the turning of a link that joints or the world hold: it does not",
        "name the link that carries the model",
        world(
            f'<model name="boat">\n{_BASE}<joint name="anchor" type="ball"><parent>world</parent><child>base</child>'
            "</joint>\n"
            + _follower(
                "<zero_vel_on_bearing_reached>true</zero_vel_on_bearing_reached><waypoints><waypoint>2 0</waypoint>"
                "</waypoints>"
            )
            + "\n</model>"
        ),
    ),
    Code(
        "SK-PLUGIN-132",
        "warning",
        "a plugin that works through others' topics finds nobody there: who tells where the robot is, takes its speeds "
        "or moves its joints",
        "the plugin that is missing is named",
        python(_TO_A_POSE),
    ),
    Code(
        "SK-PLUGIN-133",
        "error",
        "a door of an elevator whose joint has no upper limit, at which it is open",
        "give its axis `<limit><upper>`",
        model(_BASE + '<link name="floor_0"/>\n' + _SLIDES + _gz("elevator", "Elevator", "")),
    ),
    Code(
        "SK-PLUGIN-134",
        "error",
        "a plugin for actors in a model",
        "put it into an `<actor>`",
        model(_BASE + _after("box")),
    ),
    Code(
        "SK-PLUGIN-135",
        "warning",
        "bounds between which there is nothing: of an actor's distance or of an elevator's floors",
        "the lower one first",
        world(f'{_BOX}\n<actor name="anna">{_after("box", "<max_distance>1</max_distance>")}</actor>'),
    ),
    Code(
        "SK-PLUGIN-136",
        "warning",
        "an actor is to walk after something that is not there; it is waited for",
        "the closest name is given; one that is spawned later needs nothing",
        world(f'{_BOX}\n<actor name="anna">{_after("bx")}</actor>'),
    ),
    Code(
        "SK-PLUGIN-137",
        "warning",
        "an elevator of Gazebo Classic does not say how far its floors are apart: 3 m",
        "give it a `<floor_height>`",
        model(_BASE + _SLIDES + _CLASSIC),
    ),
    Code(
        "SK-PLUGIN-138",
        "note",
        "how hard a vacuum gripper of ROS 1 pulls has no effect: it holds by a joint",
        "",
        model(
            _BASE + '<plugin name="vacuum" filename="libgazebo_ros_vacuum_gripper.so">\n'
            "  <bodyName>base</bodyName><topicName>grasping</topicName><maxForce>20</maxForce>\n</plugin>"
        ),
    ),
)
