"""Packages in workspaces as people have them: names, groups, installs, duplicates, limits, and given folders."""

from __future__ import annotations

from pathlib import Path

import pytest
from urdf_robots import MASS, errors, link, robot, with_code

import simkit
from simkit.errors import InputError
from simkit.loaders import Resolver, load_scene
from simkit.loaders.resources import ros_packages
from simkit.loaders.resources.bundled_models import bundled_folders
from simkit.run_spec import PackagePaths


@pytest.fixture(autouse=True)
def _no_search_paths(monkeypatch):
    for name in ("SIMKIT_RESOURCE_PATH", "GZ_SIM_RESOURCE_PATH", "GAZEBO_MODEL_PATH", "ROS_PACKAGE_PATH"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)


@pytest.fixture
def package(write):
    """Return a function package(path, name) that writes a package with one mesh, whose text is the path."""

    def _package(path: str, name: str = "") -> Path:
        write(f"{path}/meshes/m.stl", path)
        return write(f"{path}/package.xml", f"<package><name>{name or Path(path).name}</name></package>").parent

    return _package


@pytest.fixture
def used(write):
    """Return a function used(file, uri, package_paths) -> (package whose mesh a robot uses, notes and warnings)."""

    def _used(file: str, uri: str, package_paths: PackagePaths | None = None) -> tuple[str, list[simkit.Diagnostic]]:
        mesh = f'<visual><geometry><mesh filename="{uri}"/></geometry></visual>'
        path = write(file, robot(link("l", MASS + mesh)))
        diagnostics = simkit.diagnostics.Diagnostics()
        scene = load_scene(path, resolver=Resolver(package_paths=package_paths), diagnostics=diagnostics)
        assert not errors(list(diagnostics))
        shape = scene.model.links[0].visuals[0].geometry
        return "" if shape.missing else shape.file.read_text(), list(diagnostics)

    return _used


ROBOT = "ws/src/mine/robot/urdf/r.urdf"
MESH = "package://{}/meshes/m.stl"


@pytest.mark.parametrize(
    "path, name",
    [
        ("ws/src/sensors", "sensors"),
        ("ws/src/sensors-main", "sensors"),
        ("ws/src/vendor/sensors", "sensors"),
        ("ws/src/vendor/group/sensors", "sensors"),
        ("ws/src/vendor/group/folder-of-any-name", "sensors"),
        ("ws/install/share/sensors", "sensors"),
        ("ws/install/sensors/share/sensors", "sensors"),
    ],
)
def test_a_package_is_found_anywhere_in_the_workspace_of_the_file(package, used, path, name):
    package("ws/src/mine/robot")
    package(path, name)
    content, found = used(ROBOT, MESH.format("sensors"))
    assert content == path
    assert [d.code for d in found if d.code.startswith("SK-URI")] == []


def test_a_package_is_found_in_repositories_beside_the_repository_of_the_file(package, used):
    package("code/mine/robots/robot")
    package("code/vendor/group/sensors")
    assert used("code/mine/robots/robot/urdf/r.urdf", MESH.format("sensors"))[0] == "code/vendor/group/sensors"


def test_a_package_is_found_below_a_repository_whose_file_is_in_no_package(package, used, write):
    write("code/mine/.git/HEAD", "")
    package("code/mine/packages/sensors")
    assert used("code/mine/robots/r.urdf", MESH.format("sensors"))[0] == "code/mine/packages/sensors"


def test_the_name_in_package_xml_counts_before_the_name_of_the_folder(package, used):
    package("ws/src/mine/robot")
    package("ws/src/sensors", "other")
    package("ws/src/vendor/x", "sensors")
    assert used(ROBOT, MESH.format("sensors"))[0] == "ws/src/vendor/x"


def test_a_folder_of_the_name_without_package_xml_is_found_in_a_workspace_of_the_user(used, write, tmp_path):
    write("ws/sensors/meshes/m.stl", "ws/sensors")
    assert used("robots/r.urdf", MESH.format("sensors"), [tmp_path / "ws"])[0] == "ws/sensors"


