"""What each element and attribute of URDF becomes: the table that the documentation prints and a test holds.

A path is element names from `<robot>` down, `@name` an attribute. `gazebo[link]`, `gazebo[joint]` and `gazebo[robot]`
are the extensions whose reference names a link, a joint, or nothing.
"""

from __future__ import annotations

_ORIGIN = (
    ("@xyz", "position [m]"),
    ("@rpy", "fixed-axis roll, pitch, yaw [rad]"),
    ("@quat_xyzw", "rotation as a quaternion (URDF 1.2); it replaces rpy"),
)
_GEOMETRY = (
    ("box@size", "box, edge lengths [m]"),
    ("cylinder@radius", "cylinder along z, radius [m]"),
    ("cylinder@length", "cylinder along z, length [m]"),
    ("sphere@radius", "sphere, radius [m]"),
    ("capsule@radius", "capsule along z, radius [m]"),
    ("capsule@length", "capsule along z, length without the caps [m]"),
    ("mesh@filename", "mesh file: package://, model://, file:// or a path"),
    ("mesh@scale", "scale of the mesh; negative mirrors it"),
)
_MATERIAL = (
    ("@name", "name of the material"),
    ("color@rgba", "ambient and diffuse colour, 0 to 1"),
    ("texture@filename", "colour texture"),
)
_END = (
    ("@name", "name"),
    ("mechanicalReduction", "actuator position over joint position"),
    ("hardwareInterface", "hardware interface, as written"),
    ("role", "role of the end"),
    ("@role", "role of the end"),
    ("offset", "offset of the joint [rad or m]"),
)
_AS_SDF = "as in an SDF file"


def _below(path: str, rows: tuple[tuple[str, str], ...]) -> tuple[tuple[str, str], ...]:
    return tuple((path + ("" if name.startswith("@") else "/") + name, becomes) for name, becomes in rows)


