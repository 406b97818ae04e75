"""Clients spawn bundled models, URIs and files in the folders of a run; paths elsewhere are refused."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from service_worlds import model

import simkit
from simkit.errors import InputError

WORLD = """<sdf version="1.9"><world name="w"><plugin filename="libgazebo_ros_factory.so" name="f"/></world></sdf>"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    for name in ("project/models", "private", "work"):
        (tmp_path / name).mkdir(parents=True)
    (tmp_path / "project" / ".git").mkdir()
    (tmp_path / "project" / "w.sdf").write_text(WORLD)
    for name in ("project/models/one.sdf", "private/one.sdf", "work/one.sdf"):
        (tmp_path / name).write_text(model("one"))
    (tmp_path / "project" / "link.sdf").symlink_to(tmp_path / "private" / "one.sdf")
    monkeypatch.chdir(tmp_path / "work")
    return tmp_path


@pytest.fixture
def sim(folder: Path) -> Iterator[simkit.Simulation]:
    with simkit.load(folder / "project" / "w.sdf") as sim:
        yield sim


def _requests(source: str) -> dict[str, dict[str, Any]]:
    return {
        "/world/w/create": {"entity_factory": {"sdf_filename": source, "name": "new"}},
        "/world/w/create_multiple": {"entity_factories": [{"sdf_filename": source, "name": "new"}]},
        "/spawn_entity": {"xml": source, "name": "new"},
    }


@pytest.mark.parametrize("service", _requests(""))
@pytest.mark.parametrize(
    "source",
    ["{}/private/one.sdf", "file://{}/private/one.sdf", "../private/one.sdf", "one.sdf", "{}/project/link.sdf"],
)
def test_a_path_outside_the_folders_of_the_run_is_refused(
    sim: simkit.Simulation, folder: Path, service: str, source: str
) -> None:
    answer = sim.call(service, _requests(source.format(folder))[service])
    assert not getattr(answer, "success", getattr(answer, "data", False))
    assert "new" not in sim.models


@pytest.mark.parametrize("source", ["turtlebot3_burger", "model://turtlebot3_burger", "{}/project/models/one.sdf"])
def test_bundled_names_and_files_of_the_run_are_spawned(sim: simkit.Simulation, folder: Path, source: str) -> None:
    assert sim.call("/world/w/create", _requests(source.format(folder))["/world/w/create"]).success
    assert "new" in sim.models


def test_the_page_refuses_the_same_paths(sim: simkit.Simulation, folder: Path) -> None:
    for source in (f"{folder}/private/one.sdf", "../private/one.sdf", "/proc/self/environ"):
        with pytest.raises(InputError, match="SK-URI-003 a client may not spawn"):
            sim.control.client_source(source)
    assert sim.control.client_source("turtlebot3_burger") == "turtlebot3_burger"


def test_a_resource_path_of_the_user_is_a_folder_of_the_run(folder: Path) -> None:
    with simkit.load(folder / "project" / "w.sdf", resource_paths=[folder / "private"]) as sim:
        assert sim.call("/world/w/create", _requests(f"{folder}/private/one.sdf")["/world/w/create"]).success


def test_a_script_spawns_any_file(sim: simkit.Simulation, folder: Path) -> None:
    assert sim.spawn(str(folder / "private" / "one.sdf"), "new").name == "new"
