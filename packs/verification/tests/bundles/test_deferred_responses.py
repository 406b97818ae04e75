"""A replay gives the later responses of a script's services, without the script."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import simkit
from simkit_verification.testing.bundles import keep, replay, write_bundle

BALL = """<sdf version="1.9"><world name="yard"><gravity>0 0 0</gravity>
<model name="ball"><link name="l"/></model></world></sdf>"""


def test_a_run_with_later_responses_is_repeated_without_the_script(tmp_path: Path) -> None:
    path = tmp_path / "yard.sdf"
    path.write_text(BALL)
    waiting: list[simkit.DeferredResponse] = []

    def add(request: Any) -> simkit.DeferredResponse:
        waiting.append(simkit.DeferredResponse())
        return waiting[-1]

    with simkit.load(path) as sim, keep(sim):

        def move(call: Any) -> None:
            sim.model("ball").set_velocity((0.1 * call.response.sum, 0.0, 0.0), (0.0, 0.0, 0.0))

        sim.offer("/add", "example_interfaces/srv/AddTwoInts", add)
        sim.call("/add", {"a": 1, "b": 2}, on_done=move)
        sim.step(10)
        waiting[0].respond({"sum": 3})
        sim.step(10)
        call = sim.communication.services.request("/add", {"a": 4})  # as a client of the live socket does
        sim.step(5)
        waiting[1].respond({"sum": 4})
        assert call.response.sum == 4
        sim.step(10)
        assert sim.model("ball").pose.position[0] > 0.0
        bundle = write_bundle(sim, tmp_path / "run.zip")
    found = replay(bundle)
    assert found.is_same, (found.differences, found.refused)
    assert not found.refused