_ROBOT = (
    ("robot@name", "name of the model"),
    *_below("robot/material", _MATERIAL),
    ("robot/ros2_control", "kept as it is, for plugins (`SceneModel.controls`)"),
)
_LINK = (
    ("robot/link@name", "name of the link"),
    *_below("robot/link/inertial/origin", _ORIGIN),
    ("robot/link/inertial/mass@value", "mass [kg]"),
    *_below(
        "robot/link/inertial/inertia",
        tuple((f"@{k}", "about the centre of mass [kg m2]") for k in ("ixx", "iyy", "izz")),
    ),
    *_below(
        "robot/link/inertial/inertia",
        tuple((f"@{k}", "product of inertia [kg m2], 0 where absent") for k in ("ixy", "ixz", "iyz")),
    ),
    ("robot/link/collision@name", "name of the collision; without one `<link>_collision`, `<link>_collision_1`, ..."),
    ("robot/link/collision@group", "read and without effect, as in Gazebo"),
    *_below("robot/link/collision/origin", _ORIGIN),
    *_below("robot/link/collision/geometry", _GEOMETRY),
    ("robot/link/visual@name", "name of the visual; without one `<link>_visual`, `<link>_visual_1`, ..."),
    *_below("robot/link/visual/origin", _ORIGIN),
    *_below("robot/link/visual/geometry", _GEOMETRY),
    *_below("robot/link/visual/material", _MATERIAL),
)
_JOINT = (
    ("robot/joint@name", "name of the joint"),
    ("robot/joint@type", "revolute, continuous, prismatic, fixed, floating or planar"),
    *_below("robot/joint/origin", _ORIGIN),
    ("robot/joint/parent@link", "parent link"),
    ("robot/joint/child@link", "child link"),
    ("robot/joint/axis@xyz", "axis in the joint frame, `1 0 0` where absent; of a planar joint the normal"),
    ("robot/joint/limit@lower", "lower position limit [rad or m]"),
    ("robot/joint/limit@upper", "upper position limit [rad or m]"),
    ("robot/joint/limit@effort", "effort limit [N m or N]; negative is none"),
    ("robot/joint/limit@velocity", "velocity limit [rad/s or m/s]; negative or 0 is none"),
    ("robot/joint/dynamics@damping", "viscous damping"),
    ("robot/joint/dynamics@friction", "dry friction"),
    ("robot/joint/mimic@joint", "the joint that it follows"),
    ("robot/joint/mimic@multiplier", "position = multiplier * leader + offset"),
    ("robot/joint/mimic@offset", "position = multiplier * leader + offset"),
    ("robot/joint/safety_controller@soft_lower_limit", "kept for controllers; the physics ignores it"),
    ("robot/joint/safety_controller@soft_upper_limit", "kept for controllers; the physics ignores it"),
    ("robot/joint/safety_controller@k_position", "kept for controllers; the physics ignores it"),
    ("robot/joint/safety_controller@k_velocity", "kept for controllers; the physics ignores it"),
    ("robot/joint/calibration@rising", "kept for controllers"),
    ("robot/joint/calibration@falling", "kept for controllers"),
    ("robot/joint/calibration@reference_position", "older spelling of rising"),
)
_TRANSMISSION = (
    ("robot/transmission@name", "name of the transmission"),
    ("robot/transmission@type", "older spelling of <type>"),
    ("robot/transmission/type", "simple, differential or four-bar linkage, by its class name"),
    ("robot/transmission/mechanicalReduction", "of the actuators that have none of their own"),
    *_below("robot/transmission/joint", _END),
    *_below("robot/transmission/actuator", _END),
)
_GAZEBO = (
    ("robot/gazebo@reference", "the link or joint that the block speaks of; none: the robot"),
    *(
        (f"robot/gazebo[link]/{name}", becomes)
        for name, becomes in (
            ("sensor", f"sensor on the link, {_AS_SDF}"),
            ("light", f"light on the link, {_AS_SDF}"),
            ("plugin", f"plugin, {_AS_SDF}"),
            ("material", "name of a Gazebo material, or <material> as in SDF, for every visual of the link"),
            ("visual", f"material, transparency, cast_shadows, visibility_flags, laser_retro, plugin, {_AS_SDF}"),
            ("collision", f"surface, {_AS_SDF}"),
            ("mu1", "friction along fdir1, for every collision of the link"),
            ("mu2", "friction across fdir1"),
            ("fdir1", "first friction direction, in the collision's frame"),
            ("kp", "contact stiffness [N/m]"),
            ("kd", "contact damping [N s/m]"),
            ("minDepth", "depth that is tolerated before contact [m]"),
            ("maxVel", "largest correcting velocity of a contact [m/s]"),
            ("softCfm", "constraint softness of a contact"),
            ("softErp", "error reduction of a contact"),
            ("laserRetro", "brightness to lidars, of every collision and visual"),
            ("selfCollide", "whether the link touches others of its robot"),
            ("self_collide", "the same in SDF's words"),
            ("turnGravityOff", "true: the link is not pulled by gravity"),
            ("gravity", "the same in SDF's words"),
            ("kinematic", _AS_SDF),
            ("enable_wind", _AS_SDF),
            ("dampingFactor", "velocity decay, linear and angular"),
            ("velocity_decay", _AS_SDF),
        )
    ),
    *(
        (f"robot/gazebo[joint]/{name}", becomes)
        for name, becomes in (
            ("sensor", f"sensor on the joint, {_AS_SDF}"),
            ("plugin", f"plugin, {_AS_SDF}"),
            ("springStiffness", "spring stiffness"),
            ("springReference", "where the spring rests [rad or m]"),
            ("preserveFixedJoint", "always so here: no link is lumped into another"),
            ("disableFixedJointLumping", "always so here: no link is lumped into another"),
        )
    ),
    *(
        (f"robot/gazebo[robot]/{name}", becomes)
        for name, becomes in (
            ("plugin", f"plugin of the model, {_AS_SDF}"),
            ("static", "whether the robot is static"),
            ("pose", "where the robot stands"),
            ("self_collide", "whether its links touch one another"),
            ("selfCollide", "the same"),
            ("allow_auto_disable", _AS_SDF),
            ("enable_wind", _AS_SDF),
            ("link", f"one more link, {_AS_SDF}"),
            ("joint", f"one more joint, {_AS_SDF}: closes loops, or has a type that URDF lacks"),
            ("frame", f"frame, {_AS_SDF}"),
        )
    ),
)

ELEMENTS: tuple[tuple[str, str], ...] = (*_ROBOT, *_LINK, *_JOINT, *_TRANSMISSION, *_GAZEBO)
"""(path, what it becomes)."""
