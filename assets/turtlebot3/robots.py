"""What the three TurtleBot3 robots are: the one place of every number that their SDF and URDF files hold.

`make_models.py` writes both from here. Lengths m, masses kg, inertias kg m^2, angles rad; the frames have x forward,
y left, z up, and a link's frame lies where its part is: a wheel's on its axle, a sensor's where it measures.

Masses, sizes and joint positions are the published ones, of the models in `turtlebot3_simulations` and of the robot
descriptions in `turtlebot3` (ROBOTIS, both on GitHub). Where the simulation models hold an inertia that no body of that
mass and size can have, the descriptions' inertia is taken; docs/robots.md says which. A link that only carries a frame
weighs a gram, and not the 1 kg that SDF gives a link without inertia.
"""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass, field
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1]))  # what the scripts of all robots share
from robots_text import ZERO, Collision, Look, Plugin, Sensor, Shape, Vector

QUARTER = math.pi / 2
GRIP = 0.6
"""Friction of a rubber tyre on a smooth floor. A flat tread that never slips (the published 100000 is marked as not
reliable by its authors) fights itself on the spot: its inner and outer edges want to go at different speeds."""
UNBOUNDED_SPEED = 1000.0  # [rad/s] URDF has no wheel without a velocity limit; this one is never reached


@dataclass(frozen=True, slots=True)
class Visual:
    name: str
    shape: Shape
    look: Look


@dataclass(frozen=True, slots=True)
class Link:
    """A link and the joint that holds it.

    Attributes:
        name: of the link.
        joint: the joint's name; empty for the root.
        parent: the link it hangs on.
        kind: "fixed", "wheel" (turns about y) or "caster" (a ball that rolls every way).
        xyz: the link's origin in its parent's frame; of the joint as well.
        rpy: how the link is turned in its parent's frame.
        mass: of the part.
        inertia: (ixx, iyy, izz) about the centre of mass.
        centre: of mass, in the link's frame.
        mu: friction coefficient of its collisions, where it is not 1.
        about: what it is, for the reader of the files.
    """

    name: str
    joint: str = ""
    parent: str = ""
    kind: str = "fixed"
    xyz: Vector = ZERO
    rpy: Vector = ZERO
    mass: float = 0.001
    inertia: Vector = (1e-7, 1e-7, 1e-7)
    centre: Vector = ZERO
    mu: float | None = None
    collisions: tuple[Collision, ...] = ()
    visuals: tuple[Visual, ...] = ()
    sensors: tuple[Sensor, ...] = ()
    about: str = ""


@dataclass(frozen=True, slots=True)
class Robot:
    """A robot; `module` holds its numbers, and `packages` says where the packages of its URDF file's meshes lie."""

    name: str
    title: str
    about: str
    links: tuple[Link, ...]
    plugins: tuple[Plugin, ...] = field(default=())
    module: str = "robots.py"
    packages: str = "The packages that the meshes name lie in the folder above this one."


# ------------------------------------------------------------------ looks

BLACK = Look("black", (0.13, 0.14, 0.15), 0.25)
RUBBER = Look("rubber", (0.07, 0.07, 0.07), 0.1)
STEEL = Look("steel", (0.75, 0.75, 0.78), 0.6)
ALUMINIUM = Look("aluminium", (0.72, 0.73, 0.75), 0.5)
MOTOR = Look("motor", (0.24, 0.25, 0.27), 0.2)
BATTERY = Look("battery", (0.10, 0.22, 0.42), 0.2)
BOARD = Look("board", (0.06, 0.33, 0.20), 0.2)
CHIP = Look("chip", (0.66, 0.67, 0.68), 0.4)
RIM = Look("rim", (0.90, 0.90, 0.88), 0.3)
LIDAR_BASE = Look("lidar_base", (0.16, 0.16, 0.17), 0.2)
LIDAR_HEAD = Look("lidar_head", (0.09, 0.09, 0.10), 0.5)
LIDAR_WINDOW = Look("lidar_window", (0.45, 0.06, 0.06), 0.8)
CAMERA = Look("camera", (0.78, 0.79, 0.81), 0.5)
GLASS = Look("glass", (0.03, 0.03, 0.04), 0.9)
SOLAR_FRAME = Look("solar_frame", (0.85, 0.85, 0.86), 0.3)
SOLAR_CELL = Look("solar_cell", (0.07, 0.14, 0.40), 0.8)


