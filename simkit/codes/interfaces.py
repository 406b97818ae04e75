"""Services, actions and live parameters."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import BALL, python

_FILES = {"ball.sdf": BALL}

CODES: tuple[Code, ...] = (
    Code(
        "SK-SERVICE-001",
        "error",
        "no service of that name, or one is there already",
        "the closest name, or those there are",
        python('import simkit\nsim = simkit.load("ball.sdf")\nsim.call("/robot/home")\n', _FILES),
    ),
    Code(
        "SK-ACTION-001",
        "error",
        "no action of that name, one is there already, or a goal has ended already",
        "the closest name, or those there are",
        python('import simkit\nsim = simkit.load("ball.sdf")\nsim.send_goal("/arm/follow_joint_trajectory")\n', _FILES),
    ),
    Code(
        "SK-PARAMETER-001",
        "error",
        "no live parameter of that name, or a value that it does not take",
        "the closest name, or what is allowed",
        python('import simkit\nsim = simkit.load("ball.sdf")\nsim.set_parameter("/pid", "p_gain", 3.0)\n', _FILES),
    ),
)
