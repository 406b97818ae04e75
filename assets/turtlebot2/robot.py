"""What the TurtleBot 2 is: the one place of every number that its SDF and URDF files hold.

`make_models.py` writes both from here. Lengths m, masses kg, inertias kg m^2, angles rad; the frames have x forward,
y left, z up, and a link's frame lies where its part is.

Masses, sizes and positions are the published ones: of the base from `kobuki_description` (Yujin Robot, on GitHub in
`kobuki` and, for ROS 2, in `kobuki_ros`); of the plates, the poles and the Kinect from `turtlebot_description` (on
GitHub in `turtlebot`). docs/robots.md lists where these files differ from the published ones.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "turtlebot3"))  # the records and writers are the same
from robots import (
    ALUMINIUM,
    FOOTPRINT,
    GLASS,
    QUARTER,
    RUBBER,
    Collision,
    Link,
    Look,
    Plugin,
    Robot,
    Sensor,
    Shape,
    Vector,
    Visual,
    drawn,
    optical,
)

FOLDER = "turtlebot2"
CLEARANCE = 0.0102  # height of base_link above the ground
WHEEL_RADIUS, WHEEL_WIDTH, WHEEL_SEPARATION = 0.0352, 0.0206, 0.23
CASTER_RADIUS = 0.017
PLATE_THICKNESS, PLATE_RADIUS = 0.006, 0.170
POLE_RADIUS = 0.006

SHELL = Look("shell", (0.24, 0.245, 0.255), 0.35)
BUMPER = Look("bumper", (0.15, 0.155, 0.16), 0.2)
DECK = Look("deck", (0.19, 0.195, 0.20), 0.15)
PLATE = Look("plate", (0.115, 0.115, 0.12), 0.3)
RIM = Look("rim", (0.62, 0.63, 0.64), 0.3)
BUTTON = Look("button", (0.80, 0.81, 0.83), 0.3)
LAMP = Look("lamp", (0.15, 0.75, 0.30), 0.6)
LENS_GLASS = Look("lens_glass", (0.27, 0.29, 0.34), 0.9)
KINECT = Look("kinect", (0.085, 0.085, 0.09), 0.7)


def solid_cylinder(mass: float, radius: float, length: float) -> Vector:
    """The inertia of a cylinder whose axis is y."""
    across = round(mass * (3 * radius**2 + length**2) / 12, 12)
    return across, round(mass * radius**2 / 2, 12), across


def base() -> Link:
    looks = (
        ("shell", SHELL),
        ("bumper", BUMPER),
        ("deck", DECK),
        ("window", GLASS),
        ("buttons", BUTTON),
        ("lamps", LAMP),
    )
    contact = "<contact><collision>base</collision></contact>"
    return Link(
        "base_link",
        "base_joint",
        "base_footprint",
        xyz=(0, 0, CLEARANCE),
        mass=2.4,
        inertia=(0.019995, 0.019995, 0.03675),
        centre=(0.01, 0, 0),
        mu=0.3,
        collisions=(Collision("base", Shape("cylinder", (0.178, 0.10938)), (0, 0, 0.05949)),),
        visuals=drawn(FOLDER, *((name, name, look) for name, look in looks)),
        sensors=(Sensor("bumpers", "contact", 50, (contact,)),),
        about="The Kobuki base; the origin lies on the underside of its body.",
    )


def wheel(side: str, y: float) -> Link:
    return Link(
        f"wheel_{side}_link",
        f"wheel_{side}_joint",
        "base_link",
        "wheel",
        (0, y, WHEEL_RADIUS - CLEARANCE),
        mass=0.01,
        inertia=solid_cylinder(0.01, WHEEL_RADIUS, WHEEL_WIDTH),
        mu=1.0,
        collisions=(Collision("tread", Shape("cylinder", (WHEEL_RADIUS, WHEEL_WIDTH)), rpy=(QUARTER, 0, 0)),),
        visuals=drawn(FOLDER, ("tyre", "tyre", RUBBER), ("hub", "hub", RIM)),
        about="The axle is the link's y." if side == "left" else "",
    )


def caster(side: str, x: float, z: float, about: str) -> Link:
    ball = Shape("sphere", (CASTER_RADIUS,))
    moment = round(0.4 * 0.01 * CASTER_RADIUS**2, 12)  # a solid ball
    return Link(
        f"caster_{side}_link",
        f"caster_{side}_joint",
        "base_link",
        "caster",
        (x, 0, z),
        mass=0.01,
        inertia=(moment, moment, moment),
        collisions=(Collision("ball", ball),),
        visuals=(Visual("ball", ball, RUBBER),),
        about=about,
    )


def gyro() -> Link:
    def noise(quantity: str, deviation: str) -> list[str]:
        one = f'<noise type="gaussian"><mean>0</mean><stddev>{deviation}</stddev></noise>'
        return [f"  <{quantity}>", *(f"    <{axis}>{one}</{axis}>" for axis in "xyz"), f"  </{quantity}>"]

    lines = ("<imu>", *noise("angular_velocity", "1.4e-3"), *noise("linear_acceleration", "1.7e-2"), "</imu>")
    place = (0.056, 0.062, 0.0202)
    return Link(
        "gyro_link", "gyro_joint", "base_link", xyz=place, sensors=(Sensor("imu", "imu", 50, lines),), about="IMU."
    )


CLIFFS: dict[str, Vector] = {
    "left": (0.08734, 0.13601, 0.0214),
    "right": (0.085, -0.13601, 0.0214),
    "front": (0.156, 0, 0.0214),
}


def cliff_sensor(side: str) -> Sensor:
    """A cliff sensor. It is inside the base's collision, which its rays pass through: the plugin takes care of this."""
    lines = (
        "<ray>",
        "  <scan>",
        "    <horizontal><samples>50</samples><min_angle>-0.0436</min_angle><max_angle>0.0436</max_angle></horizontal>",
        "  </scan>",
        "  <range><min>0.01</min><max>0.15</max></range>",
        "</ray>",
    )
    return Sensor(f"cliff_sensor_{side}", "ray", 50, lines)


