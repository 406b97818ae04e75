"""Physics lint: what of a sound file will most likely make trouble, told before the first step.

Every finding names the numbers it was made from. It is part of `simkit check` and of nothing else: a world that loads
is run as it is written.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from simkit.diagnostics import Diagnostics

if TYPE_CHECKING:
    from simkit.runtime import Simulation

__all__ = ["lint"]


def lint(sim: Simulation) -> Diagnostics:
    """What is likely to go wrong with a loaded world; nothing is stepped and nothing is changed."""
    from simkit.compiler.lint import joints, links, time_step

    found = Diagnostics()
    for look in (time_step.look, joints.look, links.look):
        look(sim, found)
    return found
