"""TIAGo's arm of seven joints, the force-torque sensor at its wrist and the two-fingered gripper."""

from __future__ import annotations

from parts import (
    BLACK,
    DARK,
    GREY,
    HALF,
    LIGHT,
    METAL,
    QUARTER,
    WHITE,
    Collision,
    Contact,
    Limit,
    Link,
    Sensor,
    Visual,
    box,
    cylinder,
    drawn,
    solid_cylinder,
)

SKIN = Contact(0.9)
FINGER = Contact(1.0, 1e6, 1.0)
SIDEWAYS = (QUARTER, 0, 0)
ALONG = (0, QUARTER, 0)


def arm() -> tuple[Link, ...]:
    first = Link(
        "arm_1_link",
        "arm_1_joint",
        "torso_lift_link",
        "revolute",
        (0.15505, 0.014, -0.151),
        (0, 0, -QUARTER),
        limit=Limit(43, 1.95, 0, 2.748893571891069, 0.07),
        damping=40,
        friction=1,
        mass=1.563428,
        inertia=(0.002721, 0.006382, 0.006954, -0.001809, -0.001202, 0.000494),
        centre=(0.061191, -0.022397, -0.012835),
        contact=SKIN,
        collisions=(
            Collision("puck", cylinder(0.052, 0.058), (0, 0, 0.009)),
            Collision("flange", box(0.13, 0.036, 0.105), (0.11, 0.069, -0.0275)),
        ),
        visuals=drawn(("shoulder", "arm_1", DARK)),
        about="Shoulder: turns about the vertical below the chest; at 0 the arm is to the right.",
    )
    second = Link(
        "arm_2_link",
        "arm_2_joint",
        first.name,
        "revolute",
        (0.125, 0.0195, -0.031),
        SIDEWAYS,
        limit=Limit(43, 1.95, -1.5707963267948966, 1.090830782496456, 0.07),
        damping=40,
        friction=1,
        mass=1.800397,
        inertia=(0.001809, 0.004333, 0.004341, 1.5e-5, 0.000254, 1.4e-5),
        centre=(0.030432, 0.000229, -0.005942),
        contact=SKIN,
        collisions=(
            Collision("motor", cylinder(0.052, 0.1)),
            Collision("collar", cylinder(0.048, 0.082), (0.041, 0, 0), ALONG),
        ),
        visuals=drawn(("motor", "arm_2", DARK)),
        about="Shoulder: lifts the arm.",
    )
    third = Link(
        "arm_3_link",
        "arm_3_joint",
        second.name,
        "revolute",
        (0.0895, 0, -0.0015),
        (-QUARTER, 0, QUARTER),
        limit=Limit(26, 2.35, -3.5342917352885173, 1.5707963267948966, 0.07),
        damping=40,
        friction=1,
        mass=1.8,
        inertia=(0.019541, 0.019936, 0.002864, -0.000105, -0.001717, 0.000852),
        centre=(0.007418, -0.004361, -0.134194),
        contact=SKIN,
        collisions=(
            Collision("shaft", cylinder(0.05, 0.2), (0, 0, -0.096)),
            Collision("elbow", cylinder(0.052, 0.055), (-0.02, 0.0305, -0.222), SIDEWAYS),
        ),
        visuals=drawn(("shaft", "arm_3", DARK), ("ring", "arm_3_ring", METAL)),
        about="Upper arm: turns about itself.",
    )
    fourth = Link(
        "arm_4_link",
        "arm_4_joint",
        third.name,
        "revolute",
        (-0.02, -0.027, -0.222),
        (-QUARTER, -QUARTER, 0),
        limit=Limit(26, 2.35, -0.39269908169872414, 2.356194490192345, 0.07),
        damping=40,
        friction=1,
        mass=1.432697,
        inertia=(0.00204, 0.008424, 0.008686, 0.000725, -0.00115, -0.000204),
        centre=(-0.095658, 0.014666, 0.018133),
        contact=SKIN,
        collisions=(
            Collision("elbow", cylinder(0.052, 0.055), (0, 0, -0.0035)),
            Collision("forearm", cylinder(0.049, 0.148), (-0.094, 0.02, 0.027), ALONG),
        ),
        visuals=drawn(("elbow", "arm_4", DARK)),
        about="Elbow.",
    )
    return first, second, third, fourth, *wrist()


