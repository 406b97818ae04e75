"""`package://` and similar URIs without ROS: searched folders, their order, and the messages."""

from __future__ import annotations

from pathlib import Path

import pytest
from urdf_robots import MASS, errors, link, robot, with_code

import simkit
from simkit.diagnostics import Diagnostics, Where
from simkit.loaders import Resolver, load_scene


@pytest.fixture(autouse=True)
def _no_search_paths(monkeypatch):
    for name in ("SIMKIT_RESOURCE_PATH", "GZ_SIM_RESOURCE_PATH", "GAZEBO_MODEL_PATH", "ROS_PACKAGE_PATH"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)


def with_mesh(uri: str) -> str:
    return robot(link("l", f'{MASS}<visual><geometry><mesh filename="{uri}"/></geometry></visual>'))


def package(write, path: str, name: str = "") -> Path:
    """Write a package with one mesh."""
    write(f"{path}/meshes/m.stl", path)
    return write(f"{path}/package.xml", f"<package><name>{name or Path(path).name}</name></package>").parent


def found_mesh(load, file, paths=()) -> str:
    """Return the content of the mesh that a robot uses; in these tests, the content is the path of its package."""
    scene, found = load(file, paths)
    assert not errors(found), errors(found)
    shapes = scene.model.links[0].visuals
    return shapes[0].geometry.file.read_text() if shapes else "nothing"


def test_a_package_is_found_around_the_file(load, write):
    package(write, "ws/src/arm")
    own = write("ws/src/arm/urdf/r.urdf", with_mesh("package://arm/meshes/m.stl"))
    assert found_mesh(load, own) == "ws/src/arm"
    package(write, "ws/src/hand")
    sibling = write("ws/src/arm/urdf/s.urdf", with_mesh("package://hand/meshes/m.stl"))
    assert found_mesh(load, sibling) == "ws/src/hand"
    package(write, "ws/src/repo/head")
    further = write("ws/src/arm/urdf/f.urdf", with_mesh("package://head/meshes/m.stl"))
    assert found_mesh(load, further) == "ws/src/repo/head"


def test_a_package_is_found_by_the_name_in_package_xml(load, write):
    package(write, "arm-main", "arm")
    file = write("arm-main/urdf/r.urdf", with_mesh("package://arm/meshes/m.stl"))
    assert found_mesh(load, file) == "arm-main"


@pytest.mark.parametrize("variable", ["ROS_PACKAGE_PATH", "GZ_SIM_RESOURCE_PATH", "GAZEBO_MODEL_PATH"])
def test_the_path_variables_are_searched(load, write, monkeypatch, variable):
    folder = package(write, "elsewhere/deep/arm")
    monkeypatch.setenv(variable, str(folder.parents[1]))
    file = write("here/r.urdf", with_mesh("package://arm/meshes/m.stl"))
    assert found_mesh(load, file) == "elsewhere/deep/arm"


def test_ament_prefixes_have_their_packages_in_share(load, write, monkeypatch):
    folder = package(write, "opt/share/arm")
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(folder.parents[1]))
    assert found_mesh(load, write("here/r.urdf", with_mesh("package://arm/meshes/m.stl"))) == "opt/share/arm"


def test_a_package_folder_given_by_the_user_is_searched_first(write):
    package(write, "ws/arm")
    other = package(write, "other/arm")
    file = write("ws/arm/urdf/r.urdf", with_mesh("package://arm/meshes/m.stl"))
    found = simkit.describe(file, package_paths={"arm": other})
    assert found["model"]["links"][0]["visuals"][0]["geom"]["file"] == str(other / "meshes/m.stl")


