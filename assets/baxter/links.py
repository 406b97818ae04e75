"""Baxter's pedestal, torso, head and arms, with the numbers of baxter_description (baxter_base.xacro, pedestal.xacro).

Lengths m, masses kg, inertias kg m^2, angles rad.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "tiago"))  # the scripts that write a robot's files
from parts import Collision, Contact, Limit, Link, Look, Sensor, Visual, box, cylinder, drawn, sphere

PACKAGE = "baxter"
HEIGHT = 0.93
"""Of the base frame above the ground: the height at which baxter_world.launch spawns the robot."""
QUARTER = math.pi / 2
ALONG = (QUARTER, 0.0, QUARTER)
"""How the next link is turned where its axis lies along the arm."""
ACROSS = (-QUARTER, -QUARTER, 0.0)
"""How the next link is turned where its axis lies across the arm."""
SKIN = Contact(0.9)
FLOOR = Contact(1.0)
FINGER = Contact(1.0, 1e5, 1.0)
FRAME = 0.0001  # mass of a frame, with an inertia of 1e-8
DAMPING = 0.7

RED = Look("red", (0.58, 0.05, 0.06), 0.4)
DARK = Look("dark_grey", (0.17, 0.17, 0.18), 0.3)
GREY = Look("grey", (0.42, 0.43, 0.45), 0.3)
BLACK = Look("black", (0.04, 0.04, 0.045), 0.5)
FACE = Look("face", (0.10, 0.16, 0.24), 0.7)
WHITE = Look("white", (0.93, 0.93, 0.94), 0.3)


def looks(*parts: tuple[str, str, Look]) -> tuple[Visual, ...]:
    return drawn(*parts, package=PACKAGE)


def frame(name: str, parent: str, xyz: tuple[float, float, float], rpy: tuple[float, float, float] = (0, 0, 0),
          joint: str = "", sensors: tuple[Sensor, ...] = (), about: str = "") -> Link:  # fmt: skip
    """A link without a shape."""
    moments = (1e-8, 1e-8, 1e-8)
    fixed = joint or f"{name}_joint"
    return Link(name, fixed, parent, xyz=xyz, rpy=rpy, mass=FRAME, inertia=moments, sensors=sensors, about=about)


def camera(name: str, topic: str, pose: str) -> Sensor:
    lines = (
        f"<pose>{pose}</pose>",
        "<camera>",
        "  <horizontal_fov>1.3962634</horizontal_fov>",
        "  <image><format>R8G8B8</format><width>800</width><height>800</height></image>",
        "  <clip><near>0.02</near><far>300</far></clip>",
        "  <noise><type>gaussian</type><mean>0</mean><stddev>0.007</stddev></noise>",
        "</camera>",
        '<plugin name="camera_controller" filename="libgazebo_ros_camera.so">',
        "  <robotNamespace>/cameras</robotNamespace>",
        f"  <cameraName>{topic}</cameraName>",
        "  <imageTopicName>image</imageTopicName>",
        "  <cameraInfoTopicName>camera_info</cameraInfoTopicName>",
        f"  <frameName>{topic}</frameName>",
        "</plugin>",
    )
    return Sensor(name, "camera", 30, lines)


def hand_range(side: str) -> Sensor:
    lines = (
        "<ray>",
        "  <scan>",
        "    <horizontal>",
        "      <samples>1</samples><resolution>1</resolution><min_angle>0</min_angle><max_angle>0</max_angle>",
        "    </horizontal>",
        "  </scan>",
        "  <range><min>0.004</min><max>0.4</max></range>",
        "</ray>",
        f'<plugin name="{side}_hand_range" filename="libgazebo_ros_range.so">',
        f"  <topicName>/robot/range/{side}_hand_range/state</topicName>",
        f"  <frameName>{side}_hand_range</frameName>",
        "  <radiation>infrared</radiation>",
        "  <fov>0.0872664626</fov>",
        "  <gaussianNoise>0.005</gaussianNoise>",
        "  <updateRate>100</updateRate>",
        "</plugin>",
    )
    return Sensor(f"ir_{side}", "ray", 100, lines)


# ------------------------------------------------------------------ body


def body() -> Iterator[Link]:
    yield Link(
        "base", mass=FRAME, inertia=(1e-8, 1e-8, 1e-8), about="On the axis of the pedestal, below the shoulders."
    )
    yield Link(
        "torso",
        "torso_t0",
        "base",
        mass=35.336455,
        inertia=(1.849155, 1.662671, 0.802239, -0.000354, -0.154188, 0.003292),
        contact=SKIN,
        collisions=(
            Collision("trunk", box(0.25, 0.36, 0.50), (-0.02, 0, 0.15)),
            Collision("chest", box(0.20, 0.22, 0.22), (0.0, 0, 0.50)),
            Collision("head", sphere(0.22), (0.04, 0, 0.75)),
        ),
        visuals=looks(("shell", "torso_shell", RED), ("core", "torso_core", DARK), ("neck", "torso_neck", GREY)),
        about="Chest with the brackets of both arms and the neck. The sphere keeps things away from the head.",
    )
    yield Link(
        "pedestal",
        "pedestal_fixed",
        "torso",
        mass=60.86397744,
        inertia=(5.0635929, 6.08689388, 4.96191932, 0.00103417, 0.80199628, 0.00105311),
        centre=(0, 0, -0.6),
        contact=FLOOR,
        collisions=(
            Collision("column", cylinder(0.12, 0.75), (0, 0, -0.475)),
            *(
                Collision(f"foot_{k}", box(0.07, 0.07, 0.08), (x, y, 0.04 - HEIGHT))
                for k, (x, y) in enumerate(((0.36, 0.33), (0.36, -0.33), (-0.36, 0.33), (-0.36, -0.33)), 1)
            ),
        ),
        visuals=looks(
            ("column", "pedestal_column", DARK), ("legs", "pedestal_legs", GREY), ("feet", "pedestal_feet", BLACK)
        ),
        about="Column on four feet; its centre of mass is ours, 0.33 m above the ground.",
    )
    for side, y, rpy in (("left", 0.15593, (-QUARTER, 3.1415, 0)), ("right", -0.15593, (QUARTER, 0, 0))):
        yield frame(f"{side}_torso_itb", "torso", (-0.08897, y, 0.389125), rpy)


def head() -> Iterator[Link]:
    tilt = (1.75057, 0.0, QUARTER)
    yield Link(
        "head",
        "head_pan",
        "torso",
        "revolute",
        (0.06, 0, 0.686),
        limit=Limit(50000, 10000, -1.3963, 1.3963, k_position=0, k_velocity=0),
        damping=DAMPING,
        mass=0.547767,
        inertia=(0.004641, 0.003295, 0.003415, 0.000159, 0.000242, -0.001324),
        visuals=looks(("neck", "head_neck", DARK)),
        about="Turns about the vertical; the screen nods no more than Gazebo's does: its joint is fixed.",
    )
    yield Link(
        "screen",
        "head_nod",
        "head",
        xyz=(0.1227, 0, 0),
        rpy=tilt,
        mass=0.440171,
        inertia=(0.004006, 0.0028, 0.001509, 0.00023, 0.000002, 0.000029),
        visuals=looks(
            ("shell", "screen_shell", RED),
            ("frame", "screen_frame", BLACK),
            ("display", "screen_display", FACE),
            ("eyes", "screen_eyes", WHITE),
            ("pupils", "screen_pupils", BLACK),
        ),
        about="Screen with a face: x to the left, y up, z forward.",
    )
    yield frame("display", "screen", (0, -0.016, 0), joint="display_joint")
    sensor = camera("head_camera", "head_camera", "0 0.21 0 0 -0.8 -1.570796327")
    yield frame("head_camera", "head", (0.12839, 0, 0.06368), tilt, "", (sensor,), "Camera above the screen.")
    yield frame("sonar_ring", "torso", (0.0947, 0, 0.817), joint="sonar_s0")


# ------------------------------------------------------------------ arms

JOINTS = {  # link: joint, place and turn in its parent, effort, velocity, lower, upper
    "upper_shoulder": ("s0", (0.055695, 0, 0.011038), (0, 0, 0), 50, 1.5, -1.70167993878, 1.70167993878),
    "lower_shoulder": ("s1", (0.069, 0, 0.27035), (-QUARTER, 0, 0), 50, 1.5, -2.147, 1.047),
    "upper_elbow": ("e0", (0.102, 0, 0), ALONG, 50, 1.5, -3.05417993878, 3.05417993878),
    "lower_elbow": ("e1", (0.069, 0, 0.26242), ACROSS, 50, 1.5, -0.05, 2.618),
    "upper_forearm": ("w0", (0.10359, 0, 0), ALONG, 15, 4, -3.059, 3.059),
    "lower_forearm": ("w1", (0.01, 0, 0.2707), ACROSS, 15, 4, -1.57079632679, 2.094),
    "wrist": ("w2", (0.115975, 0, 0), ALONG, 15, 4, -3.059, 3.059),
}
BODIES = {  # link: mass, centre of mass, ixx, iyy, izz, ixy, ixz, iyz
    "upper_shoulder": (
        *(5.70044, (0.01783, 0.00086, 0.19127)),
        (0.04709102262, 0.03766976455, 0.03595988478, 0.00012787556, 0.00614870039, 0.00078086899),
    ),
    "lower_shoulder": (
        *(3.22698, (0.06845, 0.00269, -0.00529)),
        (0.01175209419, 0.0278859752, 0.02078749298, -0.00030096398, 0.00207675762, -0.00018821993),
    ),
    "upper_elbow": (
        *(4.31272, (-0.00276, 0.00132, 0.18086)),
        (0.02661733557, 0.02844355207, 0.01248008322, 0.00029270634, 0.00392189887, 0.0010838933),
    ),
    "lower_elbow": (
        *(2.07206, (0.02611, 0.00159, -0.01117)),
        (0.00711582686, 0.01318227876, 0.00926852064, 0.00036036173, 0.0007459496, -0.00019663418),
    ),
    "upper_forearm": (
        *(2.24665, (-0.00168, 0.0046, 0.13952)),
        (0.01667742825, 0.01675457264, 0.0037463115, 0.00018403705, 0.00018657629, -0.00064732352),
    ),
    "lower_forearm": (
        *(1.60979, (0.06041, 0.00697, 0.006)),
        (0.00387607152, 0.00700537914, 0.0055275524, -0.00044384784, -0.00021115038, 0.00015348067),
    ),
    "wrist": (
        *(0.35093, (0.00198, 0.00125, 0.01855)),
        (0.00025289155, 0.0002688601, 0.0003074118, 0.00000575311, -0.00000159345, -0.00000519818),
    ),
}
COLLISIONS = {  # cylinders of radius 0.06: name, length, z of the middle
    "upper_shoulder": (("motor", 0.2722, 0.1361),),
    "lower_shoulder": (("motor", 0.12, 0.0),),
    "upper_elbow": (("motor", 0.107, -0.0535), ("upper_arm", 0.273, 0.1415)),
    "lower_elbow": (("motor", 0.10, 0.0),),
    "upper_forearm": (("motor", 0.088, -0.044), ("forearm", 0.272, 0.12041)),
    "lower_forearm": (("motor", 0.10, 0.0),),
    "wrist": (("motor", 0.165, 0.0),),
}


def arm(side: str) -> Iterator[Link]:
    sign = 1.0 if side == "left" else -1.0
    yield frame(
        f"{side}_arm_mount",
        "torso",
        (0.024645, sign * 0.219645, 0.118588),
        (0, 0, sign * 0.7854),
        f"{side}_torso_arm_mount",
        about=f"The {side} arm, from the shoulder to the hand.",
    )
    parent = f"{side}_arm_mount"
    for name, (joint, xyz, rpy, effort, velocity, lower, upper) in JOINTS.items():
        mass, centre, moments = BODIES[name]
        yield Link(
            f"{side}_{name}",
            f"{side}_{joint}",
            parent,
            "revolute",
            xyz,
            rpy,
            limit=Limit(effort, velocity, lower, upper, k_position=0, k_velocity=0),
            damping=DAMPING,
            mass=mass,
            inertia=moments,
            centre=centre,
            contact=SKIN,
            collisions=tuple(Collision(n, cylinder(0.06, length), (0, 0, z)) for n, length, z in COLLISIONS[name]),
            visuals=looks(("shell", name, RED), ("motor", f"{name}_motor", DARK)),
        )
        parent = f"{side}_{name}"
    yield from hand(side)


def hand(side: str) -> Iterator[Link]:
    yield Link(
        f"{side}_hand",
        f"{side}_hand_joint",
        f"{side}_wrist",
        xyz=(0, 0, 0.11355),
        mass=0.19125,
        inertia=(0.00017588, 0.00021166377, 0.00023745397, 0.00000147073, 0.0000243633, 0.00000172689),
        centre=(0.01093, 0.00042, -0.01532),
        contact=SKIN,
        collisions=(Collision("cuff", cylinder(0.04, 0.0464), (0, 0, -0.0232)),),
        visuals=looks(("cuff", "hand_cuff", BLACK)),
    )
    of_hand, place = f"{side}_hand", (0.03825, 0.012, 0.015355)
    name = f"{side}_hand_camera"
    sensor = camera(name, name, "0 0 0 0 -1.570796327 1.570796327")
    yield frame(name, of_hand, place, (0, 0, -QUARTER), "", (sensor,), "Camera that looks along the hand.")
    yield frame(f"{name}_axis", of_hand, place)
    range_place = (0.032, -0.020245, 0.0288)
    sensors = (hand_range(side),)
    yield frame(f"{side}_hand_range", of_hand, range_place, (0, -QUARTER, -QUARTER), "", sensors)
    yield frame(f"{side}_hand_accelerometer", of_hand, (0.00198, 0.000133, -0.0146))
    yield frame(f"{side}_gripper_base", of_hand, (0, 0, 0))


# ------------------------------------------------------------------ electric gripper

SLOT = 0.0095 - 0.011
"""Place of a finger in the second of the gripper's slots."""
LENGTH, WIDTH = 0.075, 0.01725  # of the finger "standard_narrow"


