"""Writes the TurtleBot 2 as an SDF and a URDF file, both from the numbers in `robot.py`.

    python assets/turtlebot2/make_models.py

`model.sdf` and `turtlebot2.urdf` then hold the same masses, frames, limits, sensors and plugins. The one difference:
URDF has no ball joint, so a caster is fixed there and slides without friction.
"""

from __future__ import annotations

from pathlib import Path

from robot import turtlebot2
from write_sdf import sdf_text
from write_urdf import urdf_text

FOLDER = Path(__file__).parent
CONFIG = """<?xml version="1.0"?>
<model>
  <name>{title}</name>
  <version>1.0</version>
  <sdf version="1.12">model.sdf</sdf>
  <author>
    <name>simkit</name>
  </author>
  <description>
    {about}
    Masses, sizes and sensor data are the published ones; shapes are our own.
  </description>
</model>
"""


def files() -> dict[Path, str]:
    """Every file that is written, with its text; paths relative to this folder."""
    robot = turtlebot2()
    return {
        Path("model.sdf"): sdf_text(robot),
        Path("model.config"): CONFIG.format(title=robot.title, about=robot.about),
        Path("turtlebot2.urdf"): urdf_text(robot),
    }


def main() -> None:
    for path, text in files().items():
        (FOLDER / path).write_text(text, encoding="utf-8")
        print(path)


if __name__ == "__main__":
    main()