def wrist() -> tuple[Link, ...]:
    fifth = Link(
        "arm_5_link",
        "arm_5_joint",
        "arm_4_link",
        "revolute",
        (-0.162, 0.02, 0.027),
        (QUARTER, -QUARTER, -QUARTER),
        limit=Limit(3, 1.95, -2.0943951023931953, 2.0943951023931953, 0.02),
        damping=1,
        friction=1,
        mass=1.655819,
        inertia=(0.006138, 0.00564, 0.001797, -4e-6, 0.000156, 2.2e-5),
        centre=(0.001078, -0.000151, -0.077173),
        contact=SKIN,
        collisions=(
            Collision("forearm", cylinder(0.054, 0.105), (0, 0, 0.0625)),
            Collision("fork", box(0.07, 0.13, 0.055), (0, 0, 0.1375)),
        ),
        visuals=drawn(("forearm", "arm_5", LIGHT), ("ring", "arm_5_ring", METAL)),
        about="Forearm: turns about itself.",
    )
    sixth = Link(
        "arm_6_link",
        "arm_6_joint",
        fifth.name,
        "revolute",
        (0, 0, 0.15),
        (0, -QUARTER, -QUARTER),
        limit=Limit(6.6, 1.76, -1.413716694115407, 1.413716694115407, 0.02),
        damping=1,
        friction=1,
        mass=0.370063,
        inertia=(0.000215, 0.00017, 0.000174, 0, 0, 2e-6),
        centre=(-0.000153, -0.003122, 0.000183),
        contact=SKIN,
        collisions=(Collision("gimbal", cylinder(0.036, 0.042)),),
        visuals=drawn(("gimbal", "arm_6", METAL)),
        about="Wrist: bends.",
    )
    seventh = Link(
        "arm_7_link",
        "arm_7_joint",
        sixth.name,
        "revolute",
        rpy=(QUARTER, 0, QUARTER),
        limit=Limit(6.6, 1.76, -2.0943951023931953, 2.0943951023931953, 0.02),
        damping=1,
        friction=1,
        mass=0.234252,
        inertia=(0.000142, 0.000113, 5.2e-5),
        centre=(0.00001, -0.000003, -0.007774),
        visuals=drawn(("shaft", "arm_7", LIGHT)),
        about="Wrist: turns the tool about itself.",
    )
    disc = cylinder(0.005, 0.005)
    tool = Link(
        "arm_tool_link",
        "arm_tool_joint",
        seventh.name,
        xyz=(0, 0, 0.046),
        rpy=(QUARTER, -QUARTER, HALF),
        mass=0.1,
        inertia=turned(solid_cylinder(0.1, 0.0225, 0.0157)),
        collisions=(Collision("flange", disc, (0.001, 0, 0), ALONG),),
        visuals=(Visual("flange", disc, LIGHT, (0.001, 0, 0), ALONG),),
        about="Where tools are screwed on; x points out of the wrist.",
    )
    return fifth, sixth, seventh, tool, *wrist_sensor()


def turned(moments: tuple[float, float, float]) -> tuple[float, float, float]:
    """Of a cylinder whose axis is x instead of z."""
    across, _, along = moments
    return along, across, across


