"""The proof finds what it is for: state that no snapshot holds, of every kind that there is."""

from __future__ import annotations

from typing import Any, ClassVar

import proof
from proof_lab import lab

import simkit
from simkit.plugins import ModelPlugin


class Forgetful(ModelPlugin):
    """Keeps what it does outside of its attributes."""

    steps: ClassVar = [0]

    def load(self, parent: Any, params: Any) -> None:
        self.link = parent.link("base")

    def before_step(self) -> None:
        self.steps[0] += 1
        self.link.apply_wrench((0.001 * self.steps[0], 0, 0))


class Faithful(Forgetful):
    """The same, kept in an attribute of its own."""

    def load(self, parent: Any, params: Any) -> None:
        super().load(parent, params)
        self.steps = [0]


def ways(plugin: ModelPlugin) -> dict[str, list[str]]:
    with simkit.load(lab(), plugins=[("car", plugin)]) as sim:
        return proof.proven(sim)[0]


def test_state_outside_of_a_plugins_attributes_is_found_on_every_way_back() -> None:
    found = ways(Forgetful())
    assert len(found) == 4
    assert all("the physics" in what for what in found.values())


def test_state_in_attributes_comes_back() -> None:
    assert ways(Faithful()) == {}
