"""Bundles: a run in one file, to be repeated elsewhere bit for bit.

A running simulation enters, a file with its world, its inputs and its last seconds leaves; a file enters, the result of
its replay leaves. A bundle may come from anywhere: it is checked as a whole before anything of it is used, and code in
it runs only where that is allowed.

with simkit.testing.bundles.keep(sim, "bundles"):  # written where something is raised within
    sim.run(10.0)

simkit.testing.bundles.write_bundle(sim, "run.zip")  # or at any time
simkit.testing.bundles.replay("run.zip").is_same
"""

from __future__ import annotations

from simkit.testing.bundles.archive import Bundle, open_bundle
from simkit.testing.bundles.bundle_recorder import BundleRecorder
from simkit.testing.bundles.bundle_replay import ReplayResult, replay
from simkit.testing.bundles.bundle_writer import keep, write_bundle

__all__ = ["Bundle", "BundleRecorder", "ReplayResult", "keep", "open_bundle", "replay", "write_bundle"]