@pytest.mark.parametrize(
    "folder, name, asked",
    [
        ("lms1xx", "lms1xx", "LMS1xx"),
        ("LMS1xx", "LMS1xx", "lms1xx"),
        ("sick", "lms1xx_driver", "sick"),
        ("panda_description", "moveit_resources_panda_description", "panda_description"),
        ("panda", "moveit_resources_panda_description", "panda_description"),
        ("moveit_resources/panda_description", "panda_description", "moveit_resources_panda_description"),
    ],
)
def test_another_name_is_used_as_the_last_resort_and_noted_once(package, used, folder, name, asked):
    package("ws/src/mine/robot")
    package(f"ws/src/vendor/{folder}", name)
    content, found = used(ROBOT, MESH.format(asked))
    assert content == f"ws/src/vendor/{folder}"
    (note,) = (d for d in found if d.code.startswith("SK-URI"))
    assert (note.code, note.severity) == ("SK-URI-011", "note")
    assert f"no package is named {asked}; the package {name} in " in note.message


def test_a_folder_of_a_former_package_is_found_as_a_package_of_the_group(package, used):
    package("ws/src/mine/robot")
    package("ws/src/moveit_resources/moveit_resources", "moveit_resources")
    package("ws/src/moveit_resources/panda_description", "moveit_resources_panda_description")
    content, found = used(ROBOT, "package://moveit_resources/panda_description/meshes/m.stl")
    assert content == "ws/src/moveit_resources/panda_description"
    assert len(with_code(found, "SK-URI-011")) == 1


@pytest.mark.parametrize("names", [("a_panda_description", "b_panda_description"), ("description", "tools")])
def test_a_name_that_is_similar_to_several_or_none_is_not_found(package, used, names):
    package("ws/src/mine/robot")
    for name in names:
        package(f"ws/src/{name}")
    content, found = used(ROBOT, MESH.format("panda_description"))
    assert content == ""
    assert [d.code for d in found if d.code.startswith("SK-URI")] == ["SK-URI-009"]


def test_of_two_packages_of_one_name_the_nearer_one_is_used_with_a_note(package, used):
    package("ws/src/mine/robot")
    package("ws/src/a/sensors")
    package("ws/src/mine/sensors")
    content, found = used(ROBOT, MESH.format("sensors"))
    assert content == "ws/src/mine/sensors"
    (note,) = with_code(found, "SK-URI-011")
    assert note.message.count("sensors") == 3 and "ws/src/a/sensors" in note.message
    assert "--package-path NAME=DIR" in note.hint


def test_an_installed_or_ignored_copy_of_a_source_is_not_used_and_not_noted(package, used, write):
    package("ws/src/mine/robot")
    package("ws/install/sensors/share/sensors")
    write(f"{package('ws/src/mine/a')}/../sensors_ros1/COLCON_IGNORE", "")
    package("ws/src/mine/sensors_ros1", "sensors")
    package("ws/src/z/deep/sensors")
    content, found = used(ROBOT, MESH.format("sensors"))
    assert content == "ws/src/z/deep/sensors"
    assert with_code(found, "SK-URI-011") == []


def test_a_package_of_stranger_folders_above_the_workspace_is_not_searched(package, used):
    package("ws/src/mine/robot")
    package("stranger/sensors")
    assert used(ROBOT, MESH.format("sensors"))[0] == ""


@pytest.mark.parametrize("other", ["lib/site-packages/other/share/sensors", "lib/site-packages/sensors"])
def test_a_robot_in_an_installed_python_package_finds_the_packages_of_its_own_python_package_only(package, used, other):
    own = "lib/site-packages/robots/share"
    package(f"{own}/robot")
    package(f"{own}/cameras")
    package(other)
    file = f"{own}/robot/urdf/r.urdf"
    assert used(file, MESH.format("cameras"))[0] == f"{own}/cameras"
    assert used(file, MESH.format("sensors"))[0] == ""


def test_a_shipped_file_finds_shipped_packages_and_none_of_the_workspace_of_a_checkout():
    worlds, labs = (bundled_folders(kind)[0] for kind in ("worlds", "labs"))
    index = Resolver().packages
    assert [folder.name for folder in index.packages([labs / "02_interfaces"])] == ["lab_interfaces"]
    assert [*index.packages([worlds])] == []


@pytest.mark.parametrize("folder", ["bin", "include", "lib"])
def test_packages_of_an_install_are_searched_in_share_and_not_in_headers_or_libraries(package, used, folder):
    package("opt/distribution/share/robot")
    package(f"opt/distribution/{folder}/sensors")
    file = "opt/distribution/share/robot/urdf/r.urdf"
    assert used(file, MESH.format("sensors"))[0] == ""
    package("opt/distribution/share/deep/sensors")
    assert used(file, MESH.format("sensors"))[0] == "opt/distribution/share/deep/sensors"


