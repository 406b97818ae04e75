"""Plugins inside a `<visual>`: their parameters and their handles."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from plugin_worlds import world
from typer.testing import CliRunner

import simkit
from simkit.cli import app

PAINTER = """
from simkit import VisualPlugin

class Painter(VisualPlugin):
    filenames = ("libpainter.so",)

    def prepare(self, scene, params, builder):
        self.told = [scene.scoped]

    def load(self, parent, params):
        self.told += [parent.scoped, parent.link.scoped, len(parent.geoms), params.text("colour", "red")]
        self.visual = parent
"""
SHAPE = "<geometry><box><size>1 1 1</size></box></geometry>"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "painter.py").write_text(PAINTER)
    return tmp_path


def model_with_visual(plugin: str, on_model: str = "", name: str = "m") -> str:
    return (
        f'<model name="{name}"><pose>1 2 3 0 0 1.5707963267948966</pose><static>true</static><link name="l">'
        f'<pose>0 0 1 0 0 0</pose><visual name="v"><pose>1 0 0 0 0 0</pose>{SHAPE}{plugin}</visual>'
        f'<visual name="w">{SHAPE}</visual></link>{on_model}</model>'
    )


PLUGIN = '<plugin name="p" filename="libpainter.so"><colour>blue</colour></plugin>'


def plugin_of(sim: simkit.Simulation) -> object:
    (found,) = [p for p in sim.engine.structure.all_plugins() if type(p).__name__ == "Painter"]
    return found


def test_a_visual_plugin_gets_the_scene_in_prepare_and_a_handle_in_load(folder: Path) -> None:
    with simkit.load(world(model_with_visual(PLUGIN)), plugin_paths=[folder]) as sim:
        plugin = plugin_of(sim)
        assert plugin.told == ["m::l::v", "m::l::v", "m::l", 1, "blue"]  # type: ignore[attr-defined]
        assert plugin.scoped == "m::l::v"  # type: ignore[attr-defined]
        assert plugin.visual is sim.visual("m::l::v") is sim.link("m::l").visuals["v"]  # type: ignore[attr-defined]


def test_the_pose_of_a_visual_follows_its_moved_model(folder: Path) -> None:
    with simkit.load(world(model_with_visual(PLUGIN)), plugin_paths=[folder]) as sim:
        visual = sim.visual("m::l::v")
        np.testing.assert_allclose(visual.pose.position, (1, 3, 4), atol=1e-12)
        sim.model("m").set_pose(simkit.Pose((5, 0, 0)))
        np.testing.assert_allclose(visual.pose.position, (6, 0, 1), atol=1e-9)
        sim.remove("m")
        assert "removed" in repr(visual)
        with pytest.raises(simkit.InputError, match="was removed"):
            _ = visual.geoms


def test_an_unknown_visual_is_a_key_error_with_the_closest_name() -> None:
    with simkit.load(world(model_with_visual(""))) as sim, pytest.raises(KeyError, match="did you mean 'm::l::v'"):
        sim.visual("m::l::vv")


def test_a_spawned_model_brings_its_visual_plugin(folder: Path) -> None:
    with simkit.load(world(), plugin_paths=[folder]) as sim:
        sim.spawn(f'<sdf version="1.9">{model_with_visual(PLUGIN, name="late")}</sdf>')
        assert plugin_of(sim).told[0] == "late::l::v"  # type: ignore[attr-defined]


def test_a_visual_plugin_on_another_entity_is_ignored_with_a_warning(folder: Path) -> None:
    found = simkit.check(world(model_with_visual("", on_model=PLUGIN)), plugin_paths=[folder])
    (warning,) = [d for d in found if d.code == "SK-PLUGIN-007"]
    assert "it is for a visual, but is attached to a model" in warning.message


def test_unread_elements_of_a_visual_plugin_are_reported(folder: Path) -> None:
    text = model_with_visual(PLUGIN.replace("colour>", "color>"))
    found = [d for d in simkit.check(world(text), plugin_paths=[folder]) if d.code == "SK-PARAM-003"]
    assert len(found) == 1
    assert "colour" in found[0].hint


def test_set_changes_the_parameters_of_a_visual_plugin(folder: Path) -> None:
    with simkit.load(
        world(model_with_visual(PLUGIN)), plugin_paths=[folder], overrides=["m::l::v::p.colour=green"]
    ) as sim:
        assert plugin_of(sim).told[-1] == "green"  # type: ignore[attr-defined]


def test_a_converted_file_keeps_the_visual_plugin(folder: Path, tmp_path: Path) -> None:
    (tmp_path / "in.sdf").write_text(world(model_with_visual(PLUGIN)))
    done = CliRunner().invoke(app, ["convert", str(tmp_path / "in.sdf"), "-o", str(tmp_path / "out.sdf")])
    assert done.exit_code == 0, done.output
    with simkit.load(tmp_path / "out.sdf", plugin_paths=[folder]) as sim:
        assert plugin_of(sim).told[-1] == "blue"  # type: ignore[attr-defined]
