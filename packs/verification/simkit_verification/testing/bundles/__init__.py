"""Bundles: one file holds a run, and another machine can repeat this run bit for bit.

A bundle is written from a running simulation. It holds the world, the inputs and the last seconds of messages. A replay
reads a bundle, repeats the run and compares the result. A bundle may come from an untrusted source. Therefore the whole
archive is validated before any file in it is used. Python code in a bundle runs only if the caller allows it.

with simkit_verification.testing.bundles.keep(sim, "bundles"):  # an exception in this block writes a bundle
    sim.run(10.0)

simkit_verification.testing.bundles.write_bundle(sim, "run.zip")  # or at any time
simkit_verification.testing.bundles.replay("run.zip").is_same
"""

from __future__ import annotations

from simkit_verification.testing.bundles.archive import Bundle, open_bundle
from simkit_verification.testing.bundles.bundle_recorder import BundleRecorder
from simkit_verification.testing.bundles.bundle_replay import ReplayResult, replay, replay_until
from simkit_verification.testing.bundles.bundle_writer import keep, write_bundle

__all__ = ["Bundle", "BundleRecorder", "ReplayResult", "keep", "open_bundle", "replay", "replay_until", "write_bundle"]
