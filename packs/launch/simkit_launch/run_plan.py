"""Conversion of the plan of a launch file into one run: its world, and the programs that run in lock-step with it."""

from __future__ import annotations

import re
import tempfile
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, Final, cast

import yaml

from simkit.code_requests import CodeRequest
from simkit.errors import InputError
from simkit.extend import Diagnostics
from simkit.input_file import read_input_text
from simkit.run_files import PackagePaths
from simkit.run_nodes import ROS_ARGUMENTS
from simkit.run_spec import LoadOptions, RunSpec
from simkit_launch.command_nodes import resolved_process
from simkit_launch.initial_models import environment_of, loaded_model
from simkit_launch.launch_environment import environment_folders
from simkit_launch.launch_plan import LaunchedProcess, LaunchPlan, Parameters, StartCondition
from simkit_launch.robot_display import SHOWN_ROBOT, shows_robot, spawns_model
from simkit_launch.simulator_command import SimulatorCommand, simulator_command
from simkit_launch.simulator_worlds import exported_folders, find_world, level_ground, missing_models
from simkit_launch.temporary_files import write_run_file
from simkit_nodes.known_nodes import known_node
from simkit_nodes.names import RosArgumentsError, namespace_error, node_name_error, parse_remap_rule
from simkit_nodes.node_options import NodeOptions
from simkit_nodes.packages import Executable
from simkit_nodes.programs import program_source
from simkit_nodes.workspace import Workspace

NO_WORLD: Final = '<sdf version="1.9"><world name="empty"/></sdf>'
"""World of a launch file that starts no simulator."""
SHUTDOWN: Final = "simkit_launch/shutdown"
"""Known program that ends at once, for the action `Shutdown`."""
_PARAMETERS_ELEMENT: Final = re.compile(r"<parameters>\s*(/[^<\s]+)\s*</parameters>")


def run_spec_of(plan: LaunchPlan, package_paths: PackagePaths = ()) -> RunSpec:
    """Return the run of a plan; what cannot run is left out, with a warning in the plan's diagnostics.

    Args:
        plan: plan of a launch file.
        package_paths: folders of ROS packages by name, or workspaces, besides the one around the launch file.
    """
    return _Conversion(plan, package_paths).run_spec()


