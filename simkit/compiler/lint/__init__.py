"""Lint of a compiled world: reports probable problems before the first step.

The input is a scene and its compiled model, the output is diagnostics; nothing is stepped or changed. Every message
contains the numbers that caused it. Only `simkit check` uses the lint; loading a world does not.
"""

from __future__ import annotations

from simkit.compiler.lint.joints import check_joints
from simkit.compiler.lint.links import check_links
from simkit.compiler.lint.surfaces import check_surfaces
from simkit.compiler.lint.time_step import check_time_step
from simkit.compiler.spec_builder import Compiled
from simkit.diagnostics import Diagnostics
from simkit.scene import SceneWorld

__all__ = ["lint_world"]


def lint_world(world: SceneWorld, compiled: Compiled) -> Diagnostics:
    """Report probable problems of a world; nothing is stepped or changed."""
    diagnostics = Diagnostics()
    for check in (check_time_step, check_joints, check_links, check_surfaces):
        check(world, compiled, diagnostics)
    return diagnostics
