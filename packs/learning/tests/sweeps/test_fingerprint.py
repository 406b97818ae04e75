"""Fingerprints of sweeps: a sweep that an earlier version has stored continues."""

from __future__ import annotations

from dataclasses import field, make_dataclass
from pathlib import Path
from typing import Any, cast

import pytest
from sweep_worlds import BOX

from simkit import RunSpec
from simkit_learning.sweeps.design import Design
from simkit_learning.sweeps.plain_description import plain_description
from simkit_learning.sweeps.sweep_file import read_sweep
from simkit_learning.sweeps.sweep_spec import SweepSpec

SWEEP = """
world: box.sdf
duration: 0.02
set: ["box::l.inertial.mass={m}"]
spawn: turtlebot3:1,2,0:other
plugin_paths: [.]
tolerances: {/scan: {absolute: 0.1}}
goals: ["time > 0.01"]
until: time > 0.015
parameters: {m: [1, 2]}
seeds: 2
metrics: {z: pose('box').z, f: {python: metric.py:f}}
"""
STORED = "2b1eedd0894c8e9b6de7959581492965b547471b15c00fde9de10a3a89fa1c03"
"""Fingerprint that the version before packs has stored for this sweep."""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "box.sdf").write_text(BOX)
    (tmp_path / "metric.py").write_text("def f(sim):\n    return sim.time\n")
    (tmp_path / "sweep.yaml").write_text(SWEEP)
    return tmp_path


def test_a_sweep_of_the_version_before_packs_continues(folder: Path) -> None:
    assert read_sweep(folder / "sweep.yaml", allow_code=True).fingerprint() == STORED


def test_the_sweep_of_another_file_or_function_is_another_one(folder: Path) -> None:
    (folder / "metric.py").write_text("def f(sim):\n    return 0.0\n")
    assert read_sweep(folder / "sweep.yaml", allow_code=True).fingerprint() != STORED


def _fingerprint(run: RunSpec) -> str:
    return SweepSpec(run, Design(())).fingerprint()


def test_a_new_field_of_a_run_with_its_default_keeps_the_fingerprint() -> None:
    new_field = ("wait_for", Any, field(default_factory=list))
    later = cast(Any, make_dataclass("RunSpec", [new_field], bases=(RunSpec,), frozen=True))
    later.__module__ = RunSpec.__module__
    assert _fingerprint(later("w.sdf", duration=2.0)) == _fingerprint(RunSpec("w.sdf", duration=2.0))
    assert _fingerprint(later("w.sdf", wait_for=["/scan"])) != _fingerprint(RunSpec("w.sdf"))


def test_all_fields_of_a_dataclass_of_a_user_are_described() -> None:
    user = make_dataclass("RunSpec", [("speed", float, 1.0)])
    assert plain_description(user()) == {"type": "RunSpec", "speed": 1.0}


@pytest.mark.parametrize("module", ["simkit.plugins.world.map_server", "simkit_navigation.plugins.maps.map_server"])
def test_a_class_of_simkit_that_moved_to_a_pack_is_described_by_its_first_name(module: str) -> None:
    moved = type("MapServer", (), {"__module__": module})
    assert plain_description(moved) == "simkit.plugins.world.map_server.MapServer"
    assert plain_description(moved()) == ["a simkit.plugins.world.map_server.MapServer", [], {}]
