"""The proof detects every kind of state that a snapshot does not contain."""

from __future__ import annotations

from typing import Any, ClassVar

import proof
from proof_lab import lab

import simkit
from simkit.plugins import ModelPlugin


class Forgetful(ModelPlugin):
    """Plugin whose state is outside its attributes."""

    steps: ClassVar = [0]

    def load(self, parent: Any, params: Any) -> None:
        self.link = parent.link("base")

    def before_step(self) -> None:
        self.steps[0] += 1
        self.link.apply_wrench((0.001 * self.steps[0], 0, 0))


class Faithful(Forgetful):
    """Plugin with the same state in an attribute."""

    def load(self, parent: Any, params: Any) -> None:
        super().load(parent, params)
        self.steps = [0]


def ways(plugin: ModelPlugin) -> dict[str, list[str]]:
    with simkit.load(lab(), plugins=[("car", plugin)]) as sim:
        return proof.proven(sim)[0]


def test_state_outside_of_attributes_is_found_after_snapshot_and_reset() -> None:
    found = ways(Forgetful())
    assert len(found) == 4
    assert all("the physics" in what for what in found.values())


def test_state_in_attributes_is_restored() -> None:
    assert ways(Faithful()) == {}
