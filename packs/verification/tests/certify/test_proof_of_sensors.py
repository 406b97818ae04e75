"""Every noisy sensor of simkit gives the same bits after a restore and after a reset."""

from __future__ import annotations

import contract_worlds
import proof
import pytest

import simkit
from simkit.packs import is_shipped
from simkit.sensors import sensor_kinds

pytestmark = pytest.mark.slow  # slow: processes and complete runs

KINDS = [kind for kind, cls in sensor_kinds().items() if is_shipped(cls)]


def thrown(sim: simkit.Simulation) -> None:
    sim.model("m").set_velocity((0.5, 0.2, -1.0), (1.0, -0.5, 0.7))


@pytest.mark.parametrize("kind", KINDS)
def test_a_run_with_the_sensor_repeats_after_restore_and_reset(kind: str) -> None:
    with simkit.load(contract_worlds.source(kind, noisy=True), seed=5) as sim:
        found, (before, first) = proof.proven(sim, 90, thrown)
        assert not found
        topics = set(contract_worlds.sensor_of(sim)._topics.values())
        assert topics & {topic for _, topic, _ in first.messages}, "it said nothing"
        assert before.readings != first.readings or kind in ("boundingbox", "boundingbox_camera", "segmentation")
