"""Writes TIAGo, TIAGo without arm and the base PMB2 as URDF and SDF files, all from the numbers in the modules here.

    python assets/tiago/make_models.py

`NAME.urdf` lies here; `model.sdf` here is TIAGo, the other two have a folder of their own, so that `model://NAME`
finds them. A robot's SDF and URDF hold the same masses, frames, limits, sensors and plugins.
"""

from __future__ import annotations

from pathlib import Path

from arm_links import arm, gripper, rgbd_laser
from base_links import base_links
from control import controllers, joint_frames, ros2_control, tiago_plugins, world_odometry
from parts import Robot
from upper_links import head, torso
from write_sdf import sdf_text
from write_urdf import urdf_text

FOLDER = Path(__file__).parent


def tiago() -> Robot:
    about = "Mobile base, lifting torso, head with an RGB-D camera, arm of seven joints, gripper with two fingers."
    links = (*base_links(), *torso(arm=True), *head(), *arm(), *gripper(), rgbd_laser())
    control = ros2_control("tiago", torso_and_head=True, arm=True)
    return Robot("tiago", "TIAGo", about, links, tiago_plugins("controllers.yaml", "motions.yaml"), control)


def tiago_no_arm() -> Robot:
    about = "Mobile base, lifting torso and head with an RGB-D camera."
    links = (*base_links(), *torso(arm=False), *head(), rgbd_laser())
    control = ros2_control("tiago", torso_and_head=True, arm=False)
    plugins = tiago_plugins("controllers_no_arm.yaml", "motions_no_arm.yaml")
    return Robot("tiago_no_arm", "TIAGo without arm", about, links, plugins, control)


def pmb2() -> Robot:
    about = "The mobile base alone: differential drive on a sprung axle, laser, three sonars, IMU."
    plugins = (controllers("controllers_base.yaml"), joint_frames(), world_odometry())
    control = ros2_control("pmb2", torso_and_head=False, arm=False)
    return Robot("pmb2", "PMB2", about, base_links(), plugins, control)


ROBOTS = (tiago(), tiago_no_arm(), pmb2())


def config_text(robot: Robot) -> str:
    """`model.config`: what Gazebo's model browsers show."""
    return f"""<?xml version="1.0"?>
<model>
  <name>{robot.title}</name>
  <version>1.0</version>
  <sdf version="1.12">model.sdf</sdf>
  <author>
    <name>simkit</name>
  </author>
  <description>
    {robot.about}
    Masses, frames, limits and sensor data are the published ones; shapes are our own.
  </description>
</model>
"""


def files() -> dict[Path, str]:
    """Every file that is written, with its text; paths relative to this folder."""
    found: dict[Path, str] = {}
    for robot in ROBOTS:
        folder = Path() if robot.name == FOLDER.name else Path(robot.name)
        found[folder / "model.sdf"] = sdf_text(robot)
        found[folder / "model.config"] = config_text(robot)
        found[Path(f"{robot.name}.urdf")] = urdf_text(robot)
    return found


def main() -> None:
    for path, text in files().items():
        (FOLDER / path).parent.mkdir(exist_ok=True)
        (FOLDER / path).write_text(text, encoding="utf-8")
        print(path)


if __name__ == "__main__":
    main()