def cliff(side: str) -> Link:
    return Link(
        f"cliff_sensor_{side}_link",
        f"cliff_sensor_{side}_joint",
        "base_link",
        xyz=CLIFFS[side],
        rpy=(0, QUARTER, 0),
        mass=0.0001,
        inertia=(1e-8, 1e-8, 1e-8),
        sensors=(cliff_sensor(side),),
        about="Cliff sensors; x looks down." if side == "left" else "",
    )


# ------------------------------------------------------------------ the stack

POLES: dict[str, tuple[float, float, float, tuple[tuple[float, float], ...]]] = {
    "bottom": (
        0.008,
        0.0492,
        0.1028,
        tuple((x, y * s) for s in (1, -1) for x, y in ((0.12, 0.082), (0.055, 0.12), (-0.055, 0.12))),
    ),
    "middle": (0.012, 0.0608, 0.1640, tuple((x, y) for x in (0.0381, -0.0381) for y in (0.1505, -0.1505))),
    "top": (0.060, 0.2032, 0.2920, tuple((x, y) for x in (0.0381, -0.0381) for y in (0.1505, -0.1505))),
    "kinect": (0.020, 0.0936, 0.2372, ((-0.1024, 0.098), (-0.1024, -0.098))),
}
"""Poles by name: mass, length, height of their middle above base_link, and (x, y) of each."""


def poles() -> list[Link]:
    found = []
    for name, (mass, length, z, places) in POLES.items():
        shape = Shape("cylinder", (POLE_RADIUS, length))
        across, along, _ = solid_cylinder(mass, POLE_RADIUS, length)
        for index, (x, y) in enumerate(places):
            link = Link(
                f"pole_{name}_{index}_link",
                f"pole_{name}_{index}_joint",
                "base_link",
                xyz=(x, y, z),
                mass=mass,
                inertia=(across, across, along),
                collisions=(Collision("pole", shape),),
                visuals=(Visual("pole", shape, ALUMINIUM),),
            )
            found.append(link)
    return found


def plate(name: str, x: float, z: float) -> Link:
    # the collision is a disc around the base's axis, as published; the origin is the middle of the plate's outline
    disc = Collision("plate", Shape("cylinder", (PLATE_RADIUS, PLATE_THICKNESS)), (-x, 0, 0))
    return Link(
        f"plate_{name}_link",
        f"plate_{name}_joint",
        "base_link",
        xyz=(x, 0, z),
        mass=0.520,
        inertia=(0.003328, 0.003328, 0.006656),
        collisions=(disc,),
        visuals=drawn(FOLDER, ("plate", f"plate_{'bottom' if name == 'bottom' else 'top'}", PLATE)),
    )


# ------------------------------------------------------------------ the Kinect

LENS: Vector = (-0.087, -0.0125, 0.2870)  # of the colour camera, in base_link