@pytest.mark.parametrize(
    "uri",
    [
        "$(find arm)/meshes/m.stl",
        "file://$(find arm)/meshes/m.stl",
        "model://arm/meshes/m.stl",
        "file:///opt/somebody/ws/install/arm/share/arm/meshes/m.stl",
        "../meshes/m.stl",
    ],
)
def test_other_spellings_of_a_package_uri_are_accepted(load, write, uri):
    package(write, "ws/arm")
    scene, found = load(write("ws/arm/urdf/r.urdf", with_mesh(uri)))
    assert scene.model.links[0].visuals[0].geometry.file.read_text() == "ws/arm"
    assert bool(with_code(found, "SK-URI-010")) == uri.startswith("file:///opt")


@pytest.mark.slow
def test_a_missing_package_is_reported_once_with_all_searched_folders_and_the_option(write):
    meshes = "".join(
        f'<collision><geometry><mesh filename="package://nope/m{i}.stl"/></geometry></collision>\n' for i in range(3)
    )
    file = write("ws/arm/urdf/r.urdf", robot(link("l", MASS + "\n" + meshes)))
    write("ws/arm/package.xml", "<package><name>arm</name></package>")
    with simkit.load(file) as sim:
        (problem,) = (d for d in sim.diagnostics if d.severity == "warning" and d.code.startswith("SK-URI"))
    with pytest.raises(simkit.LoadError):
        simkit.load(file, strict=True)
    assert (problem.code, problem.line) == ("SK-URI-009", 2)
    assert "3 files" in problem.message and "lines 2, 3, 4" in problem.message
    assert str(file.parents[2] / "nope") in problem.message
    assert "--package-path nope=DIR" in problem.hint


def test_a_missing_package_names_the_workspace_whose_packages_were_searched(load, write):
    package(write, "ws/src/repository/arm")
    package(write, "ws/src/other/hand")
    file = write("ws/src/repository/arm/urdf/r.urdf", with_mesh("package://nope/m.stl"))
    (problem,) = with_code(load(file)[1], "SK-URI-009")
    assert f"searched below {file.parents[4]}, " in problem.message


@pytest.mark.parametrize("part", ["visual", "collision"])
def test_a_robot_loads_without_a_missing_mesh_and_with_a_warning(load, write, part):
    mesh = f'<{part}><geometry><mesh filename="gone.stl"/></geometry></{part}>'
    file = write("r.urdf", robot(link("l", MASS + mesh)))
    assert [d.severity for d in with_code(load(file)[1], "SK-URI-001")] == ["warning"]
    with simkit.load(file) as sim:
        assert sim.mj_model.ngeom == 0


@pytest.mark.parametrize(
    "uri",
    ["package://../secret.stl", "package://arm/../../secret.stl", "../../../secret.stl", "file:///etc/hostname"],
)
def test_a_uri_outside_its_folders_is_refused(load, write, uri):
    package(write, "ws/src/arm")
    write("secret.stl", "secret")
    found = load(write("ws/src/arm/urdf/r.urdf", with_mesh(uri)))[1]
    assert {d.code for d in found} & {"SK-URI-003", "SK-URI-009", "SK-URI-001"}
    (visual,) = load(write("ws/src/arm/urdf/r.urdf", with_mesh(uri)))[0].model.links[0].visuals
    assert visual.geometry.missing


def test_a_distant_folder_without_package_xml_is_not_a_package(write):
    write("data/secret.stl", "secret")
    write("ws/src/arm/package.xml", "<package><name>arm</name></package>")
    file = write("ws/src/arm/urdf/r.urdf", with_mesh("package://data/secret.stl"))
    diagnostics = Diagnostics()
    load_scene(file, resolver=Resolver(), diagnostics=diagnostics)
    assert with_code(list(diagnostics), "SK-URI-009")


def test_files_of_a_package_may_be_read_after_find_package_found_it(write):
    folder = package(write, "ws/arm")
    base = write("ws/hand/package.xml", "<package><name>hand</name></package>").parent
    resolver = Resolver(base=base)
    assert resolver.find_package("arm", base)[0] == folder
    diagnostics = Diagnostics()
    assert resolver.resolve(f"file://{folder}/meshes/m.stl", Where(), diagnostics, base) == folder / "meshes/m.stl"
