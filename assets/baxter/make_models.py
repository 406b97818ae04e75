"""Writes Baxter as an SDF and a URDF file, both from the numbers in `links.py`.

    python assets/baxter/make_models.py

`baxter.urdf` and `model.sdf` lie here. Both hold the same masses, frames, limits, sensors and plugins.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from links import HEIGHT, JOINTS, PACKAGE, links
from parts import Link, Plugin, Robot
from robots_text import number
from write_sdf import sdf_text
from write_urdf import urdf_text

FOLDER = Path(__file__).parent
LIMB = tuple(joint for joint, *_ in JOINTS.values())
START = {  # joint angles at which baxter_world.launch spawns the robot: arms down, bent a little
    **dict(zip((f"right_{joint}" for joint in LIMB), (-0.272659, 1.047, -0.00123203, 0.49262, -0.0806423, -0.0620532,
                                                      0.0265941), strict=True)),
    **dict(zip((f"left_{joint}" for joint in LIMB), (0.192483, 1.047, 0.000806359, 0.491094, -0.178079, -0.0610333,
                                                     -0.0124707), strict=True)),
}  # fmt: skip
ABOUT = "Two arms of seven joints with electric grippers, a head with a screen, on a pedestal."


def transmissions(all_links: tuple[Link, ...]) -> Iterator[str]:
    """One motor for each joint that moves, as the published description has them."""
    for link in all_links:
        if link.kind != "fixed":
            yield f'<transmission name="{link.joint}_transmission">'
            yield "  <type>transmission_interface/SimpleTransmission</type>"
            yield f'  <joint name="{link.joint}">'
            yield "    <hardwareInterface>hardware_interface/EffortJointInterface</hardwareInterface>"
            yield "  </joint>"
            yield f'  <actuator name="{link.joint}_motor">'
            yield "    <mechanicalReduction>1</mechanicalReduction>"
            yield "  </actuator>"
            yield "</transmission>"


def baxter() -> Robot:
    control = Plugin(
        "baxter_ros_control",
        "libbaxter_gazebo_ros_control.so",
        (
            "<robotNamespace>/robot</robotNamespace>",
            "<initial_positions>",
            *(f"  <{joint}>{number(value)}</{joint}>" for joint, value in START.items()),
            "</initial_positions>",
        ),
        "Arms, head and grippers, on the topics below /robot.",
    )
    frames = Plugin(
        "robot_state_publisher",
        "libsimkit_robot_state_publisher.so",
        ("<publish_frequency>50</publish_frequency>",),
        "The links that joints move, on /tf.",
    )
    found = links()
    return Robot(
        "baxter",
        "Baxter",
        ABOUT,
        found,
        (control, frames),
        tuple(transmissions(found)),
        origin=f"base: {HEIGHT} m above the ground, on the axis of the pedestal",
        height=HEIGHT,
        package=PACKAGE,
    )


def config_text() -> str:
    """`model.config`: what Gazebo's model browsers show."""
    return f"""<?xml version="1.0"?>
<model>
  <name>Baxter</name>
  <version>1.0</version>
  <sdf version="1.12">model.sdf</sdf>
  <author>
    <name>simkit</name>
  </author>
  <description>
    {ABOUT}
    Masses, frames, limits and sensor data are the published ones; shapes are our own.
  </description>
</model>
"""


def files() -> dict[Path, str]:
    """Every file that is written, with its text; paths relative to this folder."""
    robot = baxter()
    texts = {"model.sdf": sdf_text(robot), "model.config": config_text(), "baxter.urdf": urdf_text(robot)}
    return {Path(name): text for name, text in texts.items()}


def main() -> None:
    for path, text in files().items():
        (FOLDER / path).write_text(text, encoding="utf-8")
        print(path)


if __name__ == "__main__":
    main()
