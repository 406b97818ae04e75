"""Clients spawn bundled models, URIs and files in the folders of a run; paths elsewhere are refused."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from service_worlds import model

import simkit
from simkit.errors import InputError
from simkit.plugins.world.service_entities import add_namespace

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


HALVES = ("<plugin>", "<plugin ", '<plugin "', "<plugin '\"", "<plugin>x</plugin ", "<plugin a='b'")


@pytest.mark.parametrize("half", HALVES)
@pytest.mark.parametrize("end", ["", "</plugin>", "/>"])
def test_the_time_to_add_a_namespace_grows_linearly(half, end):
    text = f"<sdf>{half * 100_000}{end}</sdf>"  # with the square of the length: hours
    assert add_namespace(text, "a").startswith("<sdf>")


@pytest.mark.parametrize("half", ["<ros><namespace>", "<ros><namespace ", "<robotNamespace>", "<robotNamespace "])
def test_an_unfinished_namespace_costs_no_time(half):
    assert add_namespace(f"<plugin>{half * 100_000}</plugin>", "a").endswith("</plugin>")


def test_all_forms_of_a_plugin_get_the_namespace():
    def added(content):
        return add_namespace(f"<plugin name='a>b' filename=\"f\">{content}</plugin><plugin x='1'/>", "n")

    tail = "<plugin x='1'><ros><namespace>n</namespace></ros></plugin>"
    head = "<plugin name='a>b' filename=\"f\">"
    assert added("<y/>") == f"{head}<ros><namespace>n</namespace></ros><y/></plugin>{tail}"
    assert (
        added("<ros><namespace> old </namespace></ros>") == f"{head}<ros><namespace>n</namespace></ros></plugin>{tail}"
    )
    assert added("<ros><z/></ros>") == f"{head}<ros><namespace>n</namespace><z/></ros></plugin>{tail}"
    own = "<robotNamespace>n</robotNamespace>"
    assert added("<robotNamespace>/old</robotNamespace>") == f"{head}{own}</plugin>{tail}"
    assert added("<robotNamespace/>") == f"{head}{own}</plugin>{tail}"