class _Conversion:
    """Conversion of one plan.

    Args:
        plan: plan of a launch file.
        package_paths: folders of ROS packages by name, or workspaces.
    """

    def __init__(self, plan: LaunchPlan, package_paths: PackagePaths) -> None:
        self._plan = replace(plan, processes=[resolved_process(each) for each in plan.processes])
        self._paths = package_paths
        self._diagnostics: Diagnostics = plan.diagnostics
        self._simulators: list[tuple[LaunchedProcess, SimulatorCommand]] = []
        self._left_out: dict[int, LaunchedProcess] = {}
        self._kept: dict[int, str] = {}
        self._own: set[int] = set()  # processes with a program of the workspace
        self._loaded: dict[int, Mapping[str, Any]] = {}
        self._requests: list[CodeRequest] = []
        self._resource_paths: tuple[str, ...] = ()
        self._shared: dict[str, object] = {}  # the workspace, which is searched once for all programs

    def run_spec(self) -> RunSpec:
        programs = {process.number: program for process, program in self._programs()}
        kept = (each for each in self._plan.processes if each.number in programs and each.number not in self._own)
        self._loaded = {each.number: entry for each in kept if (entry := loaded_model(each, self._plan)) is not None}
        self._kept = {p.number: f"{_short_name(p)}-{p.number}" for p in self._plan.processes if p.number in programs}
        nodes = [
            self._node(process, programs[process.number])
            for process in self._plan.processes
            if process.number in programs
        ]
        options: dict[str, object] = {"package_paths": self._paths}
        if any(map(_is_loading_controllers, nodes)):
            options["start_controllers"] = False
        parameter_files = list(_temporary_parameter_files(self._plan))
        if controllers := _controllers_of_ros1(self._plan.parameters):
            parameter_files.append(str(write_run_file("parameters", ".yaml", controllers)))
        if parameter_files:
            options["params_files"] = tuple(parameter_files)
        self._resource_paths = self._search_folders()
        world, seed = self._world()
        if self._resource_paths:
            options["resource_paths"] = self._resource_paths
        return RunSpec(
            world,
            seed=seed or 0,
            name=self._plan.file.name.partition(".")[0],
            spawn=tuple(self._loaded.values()),
            nodes=tuple(nodes),
            ros_parameters=self._plan.parameters,
            options=cast(LoadOptions, options),
            code_requests=tuple(self._requests),
        )

    # ------------------------------------------------------------------ programs

    def _programs(self) -> Iterator[tuple[LaunchedProcess, str]]:
        """Yield the processes that run here with the names of their programs; note and report the others."""
        for process in self._plan.processes:
            command = simulator_command(process)
            if command is not None:
                self._simulators.append((process, command))
                self._left_out[process.number] = process
                continue
            program = SHUTDOWN if process.kind == "shutdown" else _program_of(process)
            known = known_node(program) if "/" in program else None
            if known is not None and known.nothing and not known.ends and not self._is_awaited(process):
                text = f"{process.source} has no effect here: {known.nothing}"
                self._diagnostics.note("SK-LAUNCH-041", text, process.where)
                self._left_out[process.number] = process
                continue
            try:
                source = program_source(program, self._paths, self._shared)
                _check_options(process)
            except InputError as error:
                self._leave_out(process, error)
                continue
            if fault := _name_fault(process):
                self._leave_out(process, InputError("SK-NODE-030", fault))
                continue
            if isinstance(source, (Path, Executable)):
                self._own.add(process.number)
                file = source.file if isinstance(source, Executable) else source
                words = f"the launch file starts the program {process.source!r:.200}"
                self._requests.append(CodeRequest(words, file, process.where))
            yield process, program

    def _is_awaited(self, process: LaunchedProcess) -> bool:
        return any(
            other.condition.process == process.number and other.condition.event == "exit"
            for other in self._plan.processes
        )

    def _leave_out(self, process: LaunchedProcess, error: InputError) -> None:
        """Report a process that cannot run here, and what depends on it."""
        self._left_out[process.number] = process
        waiting = [each.source for each in self._plan.processes if each.condition.process == process.number]
        text = f"{process.source} does not run here: {error.message}"
        if waiting:
            text += f"; what waits for it starts without it: {', '.join(dict.fromkeys(waiting))}"
        hint = "simkit runs nodes in Python, and known nodes: list them with `simkit pkg known`"
        self._diagnostics.warning("SK-LAUNCH-040", text, process.where, error.help or hint)

    # ------------------------------------------------------------------ nodes

    def _node(self, process: LaunchedProcess, program: str) -> Mapping[str, Any]:
        """Return the mapping of a run specification for a process."""
        node: dict[str, Any] = {"program": program, "label": self._kept[process.number]}
        if process.name:
            node["name"] = process.name
        if process.namespace and process.namespace != "/":
            node["namespace"] = process.namespace
        remap: dict[str, str] = {}
        for old, new in process.remappings:
            remap.setdefault(old, new)
        if remap:
            node["remap"] = remap
        files, params = _ordered_parameters(process)
        if params:
            node["params"] = params
        words = list(_arguments_of(process))
        if files:
            words += [ROS_ARGUMENTS, *(word for file in files for word in ("--params-file", file))]
        if words:
            node["args"] = tuple(words)
        node |= self._condition(process.condition)
        if process.respawn_delay is not None:
            node["respawn"] = process.respawn_delay
        if process.ends_run or process.kind == "shutdown":
            node["ends_run"] = True
        environment = dict(process.environment)
        if process.number in self._loaded:
            environment |= environment_of(self._loaded[process.number])
        if shows_robot(process, self._plan, has_simulator=bool(self._simulators)):
            environment[SHOWN_ROBOT] = "1"
        if environment:
            node["env"] = environment
        if process.folder is not None:
            node["cwd"] = str(process.folder)
        return node

    def _condition(self, condition: StartCondition) -> dict[str, Any]:
        """Return the condition for a start; processes that are left out count as started, and as ended."""
        delay = condition.delay
        while condition.event != "begin" and condition.process in self._left_out:
            condition = self._left_out[condition.process].condition
            delay += condition.delay
        values: dict[str, Any] = {}
        if condition.event != "begin" and condition.process in self._kept:
            values["after"] = {condition.event: self._kept[condition.process]}
        if delay:
            values["delay"] = delay
        return values

    # ------------------------------------------------------------------ world

    def _world(self) -> tuple[str, int | None]:
        """Return the world of the simulator that the launch file starts, and its seed; a world of a known node else."""
        servers = [(process, command) for process, command in self._simulators if not command.is_client]
        with_world = [pair for pair in servers if pair[1].world]
        for process, command in with_world[1:]:
            text = f"a second simulator, with the world {command.world!r}, is left out"
            self._diagnostics.warning("SK-LAUNCH-042", text, process.where, "start it in a run of its own")
        if with_world:
            process, command = with_world[0]
            if command.waits:
                text = "the simulator would wait for a click on its play button; the run starts at once"
                self._diagnostics.note("SK-LAUNCH-043", text, process.where, "use --paused to wait")
            return self._world_file(process, command.world), command.seed
        if servers:
            return "empty", servers[0][1].seed
        if spawns_model(self._plan):
            text = "the launch file spawns a model and starts no simulator; the run has level ground"
            self._diagnostics.note("SK-LAUNCH-065", text)
            return "empty", None
        world = next(
            (node.world for p in self._plan.processes if (node := known_node(_program_of(p))) and node.world), ""
        )
        return world or NO_WORLD, None

    def _world_file(self, process: LaunchedProcess, name: str) -> str:
        """Return the file of a world; level ground, with a warning, for a world that is not there."""
        if name.lstrip().startswith("<"):
            return name
        found = find_world(name, process.folder, self._resource_paths)
        if found is not None:
            problem = missing_models(found, self._resource_paths, self._paths)
            if not problem:
                return str(found)
            text = f"the run has level ground in place of the world {name!r:.200}: {problem}"
            self._diagnostics.warning(
                "SK-LAUNCH-044", text, process.where, f"download its models: simkit fetch {found}"
            )
            return level_ground(found)
        text = f"there is no world {name!r:.200}; the run has level ground in its place"
        hint = "name its folder with --resource-path, or the workspace of its package with --package-path"
        self._diagnostics.warning("SK-LAUNCH-044", text, process.where, hint)
        return "empty"

    def _search_folders(self) -> tuple[str, ...]:
        """Return the existing folders of models and worlds: of the plan, of the simulators and of packages."""
        folders = list(self._plan.resource_paths)
        for process, _ in self._simulators:
            folders += environment_folders(process.environment.items())
        if self._simulators:
            folders += exported_folders(Workspace(self._plan.file.parent, self._paths))
        return tuple(folder for folder in dict.fromkeys(folders) if Path(folder).is_dir())