def drawn(folder: str, *parts: tuple[str, str, Look]) -> tuple[Visual, ...]:
    """Visuals of meshes: (name, file without suffix, look) each."""
    return tuple(Visual(name, Shape("mesh", mesh=f"{folder}/meshes/{file}.obj"), look) for name, file, look in parts)


# ------------------------------------------------------------------ parts that every robot has

FOOTPRINT = Link("base_footprint", about="The model's origin: on the ground, midway between the wheels.")
COMMON = "turtlebot3_common"


def base(mass: float, inertia: Vector, centre: Vector, box: Vector, visuals: tuple[Visual, ...]) -> Link:
    return Link(
        "base_link",
        "base_joint",
        "base_footprint",
        xyz=(0, 0, 0.010),
        mass=mass,
        inertia=inertia,
        centre=centre,
        collisions=(Collision("hull", Shape("box", box), centre),),
        visuals=visuals,
        about="Plates, motors, battery and boards; the origin lies 10 mm above the ground, below the axle.",
    )


def wheel(side: str, y: float, mass: float) -> Link:
    return Link(
        f"wheel_{side}_link",
        f"wheel_{side}_joint",
        "base_link",
        "wheel",
        (0, y, 0.023),
        mass=mass,
        inertia=(1.118e-5, 2.0712558e-5, 1.118e-5),
        mu=GRIP,
        collisions=(Collision("tread", Shape("cylinder", (0.033, 0.018)), rpy=(QUARTER, 0, 0)),),
        visuals=drawn(COMMON, ("tyre", "tyre", RUBBER), ("hub", "hub", RIM)),
        about="The axle is the link's y." if side == "left" else "",
    )


def caster(name: str, x: float, y: float, mass: float) -> Link:
    ball = Shape("sphere", (0.005,))
    moment = round(0.4 * mass * 0.005**2, 12)  # a solid ball
    return Link(
        f"{name}_link",
        f"{name}_joint",
        "base_link",
        "caster",
        (x, y, -0.004),
        mass=mass,
        inertia=(moment, moment, moment),
        collisions=(Collision("ball", ball),),
        visuals=(Visual("ball", ball, STEEL),),
        about="Its ball ends 1 mm above the plane of the wheels: the robot leans back a little, as the real one.",
    )


def imu() -> Link:
    def axes(deviation: str) -> list[str]:
        noise = f'<noise type="gaussian"><mean>0</mean><stddev>{deviation}</stddev></noise>'
        return [f"    <{axis}>{noise}</{axis}>" for axis in "xyz"]

    lines = (
        "<imu>",
        "  <angular_velocity>",
        *axes("2e-4"),
        "  </angular_velocity>",
        "  <linear_acceleration>",
        *axes("1.7e-2"),
        "  </linear_acceleration>",
        "</imu>",
        '<plugin name="imu_driver" filename="libgazebo_ros_imu_sensor.so">',
        "  <ros><remapping>~/out:=imu</remapping></ros>",
        "</plugin>",
    )
    place = (-0.032, 0, 0.068)
    return Link(
        "imu_link", "imu_joint", "base_link", xyz=place, sensors=(Sensor("imu", "imu", 200, lines),), about="IMU."
    )


