"""Writes the TurtleBot3 robots as SDF and URDF files, both from the numbers in `robots.py` and below.

    python assets/turtlebot3/make_models.py

`turtlebot3_NAME/model.sdf` and `urdf/turtlebot3_NAME.urdf` then hold the same masses, frames, limits, sensors and
plugins. The one difference: URDF has no ball joint, so a caster is fixed there and slides without friction.
"""

from __future__ import annotations

from pathlib import Path

from robots import (
    ALUMINIUM,
    BATTERY,
    BLACK,
    BOARD,
    CAMERA,
    CHIP,
    COMMON,
    FOOTPRINT,
    GLASS,
    MOTOR,
    SOLAR_CELL,
    SOLAR_FRAME,
    Link,
    Plugin,
    Robot,
    base,
    camera,
    caster,
    drawn,
    drive,
    imu,
    lidar,
    optical,
    wheel,
)
from write_sdf import sdf_text
from write_urdf import urdf_text

FOLDER = Path(__file__).parent

BODY = (
    ("plates", BLACK),
    ("posts", ALUMINIUM),
    ("motors", MOTOR),
    ("battery", BATTERY),
    ("boards", BOARD),
    ("chips", CHIP),
)


def burger() -> Robot:
    body = base(
        0.82573504,
        (2.2124416e-3, 2.1193702e-3, 2.0064271e-3),
        (-0.032, 0, 0.070),
        (0.140, 0.140, 0.140),
        drawn("turtlebot3_burger", *((name, name, look) for name, look in BODY)),
    )
    links = (
        FOOTPRINT,
        body,
        wheel("left", 0.080, 0.1),
        wheel("right", -0.080, 0.1),
        caster("caster_back", -0.081, 0, 0.005),
        imu(),
        lidar(-0.032, 0.171),
    )
    about = "The small one: four stacked plates, IMU and planar lidar."
    return Robot("turtlebot3_burger", "TurtleBot3 Burger", about, links, drive(0.160))


def waffle_chassis(wheel_mass: float) -> tuple[Link, ...]:
    """What waffle and waffle_pi have in common."""
    body = base(
        1.3729096,
        (0.042111447, 0.042111447, 0.075254874),
        (-0.064, 0, 0.048),
        (0.265, 0.265, 0.089),
        drawn(COMMON, *((name, f"waffle_{name}", look) for name, look in BODY)),
    )
    return (
        FOOTPRINT,
        body,
        wheel("left", 0.144, wheel_mass),
        wheel("right", -0.144, wheel_mass),
        caster("caster_back_left", -0.177, 0.064, 0.001),
        caster("caster_back_right", -0.177, -0.064, 0.001),
        imu(),
        lidar(-0.064, 0.121),
    )


def camera_mount(x: float, y: float, z: float) -> Link:
    return Link("camera_link", "camera_joint", "base_link", xyz=(x, y, z), about="Where the camera is screwed on.")


def waffle() -> Robot:
    folder = "turtlebot3_waffle"
    case = drawn(folder, ("body", "camera_body", CAMERA), ("lenses", "camera_lenses", GLASS))
    cells = drawn(folder, ("frame", "solar_frame", SOLAR_FRAME), ("cells", "solar_cells", SOLAR_CELL))
    solar = Link(
        "base_solar_sensor",
        "solar_sensor_joint",
        "base_link",
        xyz=(-0.155, 0.055, 0.1025),
        mass=0.005,
        inertia=(1e-6, 1e-6, 1e-6),
        visuals=cells,
        about="Solar sensor on the top plate.",
    )
    depth = Link(
        "camera_depth_frame",
        "camera_depth_joint",
        "camera_link",
        xyz=(0.005, 0.028, 0.013),
        about="The depth lens of the real camera; simkit's depth image is the colour lens's.",
    )
    links = (
        *waffle_chassis(0.1),
        camera_mount(0.064, -0.065, 0.094),
        camera("rgbd_camera", "1.02974", 0.05, 10, case, (0.005, 0.018, 0.013)),
        optical("camera_rgb", "camera_rgb_frame"),
        depth,
        optical("camera_depth", "camera_depth_frame"),
        solar,
    )
    sun = (
        "<update_rate>30</update_rate>",
        "<light_name>sun</light_name>",
        "<frame_name>base_solar_sensor</frame_name>",
    )
    plugins = (*drive(0.287), Plugin("solar_sensor", "libsolar_sensor.so", sun))
    about = "The wide one: IMU, planar lidar, RGB-D camera and solar sensor."
    return Robot("turtlebot3_waffle", "TurtleBot3 Waffle", about, links, plugins)


def waffle_pi() -> Robot:
    parts = (("board", "camera_board", BOARD), ("mount", "camera_mount", BLACK), ("lens", "camera_lens", GLASS))
    links = (
        *waffle_chassis(0.02849894),
        camera_mount(0.073, -0.011, 0.084),
        camera("camera", "1.085595", 0.03, 100, drawn("turtlebot3_waffle_pi", *parts), (0.003, 0.011, 0.009)),
        optical("camera_rgb", "camera_rgb_frame"),
    )
    about = "The waffle with a Raspberry Pi and its camera: IMU, planar lidar, colour camera."
    return Robot("turtlebot3_waffle_pi", "TurtleBot3 Waffle Pi", about, links, drive(0.287))


ROBOTS = (burger(), waffle(), waffle_pi())


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
    Masses, sizes and sensor data are the published ones; shapes are our own.
  </description>
</model>
"""


def files() -> dict[Path, str]:
    """Every file that is written, with its text; paths relative to this folder."""
    found: dict[Path, str] = {}
    for robot in ROBOTS:
        found[Path(robot.name) / "model.sdf"] = sdf_text(robot)
        found[Path(robot.name) / "model.config"] = config_text(robot)
        found[Path("urdf") / f"{robot.name}.urdf"] = urdf_text(robot)
    return found


def main() -> None:
    for path, text in files().items():
        (FOLDER / path).parent.mkdir(exist_ok=True)
        (FOLDER / path).write_text(text, encoding="utf-8")
        print(path)


if __name__ == "__main__":
    main()
