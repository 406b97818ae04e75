"""Symbolic links: a link may lead to any folder that the user chose, and out of them only if the user allows it."""

from __future__ import annotations

import shutil
import struct
from collections.abc import Callable
from pathlib import Path

import pytest

import simkit
from packs.fuel.tests.fuel_server import run, served
from simkit.diagnostics import Diagnostics
from simkit.loaders.resources.model_list import spawnable_models
from simkit.loaders.resources.uri_resolver import Resolver
from simkit.writers.vendored_folder import vendor

WORLD = '<sdf version="1.9"><world name="w">{}</world></sdf>'
MODEL = '<sdf version="1.9"><model name="{}"><link name="l"/></model></sdf>'
MESH = """<model name="m"><static>true</static><link name="l"><visual name="v"><geometry><mesh><uri>{}</uri></mesh>
</geometry></visual></link></model>"""
ROBOT = """<robot name="r"><link name="l"><visual><geometry><mesh filename="{}"/></geometry></visual></link></robot>"""
XACRO = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">{}</robot>'
STL = bytes(80) + struct.pack("<I", 1) + struct.pack("<12fH", *range(12), 0)

Write = Callable[[str, str | bytes], Path]


@pytest.fixture
def write(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Write:
    """Return a function that writes a file below the home folder of the test and returns its path."""
    home = tmp_path / "home"
    monkeypatch.setenv("HOME", str(home))
    for variable in ("AMENT_PREFIX_PATH", "ROS_PACKAGE_PATH", "GZ_SIM_RESOURCE_PATH", "SIMKIT_RESOURCE_PATH"):
        monkeypatch.delenv(variable, raising=False)

    def _write(name: str, content: str | bytes) -> Path:
        path = home / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    _write("private/m.stl", STL)
    return _write


def link(path: Path, target: Path | str) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.symlink_to(target)
    return path


def problems(file: Path, **options: object) -> list[str]:
    """Return the codes of errors, and of warnings about files."""
    found = simkit.check(file, **options)  # type: ignore[arg-type]
    return [d.code for d in found if d.severity == "error" or (d.severity == "warning" and "URI" in d.code)]


def package(write: Write, folder: str, name: str = "robot", mesh: str = "package://robot/meshes/m.stl") -> Path:
    """Write a package with a robot and its mesh; return the folder."""
    write(f"{folder}/meshes/m.stl", STL)
    write(f"{folder}/urdf/r.urdf", ROBOT.format(mesh))
    return write(f"{folder}/package.xml", f"<package><name>{name}</name></package>").parent


def install_links(source: Path, share: Path) -> None:
    """Install a package as `colcon build --symlink-install` does: real folders with a link for each file."""
    for file in source.rglob("*"):
        if file.is_file():
            link(share / file.relative_to(source), file)


# ---------------------------------------------------------------------- links that are followed


def test_a_workspace_of_colcon_with_links_loads_from_its_installed_folder(write: Write, tmp_path: Path) -> None:
    source = package(write, "ws/src/robot")
    share = tmp_path / "home/ws/install/robot/share/robot"
    install_links(source, share)
    assert problems(share / "urdf/r.urdf") == []


def test_an_installed_package_of_links_is_found_by_name(
    write: Write, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    prefix = tmp_path / "home/ws/install/robot"
    install_links(package(write, "ws/src/group/robot"), prefix / "share/robot")
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(prefix))
    world = write("elsewhere/w.sdf", WORLD.format(MESH.format("package://robot/meshes/m.stl")))
    assert problems(world) == []


def test_a_package_that_the_user_links_into_a_workspace_is_found(
    write: Write, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    link(tmp_path / "home/ws/src/robot", package(write, "dev/robot"))
    world = write("elsewhere/w.sdf", WORLD.format(MESH.format("package://robot/meshes/m.stl")))
    assert problems(world, package_paths=[tmp_path / "home/ws"]) == []
    assert problems(world, resource_paths=[tmp_path / "home/ws/src"]) == []
    install_links(tmp_path / "home/dev/robot", tmp_path / "home/ws/install/robot/share/robot")
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path / "home/ws/install/robot"))
    assert problems(world) == []


def test_a_link_inside_a_project_and_a_link_to_a_search_path_are_followed(write: Write, tmp_path: Path) -> None:
    write("project/.git/config", "")
    write("project/meshes/m.stl", STL)
    write("shared/m.stl", STL)
    inside = link(tmp_path / "home/project/linked/inside.stl", "../meshes/m.stl")
    across = link(tmp_path / "home/project/linked/across.stl", tmp_path / "home/shared/m.stl")
    for mesh in (inside, across):
        world = write("project/worlds/w.sdf", WORLD.format(MESH.format(f"../linked/{mesh.name}")))
        assert problems(world, resource_paths=[tmp_path / "home/shared"]) == []


def test_a_world_that_is_itself_a_link_loads(write: Write, tmp_path: Path) -> None:
    write("private/w.sdf", WORLD.format(""))
    assert problems(link(tmp_path / "home/w.sdf", tmp_path / "home/private/w.sdf")) == []


