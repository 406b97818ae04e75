"""Bundles: a run in one file, to be repeated elsewhere bit for bit.

with simkit.testing.bundles.keep(sim, "bundles"):  # written where something is raised within
    sim.run(10.0)

simkit.testing.bundles.write_bundle(sim, "run.zip")  # or at any time
simkit.testing.bundles.replay("run.zip").is_same
"""

from __future__ import annotations

from simkit.testing.bundles.archive import Bundle, open_bundle
from simkit.testing.bundles.bundle_recorder import BundleRecorder, keep, write_bundle
from simkit.testing.bundles.bundle_replay import ReplayResult, replay

__all__ = ["Bundle", "BundleRecorder", "ReplayResult", "keep", "open_bundle", "replay", "write_bundle"]