def wrist_sensor() -> tuple[Link, Link]:
    lines = (
        "<force_torque>",
        "  <frame>child</frame>",
        "  <measure_direction>child_to_parent</measure_direction>",
        "</force_torque>",
    )
    body, face = cylinder(0.0225, 0.0157), cylinder(0.025, 0.00975)
    sensor = Link(
        "wrist_ft_link",
        "wrist_ft_joint",
        "arm_tool_link",
        xyz=(0.00785, 0, 0),
        rpy=(QUARTER, 0, QUARTER),
        mass=0.1,
        inertia=solid_cylinder(0.1, 0.0225, 0.0157),
        collisions=(Collision("body", body),),
        visuals=(Visual("body", body, METAL),),
        joint_sensors=(Sensor("wrist_ft_sensor", "force_torque", 100, lines),),
        about="Force-torque sensor; z points out of the wrist.",
    )
    plate = Link(
        "wrist_ft_tool_link",
        "wrist_tool_joint",
        sensor.name,
        xyz=(0, 0, 0.012725),
        rpy=(-QUARTER, -QUARTER, 0),
        mass=0.1,
        inertia=turned(solid_cylinder(0.1, 0.025, 0.00975)),
        collisions=(Collision("face", face, rpy=ALONG),),
        visuals=(Visual("face", face, BLACK, rpy=ALONG),),
        about="The sensor's outer face.",
    )
    return sensor, plate


def gripper() -> tuple[Link, ...]:
    out = (QUARTER, QUARTER, -QUARTER)
    body = Link(
        "gripper_link",
        "gripper_joint",
        "wrist_ft_tool_link",
        xyz=(0.01, 0, 0),
        rpy=out,
        mass=0.60266,
        inertia=(0.000693, 0.001024, 0.000672, 4.5e-5, 0, 0),
        centre=(-0.000294, 0.000291, -0.033086),
        collisions=(Collision("palm", box(0.158, 0.072, 0.1), (0, 0, -0.052)),),
        visuals=drawn(("palm", "gripper_palm", WHITE), ("rail", "gripper_rail", DARK)),
        about="Gripper; the fingers point along -z and open along x.",
    )
    tool = Link(
        "gripper_tool_link",
        "gripper_tool_joint",
        "wrist_ft_tool_link",
        xyz=(0.01, 0, 0),
        rpy=out,
        mass=0.0001,
        inertia=(1e-5, 1e-5, 1e-5),
    )
    grasp = Link(
        "gripper_grasping_frame",
        "gripper_grasping_frame_joint",
        body.name,
        xyz=(0, 0, -0.12),
        rpy=(-1.5708, 1.5708, 0),
        mass=0.0001,
        inertia=(1e-5, 1e-5, 1e-5),
        about="Between the fingers; x points out.",
    )
    return tool, body, finger("right", 1), finger("left", -1), grasp


def finger(side: str, sign: int) -> Link:
    """The inner face lies in x = 0 of the finger's own frame: opened by q, the gap is 2 q. The left finger follows."""
    pad = box(0.01, 0.05, 0.11)
    return Link(
        f"gripper_{side}_finger_link",
        f"gripper_{side}_finger_joint",
        "gripper_link",
        "prismatic",
        axis=(sign, 0, 0),
        limit=Limit(16, 0.05, 0, 0.045, 0.001),
        mimic="gripper_right_finger_joint" if side == "left" else "",
        damping=80,
        friction=2,
        mass=0.10998,
        inertia=(0.000236, 0.000228, 3.3e-5, -5e-6, -3.2e-5, 3.6e-5),
        centre=(-0.00447, 0.010766, -0.121013),
        contact=FINGER,
        collisions=(Collision("pad", pad, (sign * 0.005, 0, -0.165)),),
        visuals=drawn(("finger", f"finger_{side}", BLACK), ("pad", f"finger_{side}_pad", GREY)),
    )


def rgbd_laser() -> Link:
    """The frame of the scan that a driver of the robot makes from the depth image; nothing of the body."""
    return Link(
        "rgbd_laser_link",
        "rgbd_laser_joint",
        "base_footprint",
        xyz=(-0.9, 0, 0),
        mass=0.0001,
        inertia=(0.0001, 0.0001, 0.0001),
    )
