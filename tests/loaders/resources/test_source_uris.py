"""A source can be a URI: of a bundled, built-in or user's model, or of a file in any folder."""

from __future__ import annotations

from pathlib import Path

import pytest

import simkit

BOX = '<sdf version="1.9"><model name="box"><link name="l"/></model></sdf>'


def test_a_model_is_loaded_from_a_uri(tmp_path: Path) -> None:
    folder = tmp_path / "my box"
    folder.mkdir()
    (folder / "model.sdf").write_text(BOX, encoding="utf-8")
    with simkit.load("empty", resource_paths=[tmp_path]) as sim:
        assert sim.spawn("model://my box", name="a").name == "a"
        assert sim.spawn(folder.as_uri(), name="b").name == "b"
        assert sim.spawn((folder / "model.sdf").as_uri(), name="c").name == "c"
        assert sim.spawn("model://ground_plane", name="d").static
        assert sim.spawn("model://turtlebot3_waffle").name == "turtlebot3_waffle"


@pytest.mark.parametrize(
    ("uri", "code"),
    [("model://nothing", "SK-URI-001"), ("file:///nothing.sdf", "SK-LOAD-002"), ("modle://box", "SK-URI-004")],
)
def test_a_uri_that_is_not_found_is_an_error_with_the_uri(uri: str, code: str) -> None:
    with simkit.load("empty") as sim, pytest.raises(simkit.LoadError, match="nothing|modle") as caught:
        sim.spawn(uri)
    assert [problem.code for problem in caught.value.diagnostics if problem.severity == "error"] == [code]


def test_a_scheme_with_a_typing_error_is_read_as_the_closest_one(tmp_path: Path) -> None:
    (tmp_path / "box").mkdir()
    (tmp_path / "box" / "model.sdf").write_text(BOX, encoding="utf-8")
    for include in ("models://box", "modle://ground_plane"):
        world = f"<sdf version='1.9'><world name='w'><include><uri>{include}</uri></include></world></sdf>"
        with simkit.load(world, resource_paths=[tmp_path]) as sim:
            assert [d.code for d in sim.diagnostics if d.severity == "warning"] == ["SK-URI-004"]
            assert list(sim.models) == [include.partition("://")[2]]


def test_a_mesh_with_an_unknown_scheme_is_left_out() -> None:
    mesh = "<visual name='v'><geometry><mesh><uri>zip://box.dae</uri></mesh></geometry></visual>"
    with simkit.load(BOX.replace('<link name="l"/>', f"<link name='l'>{mesh}</link>")) as sim:
        assert [d.code for d in sim.diagnostics if d.severity == "warning"] == ["SK-URI-004"]


def test_a_world_finds_a_model_in_a_group_of_models_of_its_package(tmp_path: Path) -> None:
    """A group is a folder without a `model.config`; outside of a package it is not read."""
    world = tmp_path / "package" / "worlds" / "course.world"
    model = tmp_path / "package" / "models" / "course" / "bar" / "model.sdf"
    for file in (world, model):
        file.parent.mkdir(parents=True, exist_ok=True)
    model.write_text(BOX, encoding="utf-8")
    world.write_text(
        "<sdf version='1.9'><world name='w'><include><uri>model://course/bar</uri></include></world></sdf>",
        encoding="utf-8",
    )
    with pytest.raises(simkit.LoadError, match="model://course/bar"):
        simkit.load(world)
    (tmp_path / "package" / "package.xml").write_text("<package><name>package</name></package>", encoding="utf-8")
    with simkit.load(world) as sim:
        assert sim.model("box").name == "box"


def test_a_folder_without_a_model_does_not_hide_the_model_of_its_name(tmp_path: Path) -> None:
    """The world is in a project folder that has the name of a robot of simkit."""
    folder = tmp_path / "turtlebot3_burger"
    folder.mkdir()
    (folder / "notes.txt").write_text("no model")
    world = folder / "arena.sdf"
    include = "<include><uri>model://turtlebot3_burger</uri></include>"
    world.write_text(f"<sdf version='1.9'><world name='w'>{include}</world></sdf>")
    with simkit.load(world) as sim:
        assert list(sim.models) == ["turtlebot3_burger"]
