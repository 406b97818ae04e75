"""What TIAGo carries on its base: the column with the lifting torso, the head and its RGB-D camera."""

from __future__ import annotations

from parts import (
    BLACK,
    DARK,
    GLASS,
    LIGHT,
    QUARTER,
    WHITE,
    Collision,
    Contact,
    Limit,
    Link,
    Sensor,
    box,
    cylinder,
    drawn,
)

SKIN = Contact(0.9)
OPTICAL = (-QUARTER, 0, -QUARTER)
CAMERA = "head_front_camera"


def torso(arm: bool) -> tuple[Link, ...]:
    """Foot, column and lifting part, with or without the bracket that holds the arm."""
    bracket = (Collision("bracket", cylinder(0.05, 0.08), (0.15505, 0.014, -0.216)),) if arm else ()
    bracket_drawn = (("bracket", "arm_bracket", WHITE),) if arm else ()
    foot = Link(
        "torso_fixed_link",
        "torso_fixed_joint",
        "base_link",
        xyz=(-0.062, 0, 0.193),
        mass=14.0136,
        inertia=(0.383411, 0.405773, 0.076998, 0.000364, -0.024389, -0.000782),
        centre=(0.02435, -0.00464, 0.159),
        collisions=(
            Collision("tray", box(0.4, 0.25, 0.04), (0.085, 0, 0.02)),
            Collision("foot", box(0.25, 0.25, 0.1), (0, 0, 0.05)),
        ),
        visuals=drawn(("foot", "torso_foot", LIGHT)),
        about="The foot of the column, with the tray before it.",
    )
    column = Link(
        "torso_fixed_column_link",
        "torso_fixed_column_joint",
        "base_link",
        xyz=(-0.062, 0, 0.195),
        mass=0.01,
        inertia=(1e-6, 1e-6, 1e-6),
        collisions=(Collision("column", box(0.16, 0.20, 0.55), (0, 0, 0.275)),),
        visuals=drawn(("column", "torso_column", DARK)),
        about="The column that the torso slides on.",
    )
    lift = Link(
        "torso_lift_link",
        "torso_lift_joint",
        foot.name,
        "prismatic",
        (0, 0, 0.597),
        limit=Limit(2000, 0.07, 0, 0.35),
        damping=1000,
        mass=6.93198,
        inertia=(0.24487, 0.249269, 0.090395, -0.001456, -0.009742, 0.008281),
        centre=(0.04361, -0.00116, -0.17334),
        collisions=(
            Collision("waist", box(0.216, 0.252, 0.317), (-0.014, 0, -0.3085)),
            Collision("shoulders", box(0.260, 0.330, 0.150), (-0.033, 0, -0.075)),
            Collision("shelf", box(0.140, 0.164, 0.075), (0.167, 0, -0.0375)),
            *bracket,
        ),
        visuals=drawn(("shell", "torso_shell", WHITE), ("trim", "torso_trim", DARK), *bracket_drawn),
        about="The lifting torso; the origin lies at its top, above the column.",
    )
    return foot, column, lift


def head() -> tuple[Link, ...]:
    neck = Link(
        "head_1_link",
        "head_1_joint",
        "torso_lift_link",
        "revolute",
        (0.182, 0, 0),
        limit=Limit(5.197, 3, -1.3089969389957472, 1.3089969389957472, 0.07),
        damping=0.5,
        friction=1,
        mass=0.6222,
        inertia=(0.001192, 0.001402, 0.000889, -7e-6, 9.6e-5, 4e-6),
        centre=(-0.00508, 0.00237, 0.07229),
        contact=SKIN,
        collisions=(Collision("neck", cylinder(0.043, 0.12), (0, 0, 0.064)),),
        visuals=drawn(("neck", "neck_shell", WHITE)),
        about="The neck pans about the vertical.",
    )
    skull = Link(
        "head_2_link",
        "head_2_joint",
        neck.name,
        "revolute",
        (0.005, 0, 0.098),
        (QUARTER, 0, 0),
        limit=Limit(2.77, 3, -1.0471975511965976, 0.7853981633974483, 0.07),
        damping=0.5,
        friction=1,
        mass=0.66123,
        inertia=(0.00462, 0.004861, 0.003132, 0.000689, 6e-6, 6e-6),
        centre=(0.047, 0.05542, 0.00022),
        collisions=(Collision("skull", box(0.165, 0.12, 0.26), (0.015, 0.062, 0)),),
        visuals=drawn(("shell", "head_shell", WHITE), ("visor", "head_visor", BLACK), ("lenses", "head_lenses", GLASS)),
        about="The head tilts: x forward, y up, z to the right.",
    )
    return neck, skull, *camera()


