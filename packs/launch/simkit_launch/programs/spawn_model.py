"""`gazebo_ros spawn_model` of ROS 1: spawns a model from a parameter, a file or a name."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import rospy

from simkit_launch.model_spawning import SpawnError, add_model_arguments, add_spawn_arguments, set_joints, spawn_with
from simkit_launch.program_simulation import current_simulation

_PERIOD = 0.1


def _arguments(words: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="spawn_model", description="Spawn a model in gazebo", allow_abbrev=False)
    add_model_arguments(parser)
    add_spawn_arguments(parser)
    parser.add_argument("-trimesh_mode")
    return parser.parse_args(words)


def _source(given: argparse.Namespace) -> str | None:
    """Return the text, file or URI of the model; None after an error."""
    if given.file:
        rospy.loginfo("Loading model XML from file %s", given.file)
        if not Path(given.file).is_file():
            kind = "is not a file" if Path(given.file).exists() else "does not exist"
            rospy.logfatal("Error: specified file %s %s", given.file, kind)
            return None
        return str(given.file)
    if given.database:
        return f"model://{given.database}"
    if given.stdin:
        return sys.stdin.read() or None
    rospy.loginfo("Loading model XML from ros parameter %s", given.param)
    if not rospy.has_param(given.param):
        rospy.logfatal("Error: param does not exist or is empty")
        return None
    return str(rospy.get_param(given.param))


def main() -> int:
    """Spawn the model; return the exit code."""
    given = _arguments(rospy.myargv()[1:])
    rospy.init_node("spawn_model", anonymous=True)
    sim = current_simulation()
    if given.wait:
        rospy.loginfo("Waiting for model %s before proceeding.", given.wait)
        while given.wait not in sim.models:
            rospy.sleep(_PERIOD)
    source = _source(given)
    if source is None:
        return 1
    given.robot_namespace = given.robot_namespace or rospy.get_namespace()
    rospy.loginfo("Waiting for service /gazebo/spawn_%s_model", "urdf" if given.urdf else "sdf")
    try:
        name = spawn_with(sim, given, source, given.model)
        rospy.loginfo("Spawn status: SpawnModel: Successfully spawned entity")
        set_joints(sim, name, given.joints)
    except SpawnError as error:
        rospy.logerr("Spawn service failed. Exiting.\n%s", error)
        return 1
    if given.unpause:
        sim.paused = False
    if given.bond:
        rospy.spin()
    return 0


if __name__ == "__main__":
    sys.exit(main())