def _check_options(process: LaunchedProcess) -> None:
    """Check the times and the folder of a process.

    Raises:
        InputError: one of them is not valid.
    """
    folder = None if process.folder is None else str(process.folder)
    NodeOptions(delay=process.condition.delay, respawn=process.respawn_delay, cwd=folder)


def _is_loading_controllers(node: Mapping[str, Any]) -> bool:
    """Check whether a node loads controllers, so that the robots start without them."""
    known = known_node(str(node["program"]))
    return known is not None and known.is_loading_controllers(node.get("args", ()))


def _temporary_parameter_files(plan: LaunchPlan) -> Iterator[str]:
    """Yield the files of controllers that the launch file has written for the description of a robot.

    A description may name files of its workspace only; these are in the folder of temporary files.
    """
    texts = [value for process in plan.processes for table in process.parameters for value in _texts_of(table)]
    folder = Path(tempfile.gettempdir()).resolve()
    for name in dict.fromkeys(match[1] for text in texts for match in _PARAMETERS_ELEMENT.finditer(text)):
        path = Path(name)
        if path.is_file() and path.resolve().parent == folder:
            yield name


def _texts_of(table: Parameters) -> list[str]:
    return [] if isinstance(table, Path) else [value for value in table.values() if isinstance(value, str)]