def frame(name: str, joint: str, parent: str, xyz: tuple[float, float, float], optical: bool = False) -> Link:
    """A frame of the camera; the published description gives each a gram."""
    return Link(
        f"{CAMERA}_{name}",
        f"{CAMERA}_{joint}_joint",
        f"{CAMERA}_{parent}",
        xyz=xyz,
        rpy=OPTICAL if optical else (0, 0, 0),
        mass=0.001,
        inertia=(1e-5, 1e-5, 1e-5),
    )


def camera() -> tuple[Link, ...]:
    """The RGB-D camera's frames; the colour image, depth and points come from the colour lens."""
    mount = Link(
        f"{CAMERA}_link",
        f"{CAMERA}_joint",
        "head_2_link",
        xyz=(0.0908, 0.08, 0),
        rpy=(-QUARTER, 0, 0),
        mass=0.2197,
        inertia=(4.29247e-6, 8.027e-8, 4.27339e-6, 0, 2.565e-8, 0),
        centre=(-0.00936, -0.00003, -0.00273),
        about="Orbbec Astra: x forward, y to the left, z up.",
    )
    small = "".join(f"<{name}>1e-8</{name}>" for name in ("k1", "k2", "k3", "p1", "p2"))
    remapped = (
        ("image_raw", "rgb/image_raw"),
        ("camera_info", "rgb/camera_info"),
        ("depth/image_raw", "depth_registered/image_raw"),
        ("depth/camera_info", "depth_registered/camera_info"),
        ("points", "depth_registered/points"),
    )
    lines = (
        "<camera>",
        "  <horizontal_fov>1.0995574287564276</horizontal_fov>",
        "  <image><format>B8G8R8</format><width>640</width><height>480</height></image>",
        "  <clip><near>0.3</near><far>8</far></clip>",
        f"  <distortion>{small}</distortion>",
        "</camera>",
        f'<plugin name="{CAMERA}_frame_controller" filename="libgazebo_ros_camera.so">',
        f"  <camera_name>{CAMERA}</camera_name>",
        "  <ros>",
        *(f"    <remapping>{CAMERA}/{ours}:={CAMERA}/{theirs}</remapping>" for ours, theirs in remapped),
        "  </ros>",
        f"  <frame_name>{CAMERA}_rgb_optical_frame</frame_name>",
        "  <min_depth>0.3</min_depth>",
        "  <max_depth>8</max_depth>",
        "</plugin>",
    )
    colour = Link(
        f"{CAMERA}_rgb_frame",
        f"{CAMERA}_rgb_joint",
        f"{CAMERA}_orbbec_aux_joint_frame",
        xyz=(0, 0.022, 0),
        mass=0.001,
        inertia=(1e-5, 1e-5, 1e-5),
        sensors=(Sensor(f"{CAMERA}_frame_sensor", "depth", 30, lines),),
        about="The colour lens looks along x.",
    )
    return (
        mount,
        frame("optical_frame", "optical", "link", (0, 0, 0), optical=True),
        frame("orbbec_aux_joint_frame", "orbbec_aux", "link", (0, 0, 0)),
        colour,
        frame("rgb_optical_frame", "rgb_optical", "rgb_frame", (0, 0, 0), optical=True),
        frame("depth_frame", "depth", "rgb_frame", (0, 0.025, 0)),
        frame("depth_optical_frame", "depth_optical", "depth_frame", (0, 0, 0), optical=True),
    )