# ---------------------------------------------------------------------- links that are refused


def test_a_refused_link_is_an_error_that_names_the_option_to_allow_it(write: Write, tmp_path: Path) -> None:
    private = tmp_path / "home/private"
    link(tmp_path / "home/project/meshes/m.stl", private / "m.stl")
    world = write("project/w.sdf", WORLD.format(MESH.format("meshes/m.stl")))
    (found,) = [d for d in simkit.check(world) if d.severity == "error"]
    assert (found.code, found.line) == ("SK-URI-003", 1)
    assert str(private / "m.stl") in found.message
    assert found.hint == f"to allow it, use --resource-path {private}"
    assert problems(world, resource_paths=[private]) == []


@pytest.mark.parametrize("name", ["model.config", "manifest.xml", "model.sdf", "m.sdf", "m.urdf", "m.xml"])
def test_no_file_of_a_model_folder_is_read_through_a_link(write: Write, tmp_path: Path, name: str) -> None:
    write(f"private/{name}", MODEL.format("hidden").replace("<link", "<hidden_element/><link"))
    link(tmp_path / f"home/project/models/m/{name}", tmp_path / f"home/private/{name}")
    world = write("project/w.sdf", WORLD.format("<include><uri>model://m</uri></include>"))
    found = [str(d) for d in simkit.check(world, resource_paths=[tmp_path / "home/project/models"])]
    assert any("SK-URI-005" in text for text in found)
    assert not any("hidden" in text for text in found)


@pytest.mark.parametrize("sdf", ["{}", "//{}", "..%2F..%2F..%2Fprivate/secret.sdf", "../../../private/secret.sdf"])
def test_a_manifest_cannot_name_a_file_outside_of_its_folder(write: Write, sdf: str) -> None:
    secret = write("private/secret.sdf", MODEL.format("hidden"))
    write("project/models/m/model.config", f"<model><name>m</name><sdf>{sdf.format(secret)}</sdf></model>")
    world = write("project/w.sdf", WORLD.format("<include><uri>model://m</uri></include>"))
    assert "SK-URI-005" in problems(world)


def test_the_manifest_of_a_package_is_not_read_through_a_link(write: Write, tmp_path: Path) -> None:
    write("private/package.xml", "<package><name>hidden_name</name></package>")
    package(write, "ws/src/mine", "mine", "package://name/m.stl")
    link(tmp_path / "home/ws/src/other/package.xml", tmp_path / "home/private/package.xml")
    found = [str(d) for d in simkit.check(tmp_path / "home/ws/src/mine/urdf/r.urdf")]
    assert not any("hidden_name" in text for text in found)


def test_a_link_of_a_project_to_a_package_of_the_user_is_not_a_package_of_the_project(
    write: Write, tmp_path: Path
) -> None:
    private = package(write, "other/own_work", "own_work")
    package(write, "project", "project", "package://own_work/meshes/m.stl")
    for place in ("own_work", "models/own_work", "deps/own_work"):
        link(tmp_path / "home/project" / place, private)
    assert "SK-URI-003" in problems(tmp_path / "home/project/urdf/r.urdf")
    world = write("project/w.sdf", WORLD.format(MESH.format("model://own_work/meshes/m.stl")))
    assert "SK-URI-003" in problems(world)


def test_a_link_in_the_place_of_a_folder_of_models_or_of_a_workspace_does_not_open_its_target(
    write: Write, tmp_path: Path
) -> None:
    package(write, "other/own_work", "own_work")
    for place in ("models", "src", "build", "own"):
        link(tmp_path / "home/project/install/share" / place, tmp_path / "home/other")
        link(tmp_path / "home/project" / place, tmp_path / "home/other")
    for uri in (
        "model://own_work/meshes/m.stl",
        "package://own_work/meshes/m.stl",
        "models/own_work/meshes/m.stl",
        "model://own/own_work/meshes/m.stl",
        "package://x/own_work/meshes/m.stl",
    ):
        for folder in ("project", "project/install/share", "project/worlds"):
            world = write(f"{folder}/w.sdf", WORLD.format(MESH.format(uri)))
            assert problems(world) != [], (folder, uri)


def test_a_pattern_of_xacro_and_a_folder_of_scripts_skip_links(write: Write, tmp_path: Path) -> None:
    write("private/x.xacro", XACRO.format('<link name="hidden"/>'))
    link(tmp_path / "home/project/parts/x.xacro", tmp_path / "home/private/x.xacro")
    robot = write("project/r.xacro", XACRO.format('<link name="a"/><xacro:include filename="parts/*.xacro"/>'))
    assert "SK-XACRO-002" in problems(robot)
    write("private/own.material", "material Own/Red\n{\n}\n")
    link(tmp_path / "home/project/scripts/own.material", tmp_path / "home/private/own.material")
    script = "<material><script><uri>scripts</uri><name>Own/Red</name></script></material>"
    box = "<geometry><box><size>1 1 1</size></box></geometry>"
    visual = f'<model name="m"><static>1</static><link name="l"><visual name="v">{box}{script}</visual></link></model>'
    found = [d.code for d in simkit.check(write("project/w.sdf", WORLD.format(visual)))]
    assert "SK-SDF-021" in found


