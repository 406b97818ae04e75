"""URIs that name nothing: searched once in a load, and the help names the folder that has the file."""

from __future__ import annotations

from pathlib import Path

import pytest

from simkit.diagnostics import Diagnostics, Where
from simkit.loaders import Resolver, load_scene


@pytest.fixture(autouse=True)
def _no_search_paths(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("SIMKIT_RESOURCE_PATH", "GZ_SIM_RESOURCE_PATH", "GAZEBO_MODEL_PATH", "ROS_PACKAGE_PATH"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)


def _write(path: Path, text: str = "x") -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return path


def _world(*uris: str) -> str:
    """Return a world whose boxes have a visual mesh each."""
    models = "".join(
        f"""<model name="m{number}"><static>true</static><link name="l"><visual name="v"><geometry><mesh>
          <uri>{uri}</uri></mesh></geometry></visual></link></model>"""
        for number, uri in enumerate(uris)
    )
    return f'<sdf version="1.9"><world name="w">{models}</world></sdf>'


URIS = ("model://shop/a.dae", "package://shop/a.dae", "file://models/shop/a.dae", "a.dae", "file:///opt/shop/a.dae")


@pytest.mark.parametrize("uri", URIS)
def test_a_uri_that_names_nothing_is_searched_once_in_a_load(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, uri: str
) -> None:
    searched = []
    search = Resolver._search

    def count(self: Resolver, uri: str, relative_to: Path | None) -> tuple[Path | None, list[Path] | None]:
        searched.append(uri)
        return search(self, uri, relative_to)

    monkeypatch.setattr(Resolver, "_search", count)
    file = _write(tmp_path / "w.sdf", _world(*[uri] * 20))
    found = Diagnostics()
    load_scene(file, resolver=Resolver(), diagnostics=found)
    assert searched.count(uri) == 1
    assert sum(problem.code.startswith("SK-URI") for problem in found) == 1


def test_the_second_failure_has_the_same_message_as_the_first(tmp_path: Path) -> None:
    resolver = Resolver(base=tmp_path)
    for uri in URIS:
        texts = []
        for line in (1, 2):
            found = Diagnostics()
            assert resolver.resolve(uri, Where("w.sdf", line), found, tmp_path) is None
            texts.append([(problem.code, problem.message, problem.hint) for problem in found])
            assert [problem.line for problem in found] == [line]
        assert texts[0] == texts[1] and len(texts[0]) == 1


def test_a_file_that_is_created_after_a_load_is_found_by_the_next_load(tmp_path: Path) -> None:
    file = _write(tmp_path / "w.sdf", _world("model://shop/a.dae"))
    resolver = Resolver([tmp_path / "models"])
    for is_there in (False, True):
        found = Diagnostics()
        scene = load_scene(file, resolver=resolver, diagnostics=found)
        assert any(problem.code == "SK-URI-001" for problem in found) != is_there
        assert scene.world is not None
        _write(tmp_path / "models/shop/a.dae")


def test_a_resource_path_that_is_added_later_is_searched(tmp_path: Path) -> None:
    _write(tmp_path / "elsewhere/shop/a.dae")
    for paths, is_found in (([], False), ([tmp_path / "elsewhere"], True)):
        path, _ = Resolver(paths, base=tmp_path / "worlds").search("model://shop/a.dae", tmp_path / "worlds")
        assert (path is not None) == is_found


def test_a_relative_uri_is_found_in_the_package_of_the_file_with_a_note(tmp_path: Path) -> None:
    _write(tmp_path / "ws/shop/package.xml", "<package><name>shop</name></package>")
    mesh = _write(tmp_path / "ws/shop/models/shelf/meshes/a.dae")
    folder = _write(tmp_path / "ws/shop/models/shelf/model.config").parent
    found = Diagnostics()
    path = Resolver().resolve("file://models/shelf/meshes/a.dae", Where("model.sdf", 3), found, folder)
    assert path == mesh
    assert [(problem.severity, problem.code) for problem in found] == [("note", "SK-URI-010")]


@pytest.mark.parametrize(
    ("uri", "folder"),
    [("model://shelf/meshes/a.dae", "ws/shop/models"), ("file://models/shelf/meshes/a.dae", "ws/shop")],
)
def test_the_help_names_the_folder_above_the_file_that_has_what_is_missing(
    tmp_path: Path, uri: str, folder: str
) -> None:
    _write(tmp_path / "ws/shop/models/shelf/meshes/a.dae")
    place = tmp_path / "ws/shop/a/b/worlds"
    place.mkdir(parents=True)
    found = Diagnostics()
    assert Resolver().resolve(uri, Where("w.sdf", 3), found, place) is None
    assert [problem.hint for problem in found] == [
        f"it is in {tmp_path / folder}: add --resource-path {tmp_path / folder}"
    ]


@pytest.mark.parametrize(
    ("uri", "help_text"),
    [
        ("model://shop/meshes/shelf.dae", "did you mean 'shelf2.dae'?"),
        ("model://shop/meshes/door.dae", "--resource-path"),
        ("model://shops/meshes/door.dae", "did you mean 'shop'?"),
    ],
)
def test_the_help_suggests_another_model_only_if_the_model_of_the_uri_is_not_there(
    tmp_path: Path, uri: str, help_text: str
) -> None:
    for name in ("models/shop/meshes/shelf2.dae", "models/shop_with_roof/meshes/door.dae"):
        _write(tmp_path / name)
    found = Diagnostics()
    resolver = Resolver([tmp_path / "models"])
    resolver.resolve(uri, Where(None, 1), found, tmp_path)
    (problem,) = found
    assert problem.code == "SK-URI-001"
    assert help_text in problem.hint


@pytest.mark.parametrize(("uri", "name"), [("model://sunn", "sun"), ("model://turtlebot3_burgr", "turtlebot3_burger")])
def test_the_help_suggests_a_model_of_simkit(uri: str, name: str) -> None:
    found = Diagnostics()
    Resolver().resolve(uri, Where(None, 1), found, None)
    (problem,) = found
    assert (problem.code, problem.hint) == ("SK-URI-001", f"did you mean {name!r}?")


def test_an_unknown_scheme_has_the_same_message_for_each_uri(tmp_path: Path) -> None:
    """Equal messages are shown once, with all their lines."""
    for name in ("a.dae", "b.dae"):
        _write(tmp_path / "shop" / name)
    found = Diagnostics()
    for line, name in enumerate(("a.dae", "b.dae"), 1):
        Resolver([tmp_path]).resolve(f"models://shop/{name}", Where("w.sdf", line), found, None)
    assert [d.message for d in found] == ["unknown scheme models://; model:// is used instead"] * 2


@pytest.mark.parametrize("place", ["models", "descriptions/models"])
@pytest.mark.parametrize("uri", ["model://boat", "boat"])
def test_a_model_is_found_in_the_folders_models_of_the_project(tmp_path: Path, place: str, uri: str) -> None:
    """Such a project names the folders in an environment variable, which a user of simkit has not set."""
    (tmp_path / "project/.git").mkdir(parents=True)
    model = _write(tmp_path / "project" / place / "boat/model.config").parent
    world = _write(tmp_path / "project/tests/worlds/w.sdf").parent
    assert Resolver().resolve(uri, Where("w.sdf", 1), Diagnostics(), world) == model
