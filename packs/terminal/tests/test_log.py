"""`simkit log`: log messages of a running simulation and of a bag."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest

import simkit
from simkit.recording import Recorder


@pytest.mark.slow
def test_messages_of_a_running_simulation_are_selected_by_level_node_and_text(start: Any, simkit_line: Any) -> None:
    log = start().sim.engine.structure.all_plugins()[-1].log
    node = log._owner.name
    log.warning("low battery")
    log.error("motor %d is hot", 2)
    told = simkit_line("log", "--timeout", "0.5").stdout
    assert re.search(rf"\[WARN\] \[\d+\.\d{{9}}\] \[{node}\]: low battery\n", told) and "motor 2 is hot" in told
    options = ("--level", "error", "--node", f"/{node[:3]}*", "--timeout", "0.5", "--json")
    found = json.loads(simkit_line("log", "yard", *options).stdout)
    assert (found["level"], found["name"], found["message"]) == ("ERROR", node, "motor 2 is hot")
    assert found["file"] == __file__ and found["line"] > 0 and found["function"].startswith("test_messages_of_a_run")
    assert simkit_line("log", "--filter", "battery$", "--timeout", "0.5").stdout.count("\n") == 1
    assert simkit_line("log", "--node", "/nobody", "--timeout", "0.1").stdout == ""


def test_messages_of_a_bag_are_printed_to_the_end(tmp_path: Path, simkit_line: Any) -> None:
    bag = tmp_path / "log.mcap"
    with simkit.load('<sdf version="1.9"><world name="w"/></sdf>') as sim, Recorder(sim, bag, topics=["/rosout"]):
        sim.step(5)
        sim.engine.log.error("the end")
        sim.step()
    assert simkit_line("log", "--bag", str(bag)).stdout == "[ERROR] [0.005000000] [simkit]: the end\n"


def test_a_wrong_level_and_a_wrong_pattern_are_refused(simkit_line: Any) -> None:
    level, pattern = simkit_line("log", "--level", "eror"), simkit_line("log", "--filter", "(")
    assert level.exit_code == pattern.exit_code == 2
    assert "SK-CLI-018" in level.stderr and "did you mean 'error'?" in level.stderr
    assert "SK-CLI-033" in pattern.stderr
