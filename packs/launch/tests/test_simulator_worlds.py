"""Worlds are found by the names that Gazebo has for them; packages export the folders of their models."""

from __future__ import annotations

from pathlib import Path

import pytest

from simkit.loaders.resources.bundled_models import bundled_folders
from simkit_launch.environment_hooks import workspace_variables
from simkit_launch.launch_environment import environment_folders
from simkit_launch.launch_plan import LaunchedProcess, LaunchPlan
from simkit_launch.run_plan import run_spec_of
from simkit_launch.simulator_worlds import exported_folders, find_world
from simkit_nodes.workspace import Workspace

SHIPPED = Path(bundled_folders("packages")[0])


@pytest.mark.parametrize(
    ("name", "file"),
    [
        ("shapes.sdf", SHIPPED / "ros_gz_sim/worlds/shapes.sdf"),
        ("worlds/empty.world", SHIPPED / "gazebo_ros/worlds/empty.world"),
        ("worlds/shapes.world", SHIPPED / "gazebo_ros/worlds/shapes.world"),
        ("worlds/willowgarage.world", None),
    ],
)
def test_a_world_of_gazebo_has_a_name(name: str, file: Path | None) -> None:
    assert find_world(name, None, ()) == file


def test_a_name_of_gazebo_can_also_be_that_of_a_world_of_simkit() -> None:
    found = find_world("empty.sdf", None, ())
    assert found is not None and (found.parent.name, found.name) == ("worlds", "empty.sdf")


def test_the_working_directory_comes_first_then_the_search_folders(tmp_path: Path) -> None:
    for folder in ("here", "there", "there/worlds"):
        (tmp_path / folder).mkdir(exist_ok=True)
    (tmp_path / "there/worlds/shapes.sdf").touch()
    assert find_world("shapes.sdf", tmp_path / "here", [str(tmp_path / "there")]) == (
        tmp_path / "there/worlds/shapes.sdf"
    )
    (tmp_path / "here/shapes.sdf").touch()
    assert find_world("shapes.sdf", tmp_path / "here", [str(tmp_path / "there")]) == tmp_path / "here/shapes.sdf"


def test_an_absolute_path_is_no_name(tmp_path: Path) -> None:
    assert find_world(str(tmp_path / "shapes.sdf"), None, ()) is None


def test_packages_export_folders_of_models(tmp_path: Path) -> None:
    """The manifest has `${prefix}`; a hook names folders of the installation, and its comments count for nothing."""
    package = tmp_path / "src" / "farm"
    for folder in ("models", "media", "worlds", "hooks"):
        (package / folder).mkdir(parents=True)
    exports = (
        '<export><gazebo_ros gazebo_model_path="${prefix}/models:${prefix}/absent" plugin_path="${prefix}"/></export>'
    )
    (package / "package.xml").write_text(f"<package><name>farm</name>{exports}</package>", encoding="utf-8")
    (package / "hooks" / "farm.dsv.in").write_text(
        "# prepend-non-duplicate;GZ_SIM_RESOURCE_PATH;share/@PROJECT_NAME@/media\n"
        "prepend-non-duplicate;GZ_SIM_RESOURCE_PATH;share/@PROJECT_NAME@/worlds\n"
        "prepend-non-duplicate;GAZEBO_MODEL_PATH;share\n"
        "prepend-non-duplicate;LD_LIBRARY_PATH;share/farm/media\n",
        encoding="utf-8",
    )
    workspace = Workspace(package)
    assert list(exported_folders(workspace)) == [str(package / "models")]
    of_hooks = list(environment_folders(workspace_variables(workspace.packages()).items()))
    assert of_hooks == [str(package / "worlds"), str(package.parent)]


def test_variables_of_a_simulator_name_folders_of_models(tmp_path: Path) -> None:
    """Folders that do not exist are no folders of the run."""
    environment = {"GZ_SIM_RESOURCE_PATH": f":{tmp_path}:/no/such/folder", "PATH": str(tmp_path)}
    assert list(environment_folders(environment.items())) == [str(tmp_path), "/no/such/folder"]
    plan = LaunchPlan(tmp_path / "robot.launch")
    words = ("gz", "sim", "-r", "empty.sdf")
    plan.processes.append(LaunchedProcess(1, "command", arguments=words, environment=environment))
    assert run_spec_of(plan).options["resource_paths"] == (str(tmp_path),)


def test_level_ground_replaces_a_world_that_is_not_there(tmp_path: Path) -> None:
    plan = LaunchPlan(tmp_path / "robot.launch")
    plan.processes.append(LaunchedProcess(1, "command", arguments=("gzserver", "worlds/willowgarage.world")))
    assert run_spec_of(plan).world == "empty"
    (warning,) = plan.diagnostics
    assert warning.code == "SK-LAUNCH-044"
    assert "worlds/willowgarage.world" in warning.message


def test_packages_of_gazebo_are_found_last(tmp_path: Path) -> None:
    (tmp_path / "ros_gz_sim").mkdir()
    assert Workspace(tmp_path).package("ros_gz_sim") == SHIPPED / "ros_gz_sim"
    (tmp_path / "ros_gz_sim" / "package.xml").write_text("<package><name>ros_gz_sim</name></package>", encoding="utf-8")
    assert Workspace(tmp_path / "ros_gz_sim").package("ros_gz_sim") == tmp_path / "ros_gz_sim"


def test_level_ground_replaces_a_world_none_of_whose_models_is_there(tmp_path: Path) -> None:
    """The name of the world remains, because topics and services of Gazebo begin with it."""
    world = tmp_path / "depot.sdf"
    content = "<include><uri>https://fuel.gazebosim.org/1.0/Nobody/models/Depot</uri></include>"
    world.write_text(f'<sdf version="1.9"><world name="depot">{content}</world></sdf>', encoding="utf-8")
    plan = LaunchPlan(tmp_path / "robot.launch.py")
    plan.processes.append(LaunchedProcess(1, "command", arguments=("gz", "sim", "-r", str(world))))
    spec = run_spec_of(plan)
    assert '<world name="depot">' in str(spec.world)
    assert "ground_plane" in str(spec.world)
    (warning,) = plan.diagnostics
    assert (warning.code, warning.hint) == ("SK-LAUNCH-044", f"download its models: simkit fetch {world}")