def kinect() -> tuple[Link, ...]:
    lines = (
        "<camera>",
        f"  <horizontal_fov>{math.radians(60):.6f}</horizontal_fov>",
        "  <image><width>640</width><height>480</height><format>B8G8R8</format></image>",
        "  <clip><near>0.05</near><far>8</far></clip>",
        "</camera>",
        '<plugin name="kinect_camera_controller" filename="libgazebo_ros_openni_kinect.so">',
        "  <cameraName>camera</cameraName>",
        "  <updateRate>20</updateRate>",
        "  <imageTopicName>rgb/image_raw</imageTopicName>",
        "  <cameraInfoTopicName>rgb/camera_info</cameraInfoTopicName>",
        "  <depthImageTopicName>depth/image_raw</depthImageTopicName>",
        "  <depthImageCameraInfoTopicName>depth/camera_info</depthImageCameraInfoTopicName>",
        "  <pointCloudTopicName>depth/points</pointCloudTopicName>",
        "  <frameName>camera_rgb_optical_frame</frameName>",
        "  <pointCloudCutoff>0.4</pointCloudCutoff>",
        "</plugin>",
    )
    lens = Link(
        "camera_rgb_frame",
        "camera_rgb_joint",
        "base_link",
        xyz=LENS,
        sensors=(Sensor("camera", "depth", 20, lines),),
        about="The colour lens, which looks along x. The depth image is taken from here, too.",
    )
    body = Link(
        "camera_link",
        "camera_joint",
        "camera_rgb_frame",
        xyz=(-0.031, -LENS[1], -0.016),
        mass=0.564,
        inertia=(0.003881243, 0.000498940, 0.003879257),
        collisions=(Collision("case", Shape("box", (0.07271, 0.27794, 0.073))),),
        visuals=drawn(FOLDER, ("case", "kinect_case", KINECT), ("lenses", "kinect_lenses", LENS_GLASS)),
        about="The Kinect's case.",
    )
    depth = Link(
        "camera_depth_frame",
        "camera_depth_joint",
        "camera_rgb_frame",
        xyz=(0, -2 * LENS[1], 0),
        about="The infrared lens of the real camera.",
    )
    colour_frame, depth_frame = optical("camera_rgb", "camera_rgb_frame"), optical("camera_depth", "camera_depth_frame")
    return lens, colour_frame, body, depth, depth_frame


def drive() -> Plugin:
    lines = (
        "<publish_tf>true</publish_tf>",
        "<left_wheel_joint_name>wheel_left_joint</left_wheel_joint_name>",
        "<right_wheel_joint_name>wheel_right_joint</right_wheel_joint_name>",
        f"<wheel_separation>{WHEEL_SEPARATION:g}</wheel_separation>",
        f"<wheel_diameter>{2 * WHEEL_RADIUS:g}</wheel_diameter>",
        "<torque>1</torque>",
        "<velocity_command_timeout>0.6</velocity_command_timeout>",
        "<cliff_sensor_left_name>cliff_sensor_left</cliff_sensor_left_name>",
        "<cliff_sensor_center_name>cliff_sensor_front</cliff_sensor_center_name>",
        "<cliff_sensor_right_name>cliff_sensor_right</cliff_sensor_right_name>",
        "<cliff_detection_threshold>0.04</cliff_detection_threshold>",
        "<bumper_name>bumpers</bumper_name>",
        "<imu_name>imu</imu_name>",
        "<dock_model>kobuki_dock</dock_model>",
    )
    return Plugin("kobuki_controller", "libgazebo_ros_kobuki.so", lines)


def turtlebot2() -> Robot:
    links = (
        FOOTPRINT,
        base(),
        wheel("left", WHEEL_SEPARATION / 2),
        wheel("right", -WHEEL_SEPARATION / 2),
        caster("front", 0.115, 0.007, "This ball ends 0.2 mm above the plane of the wheels."),
        caster("back", -0.135, 0.009, "This ball ends 2.2 mm above that plane: the robot leans back by 0.9 degrees."),
        gyro(),
        *(cliff(side) for side in CLIFFS),
        *poles(),
        plate("bottom", 0.02364, 0.1306),
        plate("middle", -0.01364, 0.1874),
        plate("top", -0.01364, 0.3966),
        *kinect(),
    )
    about = "A Kobuki base, a stack of three plates, and a Kinect."
    packages = 'The package "turtlebot2" that the meshes name is this folder.'
    return Robot("turtlebot2", "TurtleBot 2", about, links, (drive(),), "robot.py", packages)
