"""Who drives what left the numbers: plugins with a controller say what it did."""

from __future__ import annotations

from typing import TYPE_CHECKING

from simkit.errors import SimulationDiverged

if TYPE_CHECKING:
    from simkit.runtime.simulation import Simulation

_MOST = 3


def name_drivers(sim: Simulation, error: SimulationDiverged) -> None:
    """Adds to the error what plugins have to do with it.

    Those are asked that have a method `explain_divergence(name) -> str`: with the joint where it happened, and where
    none of them drives that, with the model.
    """
    found = _explanations(sim, error.joint) or _explanations(sim, error.joint.split("::")[0])
    if found:
        more = "; ".join(found[:_MOST]) + (f"; and {len(found) - _MOST} more" if len(found) > _MOST else "")
        error.hint = f"{error.hint}; {more}"
        error.args = (f"{error.args[0]}; {more}",)


def _explanations(sim: Simulation, name: str) -> list[str]:
    asked = (getattr(plugin, "explain_divergence", None) for plugin in sim.structure.all_plugins())
    return [text for explain in asked if explain is not None and (text := explain(name))]