def test_the_home_folder_is_not_searched(package, used, monkeypatch, tmp_path):
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    package("home/mine/robot")
    package("home/other/sensors")
    assert used("home/mine/robot/urdf/r.urdf", MESH.format("sensors"))[0] == ""


def test_a_search_is_made_once_and_ends_at_its_limit(package, used, monkeypatch, write):
    scans: list[Path] = []
    subfolders = ros_packages._subfolders
    monkeypatch.setattr(ros_packages, "_subfolders", lambda folder: scans.append(folder) or subfolders(folder))
    package("ws/src/mine/robot")
    meshes = "".join(
        f'<visual name="v{i}"><geometry><mesh filename="package://p{i}/m.stl"/></geometry></visual>' for i in range(20)
    )
    file = write(ROBOT, robot(link("l", MASS + meshes)))
    load_scene(file, resolver=Resolver(), diagnostics=simkit.diagnostics.Diagnostics())
    assert 0 < len(scans) < 20
    for number in range(40):
        (file.parents[3] / f"f{number}").mkdir()
    package("ws/src/z/z/sensors")
    monkeypatch.setattr(ros_packages, "_MAX_FOLDERS", 30)
    content, found = used(ROBOT, MESH.format("sensors"))
    assert content == ""
    (problem,) = with_code(found, "SK-URI-009")
    assert f"the search below {file.parents[3]}, {file.parents[4]} ended at its limit" in problem.message


# ---------------------------------------------------------------------- models and media of packages


def test_the_models_of_a_package_in_the_workspace_are_found(write, package):
    package("ws/src/worlds")
    package("ws/src/vendor/furniture")
    write("ws/src/vendor/furniture/models/table/model.config", "<model><sdf version='1.9'>model.sdf</sdf></model>")
    write(
        "ws/src/vendor/furniture/models/table/model.sdf",
        '<sdf version="1.9"><model name="table"><link name="l"/></model></sdf>',
    )
    world = '<sdf version="1.9"><world name="w"><include><uri>model://table</uri></include></world></sdf>'
    with simkit.load(write("ws/src/worlds/worlds/w.sdf", world)) as sim:
        assert [model.name for model in sim.world.models] == ["table"]


def test_a_model_in_the_folder_models_beside_a_world_without_a_package_is_found(write):
    model = '<sdf version="1.9"><model name="table"><link name="l"/></model></sdf>'
    write("downloads/models/table/model.config", "<model><sdf version='1.9'>model.sdf</sdf></model>")
    write("downloads/models/table/model.sdf", model)
    world = '<sdf version="1.9"><world name="w"><include><uri>model://table</uri></include></world></sdf>'
    with simkit.load(write("downloads/w.sdf", world)) as sim:
        assert [model.name for model in sim.world.models] == ["table"]