def gripper(side: str) -> Iterator[Link]:
    """The published mass of the palm has an inertia of a point, and those of the fingers are 500 times too large."""
    short, palm = side[0], f"{side}_gripper_electric_base"
    yield Link(
        palm,
        f"{short}_gripper_electric_base_joint",
        f"{side}_gripper_base",
        xyz=(0, 0, 0.025),
        mass=0.3,
        inertia=(1.3e-4, 1.3e-4, 1.3e-4),
        contact=SKIN,
        collisions=(Collision("palm", cylinder(0.029, 0.1), (0, 0, 0), (-QUARTER, math.pi, 0)),),
        visuals=looks(("palm", "gripper_palm", DARK), ("rail", "gripper_rail", GREY)),
        about="Electric gripper with two narrow fingers in the second slots.",
    )
    for which, sign in (("l", 1.0), ("r", -1.0)):
        finger = f"{side}_gripper_{which}_finger"
        leading = f"{short}_gripper_l_finger_joint"
        lower, upper = (0.0, 0.020833) if which == "l" else (-0.020833, 0.0)
        yield Link(
            finger,
            f"{short}_gripper_{which}_finger_joint",
            palm,
            "prismatic",
            (0, sign * SLOT, 0.02),
            axis=(0, 1, 0),
            limit=Limit(20, 5, lower, upper, k_position=0, k_velocity=0),
            mimic="" if which == "l" else leading,
            multiplier=1.0 if which == "l" else -1.0,
            damping=DAMPING,
            mass=0.02,
            inertia=(1e-5, 1e-5, 2e-6),
            centre=(0, sign * WIDTH, 0.03),
            contact=FINGER,
            collisions=(
                Collision("blade", box(0.01, 0.0135, LENGTH), (0, sign * WIDTH, 0.04)),
                Collision("knuckle", box(0.01, WIDTH + 0.03275, 0.017), (sign * -0.005, sign * -0.003, 0.0083)),
            ),
            visuals=looks(("finger", f"finger_{which}", GREY)),
        )
        yield Link(
            f"{finger}_tip",
            f"{finger}_tip_joint",
            finger,
            xyz=(0, sign * WIDTH, LENGTH),
            mass=0.01,
            inertia=(2e-6, 2e-6, 2e-6),
            centre=(0, sign * -0.0045, -0.015),
            contact=FINGER,
            collisions=(Collision("paddle", box(0.042, 0.0065, 0.037), (0, sign * -0.0045, -0.015)),),
            visuals=looks(("paddle", f"paddle_{which}", BLACK)),
        )
    yield frame(f"{side}_gripper_tip", palm, (0, 0, LENGTH + 0.02), joint=f"{short}_gripper_tip_joint")
    about = f"Frame of /robot/limb/{side}/endpoint_state."
    yield frame(f"{side}_gripper", palm, (0, 0, LENGTH + 0.02), joint=f"{side}_endpoint", about=about)


def links() -> tuple[Link, ...]:
    arms = [link for side in ("left", "right") for link in (*arm(side), *gripper(side))]
    return (*body(), *head(), *arms)
