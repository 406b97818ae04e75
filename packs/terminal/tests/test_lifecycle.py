"""`simkit lifecycle`: lifecycle nodes, their states and transitions."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

import pytest

from simkit.lifecycle import LifecycleNode


class Camera:
    """Cannot be activated."""

    def on_activate(self, _: str) -> bool:
        return False


@pytest.fixture
def line(start: Callable[..., Any], simkit_line: Callable[..., Any]) -> Callable[..., Any]:
    live = start("yard", paused=True)
    for name in ("/camera", "/lidar"):
        LifecycleNode(live.sim, name, Camera())
    return lambda *words: simkit_line("lifecycle", *words)


def test_nodes_and_their_states_are_listed(line: Callable[..., Any]) -> None:
    assert line("nodes").stdout == "/camera\n/lidar\n"
    assert line("nodes", "-c").stdout == "2\n"
    assert line("get").stdout == "/camera: unconfigured [1]\n/lidar: unconfigured [1]\n"
    assert line("get", "lidar").stdout == "unconfigured [1]\n"
    assert json.loads(line("get", "--json").stdout)["/lidar"] == {"id": 1, "label": "unconfigured"}
    found = line("get", "/camra")
    assert found.exit_code == 2
    assert "SK-CLI-034 no lifecycle node '/camra' in the simulation 'yard'; did you mean '/camera'?" in found.stderr


def test_transitions_are_listed_and_made(line: Callable[..., Any]) -> None:
    text = "- configure [1]\n\tStart: unconfigured\n\tGoal: configuring\n"
    assert line("list", "/camera").stdout == f"{text}- shutdown [5]\n\tStart: unconfigured\n\tGoal: shuttingdown\n"
    assert len(json.loads(line("list", "/camera", "-a", "--json").stdout)) == 25
    found = line("set", "/camera", "activate")
    assert found.exit_code == 2
    assert "'activate' of /camera in the state 'unconfigured'; possible: configure [1], shutdown [5]" in found.stderr
    assert line("set", "/camera", "configure").stdout == "Transitioning successful\n"
    found = line("set", "/camera", "3")
    assert (found.exit_code, found.stdout, found.stderr) == (2, "", "Transitioning failed\n")
    assert json.loads(line("set", "/camera", "cleanup", "--json").stdout) == {"successful": True}
    assert line("get").stdout == "/camera: unconfigured [1]\n/lidar: unconfigured [1]\n"
