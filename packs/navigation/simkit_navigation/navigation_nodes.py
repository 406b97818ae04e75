"""Nodes of Nav2 and of slam_toolbox that a run needs to navigate or to make a map: `simkit run WORLD --nav --slam`."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from simkit.bridges.teleop import find_targets
from simkit.errors import InputError
from simkit.extend import Diagnostics, Where
from simkit.loaders.resources.bundled_models import bundled_folders
from simkit.plugins.ros_parameter_files import node_matches, read_parameter_file
from simkit_navigation.plugins.maps.map_server import MapFileError, read_map

if TYPE_CHECKING:
    from simkit import Simulation

MAP_MODEL: Final = """<sdf version="1.9"><model name="true_map"><static>true</static><link name="link"/>
<plugin filename="libsimkit_map_server.so" name="map_server"/></model></sdf>"""
"""Model without a shape that publishes the true map of the world on `/map`."""
_SERVERS: Final[Mapping[str, str]] = {
    "controller_server": "nav2_controller",
    "planner_server": "nav2_planner",
    "smoother_server": "nav2_smoother",
    "behavior_server": "nav2_behaviors",
    "bt_navigator": "nav2_bt_navigator",
    "waypoint_follower": "nav2_waypoint_follower",
    "velocity_smoother": "nav2_velocity_smoother",
}
"""Packages of the servers by their executables, in the order in which they become active."""
_ODOMETRY: Final = "nav_msgs/msg/Odometry"
_SCAN: Final = "sensor_msgs/msg/LaserScan"
_MONITOR: Final = "collision_monitor"
_COMMANDED: Final = ("controller_server", "behavior_server", "velocity_smoother")
"""Servers whose topic `cmd_vel` is that before the smoother."""
_LOCALIZATION: Final = ("amcl", "map_server", "slam_toolbox")


def navigation_nodes(
    map_file: str | os.PathLike[str] | None = None,
    *,
    navigates: bool = True,
    makes_map: bool = False,
    params_files: Sequence[str | os.PathLike[str]] = (),
    remap: Mapping[str, str] | None = None,
) -> list[dict[str, Any]]:
    """Return the nodes that navigate or make a map, as mappings with the arguments of `Simulation.add_node`.

    The velocity goes from controller and behaviours through the smoother, and through the collision monitor if a
    parameter file has one, to `/cmd_vel`, as in nav2_bringup.

    Args:
        map_file: YAML file of a map, on which AMCL localises the robot, from its true pose on; None for a map that
            another node or plugin publishes on `/map`.
        navigates: whether the servers of Nav2 are among the nodes.
        makes_map: whether slam_toolbox makes the map; AMCL is then left out.
        params_files: parameter files of Nav2 that the run gives to all nodes. Parameters of simkit are used without a
            file that names one of the servers.
        remap: names of the topics `scan`, `odom` and `cmd_vel` of the robot, where they are others; see
            `topics_of_robot`.

    Raises:
        InputError: SK-NAV-020 the map is not there or not valid, or there is one although slam_toolbox makes it.
    """
    check_map(map_file, makes_map=makes_map)
    named, rules = _nodes_named_in(params_files), dict(remap or {})
    nodes: list[dict[str, Any]] = []
    if makes_map:
        nodes.append(_node("slam_toolbox", "async_slam_toolbox_node", params={"begin_at_true_pose": True}))
    else:
        servers = ["amcl"]
        if map_file is not None:
            nodes.append(
                _node("nav2_map_server", "map_server", params={"yaml_filename": str(Path(map_file).absolute())})
            )
            servers.insert(0, "map_server")
        nodes += [_node("nav2_amcl", "amcl", params={"begin_at_true_pose": True}), _manager("localization", servers)]
    if navigates:
        nodes += _servers(has_monitor=_MONITOR in named, command=rules.pop("cmd_vel", "cmd_vel"))
    for node in nodes:
        if rules:
            node["remap"] = {**rules, **node.get("remap", {})}
    if not named & {*_SERVERS, *_LOCALIZATION}:
        for node in nodes:
            node["args"] = ["--ros-args", "--params-file", str(default_parameters())]
    return nodes


def check_map(map_file: str | os.PathLike[str] | None, *, makes_map: bool) -> None:
    """Check whether a map can be read and is needed.

    Args:
        map_file: YAML file of the map; None without one.
        makes_map: True if slam_toolbox makes the map.

    Raises:
        InputError: SK-NAV-020 it cannot be read, or is not needed.
    """
    if map_file is None:
        return
    path, code = Path(map_file), "SK-NAV-020"
    if makes_map:
        raise InputError(
            code, f"found --nav {path} and --slam", help="--slam makes the map: write --nav without a file"
        )
    if not path.is_file():
        problem = f"there is no map {path!s:.200}"
        raise InputError(code, problem, help="simkit map WORLD -o NAME writes the true map of a world")
    try:
        read_map(path)
    except MapFileError as error:
        raise InputError(code, str(error), help="simkit map WORLD -o NAME writes a map") from None


def _servers(*, has_monitor: bool, command: str) -> list[dict[str, Any]]:
    """Return the servers of Nav2 and their manager; the last one publishes the velocity on the topic `command`."""
    nodes = [
        _node(package, name, remap={"cmd_vel": "cmd_vel_nav"} if name in _COMMANDED else {})
        for name, package in _SERVERS.items()
    ]
    names = list(_SERVERS)
    if has_monitor:
        nodes.append(
            _node("nav2_collision_monitor", _MONITOR, remap={} if command == "cmd_vel" else {"cmd_vel": command})
        )
        names.append(_MONITOR)
    else:
        nodes[-1]["remap"] = {"cmd_vel": "cmd_vel_nav", "cmd_vel_smoothed": command}
    return [*nodes, _manager("navigation", names)]


def topics_of_robot(sim: Simulation) -> dict[str, str]:
    """Return the topics of the robot by `scan`, `odom` and `cmd_vel`, where they have other names.

    The velocity topic is that of the only drive. The odometry is that in its namespace, and the scan the only one.
    """
    types, names = sim.topics(), dict[str, str]()
    drives = {target.model: target.topic for target in find_targets(sim)}
    if "/cmd_vel" not in drives.values() and len(drives) == 1:
        names["cmd_vel"] = next(iter(drives.values()))
    space = names.get("cmd_vel", "/").rpartition("/")[0]
    odometries = [topic for topic, kind in types.items() if kind == _ODOMETRY and topic.startswith(f"{space}/")]
    scans = [topic for topic, kind in types.items() if kind == _SCAN]
    for name, topics in (("odom", odometries), ("scan", scans)):
        if f"/{name}" not in types and len(topics) == 1:
            names[name] = topics[0]
    return names


def report_missing_topics(sim: Simulation, diagnostics: Diagnostics, *, navigates: bool) -> None:
    """Warn about what navigation needs and no robot of the world has: a laser scan, an odometry and a drive.

    Args:
        sim: simulation.
        diagnostics: collector of the warning.
        navigates: True if the servers drive a robot.
    """
    kinds = set(sim.topics().values())
    missing = [text for kind, text in ((_SCAN, "laser scan"), (_ODOMETRY, "odometry")) if kind not in kinds]
    if navigates and not find_targets(sim):
        missing.append("drive with a velocity topic")
    if missing:
        option, text = "--nav" if navigates else "--slam", " and no ".join(missing)
        hint = "choose a world with a robot, such as turtlebot3_world, or add one: --spawn turtlebot3_burger"
        diagnostics.warning("SK-NAV-021", f"{option}: the world has no {text}", hint=hint)


def _node(package: str, executable: str, **more: Any) -> dict[str, Any]:
    return {"program": f"{package}/{executable}", **{key: value for key, value in more.items() if value}}


def _manager(part: str, names: Sequence[str]) -> dict[str, Any]:
    """Return the lifecycle manager that activates nodes, and ends the run if one of them does not become active."""
    params = {"autostart": True, "node_names": list(names), "exit_on_failure": True}
    return {
        "program": "nav2_lifecycle_manager/lifecycle_manager",
        "name": f"lifecycle_manager_{part}",
        "params": params,
        "ends_run": True,
    }


def _nodes_named_in(files: Sequence[str | os.PathLike[str]]) -> set[str]:
    """Return the plain names of the nodes in parameter files; a file with errors is reported when the run reads it."""
    read = (read_parameter_file(Path(file), Diagnostics()) for file in files if Path(file).is_file())
    patterns = [pattern for file in read if file is not None for pattern, _ in file.nodes]
    return {name for pattern in patterns if node_matches(pattern, f"/{(name := pattern.rpartition('/')[2])}")}


def report_other_namespaces(files: Sequence[str | os.PathLike[str]], diagnostics: Diagnostics) -> None:
    """Warn about parameters of servers in a namespace, because the servers of a run have none."""
    servers = {*_SERVERS, *_LOCALIZATION, _MONITOR}
    for path in files:
        read = read_parameter_file(Path(path), Diagnostics()) if Path(path).is_file() else None
        for pattern, _ in () if read is None else read.nodes:
            name = pattern.rpartition("/")[2]
            if name in servers and not node_matches(pattern, f"/{name}"):
                text = f"the parameters of {pattern} are not used: the servers of --nav and --slam have no namespace"
                hint = f"write {name} without a namespace, or start the servers with a launch file"
                diagnostics.warning("SK-NAV-022", text, Where(str(path)), hint)


def default_parameters() -> Path:
    """Return the parameter file of a round robot with a lidar, such as the TurtleBot3."""
    files = (folder / "nav2_bringup" / "params" / "nav2_params.yaml" for folder in bundled_folders("packages"))
    return next(file for file in files if file.is_file())