def _controllers_of_ros1(parameters: Mapping[str, Any]) -> str:
    """Return the parameters of the parameter server as a file for control plugins; empty if there is no controller."""
    if not any(name.endswith("/type") and "/" in str(value) for name, value in parameters.items()):
        return ""
    root: dict[str, Any] = {}
    for name, value in parameters.items():
        *parents, last = [part for part in name.split("/") if part] or [""]
        block = root
        for part in parents:
            below = block.setdefault(part, {})
            block = below if isinstance(below, dict) else {}
        if last and not (isinstance(value, str) and value.lstrip().startswith("<")):  # not the description of a robot
            block[last] = _names_of_joints(value) if last == "extra_joints" else value
    return yaml.safe_dump(root, sort_keys=False)


def _name_fault(process: LaunchedProcess) -> str:
    """Return what is wrong with the names that a launch file gives to a node; empty for nothing."""
    for name, fault in ((process.name, node_name_error), (process.namespace, namespace_error)):
        if name and (reason := fault(name)) is not None:
            return f"found the name {name!r}: {reason[0]}"
    try:
        for old, new in process.remappings:
            parse_remap_rule(f"{old}:={new}")
    except RosArgumentsError as error:
        return str(error)
    return ""


def _names_of_joints(joints: object) -> object:
    """Return the names of the further joints of ROS 1's joint_state_controller, which have positions there."""
    is_list = isinstance(joints, list) and all(isinstance(joint, Mapping) and "name" in joint for joint in joints)
    return [joint["name"] for joint in joints] if is_list and isinstance(joints, list) else joints


def _program_of(process: LaunchedProcess) -> str:
    """Return the program of a process, as `--node` takes it."""
    if process.kind == "shutdown":
        return SHUTDOWN
    if process.package:
        return f"{process.package}/{process.executable}"
    program = process.arguments[0] if process.arguments else ""
    installed = Path(program).parts[-3:]
    if installed[:1] == ("lib",) and not Path(program).exists():
        return "/".join(installed[1:])  # of get_package_prefix or $(find-pkg-prefix), in a workspace without a build
    return program


def _arguments_of(process: LaunchedProcess) -> tuple[str, ...]:
    """Return the words after the program."""
    return process.arguments[1:] if process.kind == "command" else process.arguments


def _ordered_parameters(process: LaunchedProcess) -> tuple[list[str], dict[str, Any]]:
    """Return the parameter files of a process, and the values that come after them.

    A node reads files first. Values that a later file may replace are therefore written to a file of their own.
    """
    params: dict[str, Any] = {}
    files: list[str] = []
    for parameters in process.parameters:
        if not isinstance(parameters, Path):
            params.update(parameters)
            continue
        if params and _may_contain(parameters, params):
            text = yaml.safe_dump({"/**": {"ros__parameters": params}}, sort_keys=True, allow_unicode=True)
            files.append(str(write_run_file("parameters", ".yaml", text)))
            params = {}
        files.append(str(parameters))
    return files, params


def _may_contain(file: Path, params: Mapping[str, Any]) -> bool:
    """Check whether a file has the name of a parameter in its text."""
    try:
        text = read_input_text(file, errors="replace")
    except OSError:
        return False  # the node reports it
    return any(str(name).rpartition(".")[2] in text for name in params)


def _short_name(process: LaunchedProcess) -> str:
    """Return the name of a process in messages, without its number."""
    if process.kind == "shutdown":
        return "shutdown"
    return process.name or process.executable.rpartition("::")[2] or Path(_program_of(process)).name