def lidar(x: float, z: float) -> Link:
    lines = (
        "<lidar>",
        "  <scan>",
        "    <horizontal><samples>360</samples><min_angle>0</min_angle><max_angle>6.28</max_angle></horizontal>",
        "  </scan>",
        "  <range><min>0.12</min><max>3.5</max><resolution>0.015</resolution></range>",
        "  <noise><type>gaussian</type><mean>0</mean><stddev>0.01</stddev></noise>",
        "</lidar>",
        '<plugin name="scan_driver" filename="libgazebo_ros_ray_sensor.so">',
        "  <ros><remapping>~/out:=scan</remapping></ros>",
        "  <output_type>sensor_msgs/LaserScan</output_type>",
        "</plugin>",
    )
    parts = (
        ("base", "lidar_base", LIDAR_BASE),
        ("head", "lidar_head", LIDAR_HEAD),
        ("window", "lidar_window", LIDAR_WINDOW),
    )
    return Link(
        "base_scan",
        "lidar_joint",
        "base_link",
        xyz=(x, 0, z),
        mass=0.114,
        inertia=(0.001, 0.001, 0.001),
        collisions=(Collision("housing", Shape("cylinder", (0.0508, 0.055)), (0.012, 0, -0.010)),),
        visuals=drawn(COMMON, *parts),
        sensors=(Sensor("lds", "lidar", 5, lines),),
        about="Laser scanner; the origin lies in the scan plane.",
    )


def optical(name: str, parent: str) -> Link:
    frame = f"{name}_optical_frame"
    about = "The frame that images are stamped with: z along the view, x to the right, y down."
    return Link(frame, f"{name}_optical_joint", parent, rpy=(-QUARTER, 0, -QUARTER), about=about)


def camera(kind: str, view: str, near: float, far: float, links: tuple[Visual, ...], xyz: Vector) -> Link:
    """The link of the colour lens. `view` is the horizontal field of view [rad] as text."""
    lines = (
        "<camera>",
        f"  <horizontal_fov>{view}</horizontal_fov>",
        "  <image><width>640</width><height>480</height><format>R8G8B8</format></image>",
        f"  <clip><near>{near:g}</near><far>{far:g}</far></clip>",
        "  <noise><type>gaussian</type><mean>0</mean><stddev>0.007</stddev></noise>",
        "</camera>",
        '<plugin name="camera_driver" filename="libgazebo_ros_camera.so">',
        "  <camera_name>camera</camera_name>",
        "  <frame_name>camera_rgb_optical_frame</frame_name>",
        "</plugin>",
    )
    return Link(
        "camera_rgb_frame",
        "camera_rgb_joint",
        "camera_link",
        xyz=xyz,
        mass=0.035,
        inertia=(0.001, 0.001, 0.001),
        visuals=links,
        sensors=(Sensor("camera", kind, 30, lines),),
        about="Camera; the origin is the colour lens, which looks along x.",
    )


def drive(separation: float) -> tuple[Plugin, Plugin]:
    wheels = (
        "<update_rate>30</update_rate>",
        "<left_joint>wheel_left_joint</left_joint>",
        "<right_joint>wheel_right_joint</right_joint>",
        f"<wheel_separation>{separation:g}</wheel_separation>",
        "<wheel_diameter>0.066</wheel_diameter>",
        "<max_wheel_torque>20</max_wheel_torque>",
        "<max_wheel_acceleration>1</max_wheel_acceleration>",
        "<publish_odom>true</publish_odom>",
        "<publish_odom_tf>true</publish_odom_tf>",
        "<odometry_source>0</odometry_source>",
        "<odometry_frame>odom</odometry_frame>",
        "<robot_base_frame>base_footprint</robot_base_frame>",
    )
    states = (
        "<update_rate>30</update_rate>",
        "<joint_name>wheel_left_joint</joint_name>",
        "<joint_name>wheel_right_joint</joint_name>",
    )
    about = "Odometry comes from the wheels' encoders (source 0), as on the robot. The limit 1 is in m/s^2 at the rim."
    return (
        Plugin("diff_drive", "libgazebo_ros_diff_drive.so", wheels, about),
        Plugin("joint_states", "libgazebo_ros_joint_state_publisher.so", states),
    )
