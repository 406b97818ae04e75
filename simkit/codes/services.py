"""Services of a world, and what they do to it."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import python

_MJCF = '<mujoco model="ball"><worldbody><body name="ball"><freejoint/><geom size="0.1"/></body></worldbody></mujoco>'
_ARM = (
    '<sdf version="1.9"><model name="arm"><link name="base"/><link name="tip"/>'
    '<joint name="hinge" type="revolute"><parent>base</parent><child>tip</child><axis><xyz>0 0 1</xyz></axis></joint>'
    "</model></sdf>"
)

CODES: tuple[Code, ...] = (
    Code(
        "SK-SERVICE-002",
        "error",
        "a model in MuJoCo's own format cannot be copied: its parts have names of their own",
        "spawn its file again, under another name",
        python('import simkit\nsim = simkit.load("ball.xml")\nsim.clone("ball", "copy")\n', {"ball.xml": _MJCF}),
    ),
    Code(
        "SK-SERVICE-003",
        "error",
        "a link that joints or the world hold cannot be set somewhere by itself",
        "move its model, or set its joints",
        python(
            'import simkit\nsim = simkit.load("arm.sdf")\nsim.link("arm::tip").set_pose(simkit.Pose((0, 0, 1)))\n',
            {"arm.sdf": _ARM},
        ),
    ),
)
