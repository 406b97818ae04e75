"""Mecanum, Ackermann and slipping wheels."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import INERTIAL, model, python

_BALL = "<collision name='c'><geometry><sphere><radius>0.1</radius></sphere></geometry></collision>"


def _wheel(name: str, collision: str = _BALL, kind: str = "continuous") -> str:
    return (
        f'<link name="{name}">{INERTIAL}{collision}</link>\n'
        f'<joint name="{name}_joint" type="{kind}"><parent>base</parent><child>{name}</child></joint>'
    )


def _base(plugin: str, *wheels: str) -> str:
    return "\n".join((f'<link name="base">{INERTIAL}</link>', *wheels, plugin))


_MECANUM = """<plugin filename="gz-sim-mecanum-drive-system" name="gz::sim::systems::MecanumDrive">
  <front_left_joint>a_joint</front_left_joint><front_right_joint>b_joint</front_right_joint>
  <back_left_joint>c_joint</back_left_joint><back_right_joint>d_joint</back_right_joint>
</plugin>"""
_SLIP = """<plugin filename="gz-sim-wheel-slip-system" name="gz::sim::systems::WheelSlip">
  <wheel link_name="a"><wheel_normal_force>30</wheel_normal_force><wheel_radius>0.1</wheel_radius></wheel>
</plugin>"""
_TWICE = _SLIP.replace("</plugin>", "  " + _SLIP.splitlines()[1].strip() + "\n</plugin>")
_CAR_JOINTS = ("front_left", "front_right", "rear_left", "rear_right")
_CAR = """<plugin filename="libgazebo_ros_ackermann_drive.so" name="drive"/>"""

_RUBS = "<surface><friction><ode><mu>1</mu><mu2>0.1</mu2><fdir1{}>1 0 0</fdir1></ode></friction></surface>"
_BOX = "<collision name='c'><geometry><box><size>0.1 0.1 0.1</size></box></geometry>{}</collision>"
_YARD = """<mujoco><option integrator="discrete"/><worldbody><geom type="plane" size="5 5 1"/></worldbody></mujoco>"""


def _directed(frame: str = "") -> str:
    return f'<link name="base">{INERTIAL}{_BOX.format(_RUBS.format(frame))}</link>'


_SPAWNS = f"import simkit\nsim = simkit.load('yard.xml')\nsim.spawn('''{model(_directed()).text}''')\n"

CODES: tuple[Code, ...] = (
    Code(
        "SK-SDF-040",
        "warning",
        "`<fdir1>` is told in a frame that is not there; the collision's own is used",
        "the closest name is given; a frame is a link, joint, frame or model of the same model",
        model(_directed(' gz:expressed_in="bse"')),
    ),
    Code(
        "SK-PHYS-030",
        "warning",
        "direction and slip of friction, or a surface that runs, in a world whose MJCF file asks for `discrete`",
        "the discrete integrator has no place between velocities and forces; the other integrators have one",
        python(_SPAWNS, {"yard.xml": _YARD}),
    ),
    Code(
        "SK-PLUGIN-090",
        "warning",
        "wheels of a mecanum drive hold in every direction: they have no rollers, the base only drags sideways",
        'give their collisions `<mu>1</mu><mu2>0</mu2>` and `<fdir1 gz:expressed_in="…">`',
        model(_base(_MECANUM, *map(_wheel, "abcd"))),
    ),
    Code(
        "SK-PLUGIN-091",
        "error",
        "a wheel that is to slip has not one collision, or does not turn on one joint",
        "",
        model(_base(_SLIP, _wheel("a", kind="fixed"))),
    ),
    Code(
        "SK-PLUGIN-092",
        "error",
        "a link has two `<wheel>` blocks in one wheel slip plugin",
        "",
        model(_base(_TWICE, _wheel("a"))),
    ),
    Code(
        "SK-PLUGIN-093",
        "error",
        "a drive measures the wheels of a car, and cannot: a collision is missing, or the rear one is no cylinder or "
        "sphere",
        "",
        model(
            _base(
                _CAR,
                *(_wheel(name, "") for name in _CAR_JOINTS),
                *(_wheel(f"{side}_steering") for side in ("left", "right")),
            )
        ),
    ),
)
