"""Parameters of MoveIt from the files of a configuration package."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from simkit_launch.launch_modules.launch.substitution import Substitution
from simkit_launch.launch_modules.launch.substitutions import Command
from simkit_launch.launch_modules.launch_param_builder import ParameterBuilder, load_xacro, load_yaml
from simkit_launch.launch_modules.launch_ros.parameter_descriptions import ParameterValue
from simkit_launch.planner import current_planner

__all__ = ["MoveItConfigs", "MoveItConfigsBuilder"]

_SETUP_FILE = ".setup_assistant"
_DEFAULT_PIPELINES = ("ompl", "pilz_industrial_motion_planner", "chomp", "stomp")


@dataclass
class MoveItConfigs:
    """Parameters of MoveIt.

    Attributes:
        package_path: folder of the configuration package.
        robot_description: description of the robot.
        robot_description_semantic: groups of joints, and pairs of links that may touch.
        robot_description_kinematics: solvers of inverse kinematics.
        planning_pipelines: planners.
        trajectory_execution: controllers of the trajectories.
        planning_scene_monitor: topics of the planning scene.
        sensors_3d: sensors of the planning scene.
        move_group_capabilities: capabilities that are added and removed.
        joint_limits: limits of joints.
        moveit_cpp: parameters of MoveItCpp.
        pilz_cartesian_limits: limits of the planner Pilz.
    """

    package_path: Path | None = None
    robot_description: dict[str, Any] = field(default_factory=dict)
    robot_description_semantic: dict[str, Any] = field(default_factory=dict)
    robot_description_kinematics: dict[str, Any] = field(default_factory=dict)
    planning_pipelines: dict[str, Any] = field(default_factory=dict)
    trajectory_execution: dict[str, Any] = field(default_factory=dict)
    planning_scene_monitor: dict[str, Any] = field(default_factory=dict)
    sensors_3d: dict[str, Any] = field(default_factory=dict)
    move_group_capabilities: dict[str, Any] = field(
        default_factory=lambda: {"capabilities": "", "disable_capabilities": ""}
    )
    joint_limits: dict[str, Any] = field(default_factory=dict)
    moveit_cpp: dict[str, Any] = field(default_factory=dict)
    pilz_cartesian_limits: dict[str, Any] = field(default_factory=dict)

    @property
    def cartesian_limits(self) -> dict[str, Any]:
        """Limits of the planner Pilz, by their older name."""
        return self.pilz_cartesian_limits

    def to_dict(self) -> dict[str, Any]:
        """Return all parameters."""
        parameters: dict[str, Any] = {}
        for each in (
            self.robot_description,
            self.robot_description_semantic,
            self.robot_description_kinematics,
            self.planning_pipelines,
            self.trajectory_execution,
            self.planning_scene_monitor,
            self.sensors_3d,
            self.joint_limits,
            self.moveit_cpp,
        ):
            parameters.update(each)
        for name, value in self.pilz_cartesian_limits.items():
            before = parameters.get(name)
            parameters[name] = {**before, **value} if isinstance(before, dict) else value
        return parameters


class MoveItConfigsBuilder(ParameterBuilder):
    """Reader of the files of a configuration package; a file that is not there leaves its parameters empty.

    Args:
        robot_name: name of the robot; its package is `NAME_moveit_config`.
        robot_description: name of the parameter with the description of the robot.
        package_name: package, if it has another name.
    """

    def __init__(
        self, robot_name: str, robot_description: str = "robot_description", package_name: str | None = None
    ) -> None:
        super().__init__(package_name or f"{robot_name}_moveit_config")
        self._robot, self._description = robot_name, robot_description
        self._configs = MoveItConfigs(package_path=self._package_path)
        self._urdf = self._package_path / "config" / f"{robot_name}.urdf"
        self._srdf = self._package_path / "config" / f"{robot_name}.srdf"
        self._urdf_arguments: dict[str, str] = {}
        if not self._urdf.is_file() and self._urdf.with_suffix(".urdf.xacro").is_file():
            self._urdf = self._urdf.with_suffix(".urdf.xacro")
        if (self._package_path / _SETUP_FILE).is_file():
            self._read_setup(load_yaml(self._package_path / _SETUP_FILE).get("moveit_setup_assistant_config", {}))

    def _read_setup(self, setup: Mapping[str, Any]) -> None:
        urdf = setup.get("urdf") or setup.get("URDF") or {}
        srdf = setup.get("srdf") or setup.get("SRDF") or {}
        if urdf.get("relative_path"):
            package = urdf.get("package")
            folder = current_planner().share_folder(package) if package else self._package_path
            self._urdf = folder / urdf["relative_path"]
        if srdf.get("relative_path"):
            self._srdf = self._package_path / srdf["relative_path"]
        words = str(urdf.get("xacro_args") or "").split()
        self._urdf_arguments = {name: value for name, _, value in (word.partition(":=") for word in words) if value}

    def _config(self, file_path: str | os.PathLike[str] | None, *names: str) -> dict[str, Any]:
        """Return the content of a given file, else of the first file in the folder `config` that exists."""
        if file_path is not None:
            return load_yaml(self._package_path / file_path)
        paths = [self._package_path / "config" / name for name in names]
        found = next((path for path in paths if path.is_file()), None)
        return {} if found is None else load_yaml(found)

    def _xacro(self, path: Path, mappings: Mapping[Any, Any] | None) -> Any:
        if not any(isinstance(value, Substitution) for value in (mappings or {}).values()):
            return load_xacro(path, mappings)
        words: list[Any] = ["xacro ", str(path)]
        for name, value in (mappings or {}).items():
            words += [f" {name}:=", value]
        return ParameterValue(Command(words), value_type=str)

    def robot_description(
        self, file_path: str | os.PathLike[str] | None = None, mappings: Mapping[Any, Any] | None = None
    ) -> MoveItConfigsBuilder:
        """Read the description of the robot."""
        path = self._urdf if file_path is None else self._package_path / file_path
        if mappings is None and file_path is None:
            mappings = self._urdf_arguments
        self._configs.robot_description = {self._description: self._xacro(path, mappings)}
        return self

    def robot_description_semantic(
        self, file_path: str | os.PathLike[str] | None = None, mappings: Mapping[Any, Any] | None = None
    ) -> MoveItConfigsBuilder:
        """Read the groups of joints."""
        path = self._srdf if file_path is None else self._package_path / file_path
        self._configs.robot_description_semantic = {f"{self._description}_semantic": self._xacro(path, mappings)}
        return self

    def robot_description_kinematics(self, file_path: str | os.PathLike[str] | None = None) -> MoveItConfigsBuilder:
        """Read the solvers of inverse kinematics."""
        values = self._config(file_path, "kinematics.yaml")
        self._configs.robot_description_kinematics = {f"{self._description}_kinematics": values}
        return self

    def joint_limits(self, file_path: str | os.PathLike[str] | None = None) -> MoveItConfigsBuilder:
        """Read the limits of joints."""
        values = self._config(file_path, "joint_limits.yaml")
        self._configs.joint_limits = {f"{self._description}_planning": values}
        return self

    def moveit_cpp(self, file_path: str | os.PathLike[str] | None = None) -> MoveItConfigsBuilder:
        """Read the parameters of MoveItCpp."""
        self._configs.moveit_cpp = self._config(file_path, "moveit_cpp.yaml")
        return self

    def trajectory_execution(
        self, file_path: str | os.PathLike[str] | None = None, moveit_manage_controllers: bool = True
    ) -> MoveItConfigsBuilder:
        """Read the controllers of the trajectories."""
        values = self._config(
            file_path, "moveit_controllers.yaml", f"{self._robot}_controllers.yaml", "controllers.yaml"
        )
        self._configs.trajectory_execution = {"moveit_manage_controllers": moveit_manage_controllers, **values}
        return self

    def planning_scene_monitor(
        self,
        publish_planning_scene: bool = True,
        publish_geometry_updates: bool = True,
        publish_state_updates: bool = True,
        publish_transforms_updates: bool = True,
        publish_robot_description: bool = False,
        publish_robot_description_semantic: bool = False,
    ) -> MoveItConfigsBuilder:
        """Set which topics the planning scene has."""
        self._configs.planning_scene_monitor = {
            "publish_planning_scene": publish_planning_scene,
            "publish_geometry_updates": publish_geometry_updates,
            "publish_state_updates": publish_state_updates,
            "publish_transforms_updates": publish_transforms_updates,
            "publish_robot_description": publish_robot_description,
            "publish_robot_description_semantic": publish_robot_description_semantic,
        }
        return self

    def sensors_3d(self, file_path: str | os.PathLike[str] | None = None) -> MoveItConfigsBuilder:
        """Read the sensors of the planning scene."""
        self._configs.sensors_3d = self._config(file_path, "sensors_3d.yaml")
        return self

    def planning_pipelines(
        self,
        default_planning_pipeline: str | None = None,
        pipelines: Sequence[str] | None = None,
        load_all: bool = True,
    ) -> MoveItConfigsBuilder:
        """Read the planners."""
        del load_all
        folder = self._package_path / "config"
        if pipelines is None:
            own = [path.name.removesuffix("_planning.yaml") for path in sorted(folder.glob("*_planning.yaml"))]
            pipelines = own or list(_DEFAULT_PIPELINES[:1])
        if default_planning_pipeline is None:
            default_planning_pipeline = "ompl" if "ompl" in pipelines else pipelines[0]
        if default_planning_pipeline not in pipelines:
            raise RuntimeError(
                f"default_planning_pipeline: `{default_planning_pipeline}` doesn't name any of the input pipelines "
                f"`{','.join(pipelines)}`"
            )
        self._configs.planning_pipelines = {
            "planning_pipelines": list(pipelines),
            "default_planning_pipeline": default_planning_pipeline,
            **{name: self._config(None, f"{name}_planning.yaml") for name in pipelines},
        }
        return self

    def pilz_cartesian_limits(self, file_path: str | os.PathLike[str] | None = None) -> MoveItConfigsBuilder:
        """Read the limits of the planner Pilz."""
        values = self._config(file_path, "pilz_cartesian_limits.yaml", "cartesian_limits.yaml")
        self._configs.pilz_cartesian_limits = {f"{self._description}_planning": values}
        return self

    cartesian_limits = pilz_cartesian_limits

    def to_moveit_configs(self) -> MoveItConfigs:
        """Return all parameters; those that were not asked for come from their usual files."""
        configs = self._configs
        for name in (
            "robot_description",
            "robot_description_semantic",
            "robot_description_kinematics",
            "planning_pipelines",
            "trajectory_execution",
            "planning_scene_monitor",
            "sensors_3d",
            "joint_limits",
        ):
            if not getattr(configs, name):
                getattr(self, name)()
        if "pilz_industrial_motion_planner" in configs.planning_pipelines and not configs.pilz_cartesian_limits:
            self.pilz_cartesian_limits()
        return configs

    def to_dict(self, include_moveit_configs: bool = True) -> dict[str, Any]:
        """Return all parameters, with those of MoveIt."""
        moveit = self.to_moveit_configs().to_dict() if include_moveit_configs else {}
        return {**self._parameters, **moveit}