def test_models_behind_a_link_are_not_listed(write: Write, tmp_path: Path) -> None:
    write("private/secret_model/model.sdf", MODEL.format("m"))
    write("project/models/plain/model.sdf", MODEL.format("m"))
    link(tmp_path / "home/project/models/linked", tmp_path / "home/private/secret_model")
    names = spawnable_models(Resolver(base=tmp_path / "home/project"))
    assert "plain" in names
    assert "linked" not in names


# ---------------------------------------------------------------------- copies and downloads


def everything_in(folder: Path) -> str:
    return "".join(str(f) + f.read_text("utf-8", "replace") for f in folder.rglob("*") if f.is_file())


def test_a_vendored_folder_has_no_licence_and_no_script_that_a_link_leads_to(write: Write, tmp_path: Path) -> None:
    secret = write("private/LICENSE", "hidden")
    for place in ("project/LICENSE", "project/models/m/LICENSE.txt", "project/scripts/more.material"):
        link(tmp_path / "home" / place, secret)
    write("project/models/m/model.sdf", MODEL.format("m"))
    write("project/scripts/own.material", "material Own/Red\n{\n}\n")
    script = "<material><script><uri>./scripts</uri><name>Own/Red</name></script></material>"
    box = "<geometry><box><size>1 1 1</size></box></geometry>"
    visual = f'<model name="n"><static>1</static><link name="l"><visual name="v">{box}{script}</visual></link></model>'
    world = write("project/w.sdf", WORLD.format(f"<include><uri>model://m</uri></include>{visual}"))
    vendor(str(world), tmp_path / "out", simkit.describe)
    copied = everything_in(tmp_path / "out")
    assert "own.material" in copied
    assert "hidden" not in copied


def test_a_vendored_mjcf_file_has_no_file_of_another_folder_with_the_name_of_a_package(
    write: Write, tmp_path: Path
) -> None:
    """An absolute path may mean the same file of a package here; the file at the path itself is not copied."""
    secret = write("private/m.stl", STL.replace(bytes(80), b"hidden".ljust(80)))
    write("private/package.xml", "<package><name>other</name></package>")
    write("project/private/m.stl", STL)
    write("project/private/package.xml", "<package><name>private</name></package>")
    write("project/.git/config", "")
    mesh = '<mujoco><asset><mesh name="q" file="{}" inertia="shell"/></asset><worldbody>'
    robot = write(
        "project/r.xml", mesh.format(secret) + '<body><geom type="mesh" mesh="q"/></body></worldbody></mujoco>'
    )
    try:
        vendor(str(robot), tmp_path / "out", simkit.describe)
    except simkit.errors.InputError:
        shutil.rmtree(tmp_path / "out", ignore_errors=True)
    assert "hidden" not in everything_in(tmp_path / "out")


@pytest.mark.needs_packs
def test_a_value_of_a_yaml_file_of_the_user_is_not_sent_to_a_server(
    write: Write, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    secret = write("private/s.yaml", "secret: hunter2\n")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("GZ_FUEL_CACHE_PATH", str(tmp_path / "cache"))
    link(tmp_path / "home/project/linked.yaml", secret)
    answers = []
    with served() as fuel:
        for spelling in (f"package://turtlebot3_description/{secret}", "linked.yaml", str(secret)):
            content = (
                f'<xacro:property name="y" value="${{xacro.load_yaml(\'{spelling}\')}}"/>'
                '<link name="a"><visual><geometry><mesh filename="http://127.0.0.1:'
                f"{fuel.port}/1.0/o/models/${{y['secret']}}/files/m.stl\"/></geometry></visual></link>"
            )
            answers.append(run("fetch", str(write("project/r.xacro", XACRO.format(content)))))
        requests = list(fuel.requests)
    assert requests == []
    assert [answer.exit_code for answer in answers] == [2, 2, 2]
    assert not any("hunter2" in answer.output for answer in answers)


def test_a_lock_file_that_is_a_link_is_not_read(write: Write, tmp_path: Path) -> None:
    link(tmp_path / "home/project/simkit.lock", write("private/secret.json", "hidden"))
    world = write("project/w.sdf", WORLD.format(MESH.format("https://fuel.gazebosim.org/1.0/o/models/m/files/m.stl")))
    assert "SK-FETCH-007" not in problems(world)


def test_types_of_messages_are_not_read_through_a_link(write: Write, tmp_path: Path) -> None:
    from simkit.loaders.resources.world_interfaces import read_interfaces
    from simkit.msgs import own_interfaces

    link(tmp_path / "home/project/pkg/msg/Bad.msg", write("private/Bad.msg", "hidden text"))
    world = write("project/w.sdf", WORLD.format(""))
    read_interfaces([], world, Resolver(), Diagnostics())
    assert [find("pkg", "msg/Bad.msg") for find in own_interfaces._finders] == [None]