@pytest.mark.parametrize("place", ["task/Media/models", "task/worlds/media"])
def test_a_relative_file_is_found_in_a_media_folder_beside_a_world_without_a_package(write, place):
    write("league/.git/HEAD", "")
    write(f"league/{place}/m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    mesh = '<visual name="v"><geometry><mesh><uri>file://m.obj</uri></mesh></geometry></visual>'
    model = f'<model name="m"><static>true</static><link name="l">{mesh}</link></model>'
    world = write("league/task/worlds/w.sdf", f'<sdf version="1.9"><world name="w">{model}</world></sdf>')
    with simkit.load(world) as sim:
        assert [d.code for d in sim.diagnostics if d.code.startswith("SK-URI")] == ["SK-URI-010"]


@pytest.mark.parametrize("place", ["models", "models/team"])
def test_a_model_of_the_repository_is_found_from_a_world_deeper_in_it(write, place):
    write("ws/league/.git/HEAD", "")
    write(f"ws/league/{place}/table/model.config", "<model><sdf version='1.9'>model.sdf</sdf></model>")
    model = '<sdf version="1.9"><model name="table"><link name="l"/></model></sdf>'
    write(f"ws/league/{place}/table/model.sdf", model)
    world = '<sdf version="1.9"><world name="w"><include><uri>model://table</uri></include></world></sdf>'
    with simkit.load(write("ws/league/worlds/team/w.sdf", world)) as sim:
        assert [model.name for model in sim.world.models] == ["table"]


@pytest.mark.parametrize("place, links", [("ws/other/plant", 1), ("ws/league/plant", 2)])
def test_a_ground_plane_of_another_repository_does_not_replace_the_built_in_one(write, package, place, links):
    write("ws/league/.git/HEAD", "")
    package("ws/league/worlds")
    package(place)
    config = "<model><sdf version='1.9'>model.sdf</sdf></model>"
    write(f"{place}/models/ground_plane/model.config", config)
    model = '<model name="ground_plane"><static>true</static><link name="a"/><link name="b"/></model>'
    write(f"{place}/models/ground_plane/model.sdf", f'<sdf version="1.9">{model}</sdf>')
    world = '<sdf version="1.9"><world name="w"><include><uri>model://ground_plane</uri></include></world></sdf>'
    with simkit.load(write("ws/league/worlds/worlds/w.sdf", world)) as sim:
        assert len(sim.model("ground_plane").links) == links


@pytest.mark.parametrize("folder", ["Media/models", "media"])
def test_a_relative_file_is_found_in_the_media_folder_of_the_package(write, used, package, folder):
    package("ws/src/mine/robot")
    write(f"ws/src/mine/robot/{folder}/race.stl", "race")
    assert used(ROBOT, "file://race.stl")[0] == "race"
    assert used(ROBOT, "file://../race.stl")[0] == ""


# ---------------------------------------------------------------------- folders given by the user


@pytest.mark.parametrize("given", ["ws", "ws/src", "ws/src/vendor", "ws/src/vendor/group/sensors"])
def test_a_workspace_given_without_a_name_is_searched_first(package, used, tmp_path, given):
    package("near/robot")
    package("near/sensors")
    package("ws/src/vendor/group/sensors")
    content, found = used("near/robot/r.urdf", MESH.format("sensors"), [tmp_path / given])
    assert content == "ws/src/vendor/group/sensors"
    assert with_code(found, "SK-URI-011") == []


def test_a_list_can_hold_names_and_workspaces_and_a_name_has_priority(package, used, tmp_path):
    one, _ = package("a/sensors"), package("ws/sensors")
    paths = [str(tmp_path / "ws"), f"sensors={one}"]
    assert used("here/r.urdf", MESH.format("sensors"), paths)[0] == "a/sensors"


def test_all_functions_take_a_workspace_and_the_command_line_too(package, write, tmp_path, capsys):
    from simkit.cli import app

    def command(*arguments: object) -> None:
        app([str(a) for a in arguments])

    package("ws/src/group/sensors")
    mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"
    write("ws/src/group/sensors/meshes/m.obj", mesh)
    shape = '<visual><geometry><mesh filename="package://sensors/meshes/m.obj"/></geometry></visual>'
    file = write("here/r.urdf", robot(link("l", MASS + shape)))
    paths = [tmp_path / "ws"]
    used = simkit.describe(file, package_paths=paths)["model"]["links"][0]["visuals"][0]["geom"]["file"]
    assert used == str(tmp_path / "ws/src/group/sensors/meshes/m.obj")
    assert not [d for d in simkit.check(file, package_paths=paths) if d.code.startswith("SK-URI")]
    with simkit.load(file, package_paths=paths) as sim:
        assert list(sim.run_spec.options["package_paths"]) == paths
    with pytest.raises(SystemExit) as ended:
        command("check", file, "--package-path", tmp_path / "ws", "--strict")
    assert ended.value.code == 0
    with pytest.raises(SystemExit) as ended:
        command("check", file, "--package-path", tmp_path / "nothing")
    assert ended.value.code == 2
    assert "expected NAME=DIR or a folder that exists" in "".join(capsys.readouterr())
    with pytest.raises(InputError):
        simkit.load(file, package_paths=["nothing"])
    with pytest.raises(simkit.errors.ArgumentTypeError):
        simkit.load(file, package_paths="nothing")  # type: ignore[arg-type]


def test_a_file_finds_the_install_without_a_package_file_that_contains_it(used, write):
    write("env/share/robots/models/arm/parts/m.stl", "own")
    write("env/other/robots/models/arm/parts/m.stl", "own")
    uri = "package://robots/models/arm/parts/m.stl"
    assert used("env/share/robots/models/arm/r.urdf", uri)[0] == "own"
    assert used("env/other/robots/models/arm/r.urdf", uri)[0] == ""  # any folder of that name is not enough


def test_a_name_in_other_case_is_suggested_for_a_missing_file(write, used, package):
    package("ws/robot")
    write("ws/robot/meshes/Base.STL", "own")
    content, found = used("ws/robot/urdf/r.urdf", "package://robot/meshes/base.stl")
    (problem,) = with_code(found, "SK-URI-001")
    assert (content, problem.hint) == ("", "did you mean 'Base.STL'? Upper and lower case differ")
