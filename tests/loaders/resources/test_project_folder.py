"""Relative paths with `..`: inside the project of the file, and never outside."""

from __future__ import annotations

import struct
from pathlib import Path

import pytest

import simkit

STL = b"\0" * 80 + struct.pack("<I", 4)
for _corners in ("0 0 0 0 1 0 1 0 0", "0 0 0 1 0 0 0 0 1", "1 0 0 0 1 0 0 0 1", "0 0 0 0 0 1 0 1 0"):
    STL += struct.pack("<12fH", 0, 0, 0, *map(float, _corners.split()), 0)

MJCF = """<mujoco><compiler {}/><asset><mesh name="m" file="{}"/></asset>
<worldbody><body><geom type="mesh" mesh="m"/></body></worldbody></mujoco>"""
URDF = """<robot name="r"><link name="l"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial>
<collision><geometry><mesh filename="{}"/></geometry></collision></link></robot>"""
WORLD = """<mujoco><include file="{}"/></mujoco>"""


@pytest.fixture
def write(tmp_path: Path):
    def _write(name: str, content: str | bytes = "") -> Path:
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return path

    return _write


@pytest.fixture
def uri_codes(load):
    """Return a function uri_codes(file, resource_paths=()) -> codes of the URIs that are not read."""

    def _uri_codes(file: Path, resource_paths: tuple[Path, ...] = ()) -> list[str]:
        return [d.code for d in load(file, resource_paths)[1] if d.code.startswith("SK-URI")]

    return _uri_codes


MARKERS = [".git/HEAD", ".git", "package.xml", "model.config", "pyproject.toml", "__init__.py"]


@pytest.mark.parametrize("marker", MARKERS)
@pytest.mark.parametrize(
    "text",
    [
        MJCF.format('meshdir="../../shapes"', "m.stl"),
        MJCF.format('assetdir="../../shapes/"', "m.stl"),
        MJCF.format("", "../../shapes/m.stl"),
        WORLD.format("../../shapes/inner.xml"),
        URDF.format("../../shapes/m.stl"),
    ],
    ids=["meshdir", "assetdir", "file", "include", "urdf"],
)
def test_a_file_may_refer_to_its_project_upwards(write, uri_codes, marker, text):
    write("people/alice/project/shapes/m.stl", STL)
    write("people/alice/project/shapes/inner.xml", MJCF.format('meshdir="../../shapes"', "m.stl"))
    file = write("people/alice/project/robots/arm/arm" + (".urdf" if "<robot" in text else ".xml"), text)
    assert uri_codes(file) in (["SK-URI-003"], ["SK-URI-003", "SK-URI-003"])
    assert uri_codes(file, (file.parents[2],)) == []
    write(f"people/alice/project/{marker}", "<package><name>project</name></package>")
    assert uri_codes(file) == []
    outside = write("people/alice/secret.stl", STL)
    file.write_text(text.replace("../../shapes", "../../..").replace("m.stl", outside.name))
    assert uri_codes(file)[0] == "SK-URI-003"


def test_the_nearest_project_counts_and_it_is_at_most_four_levels_up(write, uri_codes):
    write("a/project/.git")
    write("a/project/m.stl", STL)
    file = write("a/project/1/2/3/4/r.xml", MJCF.format('meshdir="../../../.."', "m.stl"))
    assert uri_codes(file) == []
    deeper = write("a/project/1/2/3/4/5/r.xml", MJCF.format('meshdir="../../../../.."', "m.stl"))
    assert uri_codes(deeper) == ["SK-URI-003"]
    write("a/project/1/2/pyproject.toml")
    assert uri_codes(file) == ["SK-URI-003"]


@pytest.mark.parametrize("home", ["home", "home/link"])
def test_the_home_folder_is_never_a_project(write, uri_codes, monkeypatch, tmp_path, home):
    write("home/real/.git")
    write("home/real/m.stl", STL)
    (tmp_path / "home/link").symlink_to(tmp_path / "home/real")
    file = write("home/real/robots/r.xml", MJCF.format('meshdir=".."', "m.stl"))
    assert uri_codes(file) == []
    write("home/.git")
    monkeypatch.setenv("HOME", str(tmp_path / home))
    (tmp_path / "home/real/.git").unlink()
    assert uri_codes(file) == ["SK-URI-003"]
    write("home/real/.git")
    assert uri_codes(file) == (["SK-URI-003"] if home == "home/link" else [])


@pytest.mark.parametrize("folder", ["meshes", "textures", "stls", "assets"])
def test_without_a_project_a_file_may_refer_to_the_folders_beside_its_folder(write, uri_codes, folder):
    """This is the layout of Gymnasium-Robotics: `assets/fetch/reach.xml` and `assets/stls/fetch`."""
    write(f"data/{folder}/arm/m.stl", STL)
    write("data/arm/part.xml", '<mujoco><worldbody><geom size="1"/></worldbody></mujoco>')
    file = write("data/robots/r.xml", MJCF.format(f'meshdir="../{folder}/arm"', "m.stl"))
    assert uri_codes(file) == []
    assert uri_codes(write("data/robots/w.xml", WORLD.format("../arm/part.xml"))) == []
    write("secret/m.stl", STL)
    assert uri_codes(write("data/robots/x.xml", MJCF.format('meshdir="../../secret"', "m.stl"))) == ["SK-URI-003"]


def test_a_texture_folder_upwards_is_read(write, uri_codes):
    import numpy as np
    from PIL import Image

    (write("p/.git").parent / "textures").mkdir()
    Image.fromarray(np.zeros((4, 4, 3), np.uint8)).save(write("p/.git").parent / "textures/t.png")
    text = """<mujoco><compiler texturedir="../textures"/><asset><texture name="t" type="2d" file="t.png"/></asset>
    <worldbody><geom size="1"/></worldbody></mujoco>"""
    assert uri_codes(write("p/xml/r.xml", text)) == []


def test_a_vendored_mjcf_file_keeps_the_files_above_its_folder(write, tmp_path):
    """The included file uses the folder of meshes that the main file names, and is not in a folder of either."""
    from simkit.writers.vendored_folder import vendor

    write("project/.git")
    write("project/shapes/m.stl", STL)
    write("project/secret.stl", STL)
    write("secret.stl", STL)
    part = '<mujoco><asset><mesh name="m" file="m.stl"/></asset></mujoco>'
    write("project/parts/part.xml", part)
    main = """<mujoco><compiler meshdir="../../shapes"/><include file="../../parts/part.xml"/>
    <worldbody><body><geom type="mesh" mesh="m"/></body></worldbody></mujoco>"""
    file = write("project/robots/arm/arm.xml", main)
    place, count = vendor(str(file), tmp_path / "copy", simkit.describe)
    assert place.as_posix() == "robots/arm/arm.xml" and count == 4
    files = {
        path.relative_to(tmp_path / "copy").as_posix() for path in (tmp_path / "copy").rglob("*") if path.is_file()
    }
    assert files == {"robots/arm/arm.xml", "parts/part.xml", "shapes/m.stl", "model.config"}
    assert simkit.describe(tmp_path / "copy")["worlds"] == simkit.describe(file)["worlds"]
