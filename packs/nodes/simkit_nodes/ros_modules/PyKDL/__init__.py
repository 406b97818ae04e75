"""Frames, rotations and kinematic chains, as the package `PyKDL` of orocos_kinematics_dynamics."""

from __future__ import annotations

from simkit_nodes.ros_modules.PyKDL import chains, frame_functions, frames, solvers
from simkit_nodes.ros_modules.PyKDL.chains import *  # noqa: F403 - the package has the same names
from simkit_nodes.ros_modules.PyKDL.frame_functions import *  # noqa: F403
from simkit_nodes.ros_modules.PyKDL.frames import *  # noqa: F403
from simkit_nodes.ros_modules.PyKDL.solvers import *  # noqa: F403

__all__ = [*chains.__all__, *frame_functions.__all__, *frames.__all__, *solvers.__all__]
