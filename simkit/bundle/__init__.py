"""Bundles: a run in one file, to be repeated elsewhere bit for bit.

with simkit.bundle.keep(sim, "bundles"):  # written where something is raised within
    sim.run(10.0)

simkit.bundle.write_bundle(sim, "run.zip")  # or at any time
simkit.bundle.replay("run.zip").is_same
"""

from __future__ import annotations

from simkit.bundle.archive import Bundle, open_bundle
from simkit.bundle.keeping import Keeper, keep, write_bundle
from simkit.bundle.replaying import Replayed, replay

__all__ = ["Bundle", "Keeper", "Replayed", "keep", "open_bundle", "replay", "write_bundle"]
