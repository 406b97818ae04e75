"""Parameter files of a controller manager: conversion to the manager's node names, and check for unused parameters."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Final

from simkit.extend import Diagnostics, Where, did_you_mean
from simkit.plugins.ros_parameter_files import Entry, ParameterFile, node_matches
from simkit_control.plugins.ros2_control.controller_manager import KNOWN_PARAMETERS, ControllerManager

_ROS_1_LOOPS: Final = "gazebo_ros_control"


def adapt_to_manager(
    file: ParameterFile, namespace: str, manager: str, diagnostics: Diagnostics, *, is_ros_1: bool
) -> ParameterFile:
    """Return a file with the node names that the manager expects, as if a launch file had loaded the parameters.

    In ROS 1 a launch file loads parameters into the robot's namespace, so parameters outside that namespace are moved
    into it. A file of one ROS version also works with a plugin of the other version. The declarations of controllers
    are copied to the node of the manager for ROS 2, and to the robot's namespace for ROS 1.

    Args:
        file: parameter file.
        namespace: namespace of the robot with a leading slash; empty if it has none.
        manager: name of the manager's node.
        diagnostics: diagnostics for parameters without effect.
        is_ros_1: true for the plugin of ROS 1.
    """
    parts = [part for part in namespace.split("/") if part]
    if file.root is not None:
        root = file.root if _nested_entry(file.root, parts) is not None else _wrap_in_namespace(file.root, parts)
        if is_ros_1:
            return replace(file, root=root)
        of_manager = _nested_entry(root, parts) or root
        _report_ros_1_gains(of_manager, file, diagnostics)
        declared = list(_declared_controllers(of_manager, only_type=True))
        nodes = [(f"{namespace}/{manager}", Entry(root.where, below=dict(declared)))] if declared else []
        return replace(file, root=root, nodes=nodes)
    if not is_ros_1:
        return file
    inside = any(pattern.strip("/").split("/")[: len(parts)] == parts for pattern, _ in file.nodes)
    nodes = file.nodes
    if not inside:
        nodes = [(p if p.startswith("/**") else f"{namespace}/{p.strip('/')}", entry) for p, entry in nodes]
    for entry in [entry for p, entry in nodes if p.rpartition("/")[2] == manager]:
        below = dict(_declared_controllers(entry, only_type=False))
        nodes = [*nodes, (namespace or "/", Entry(entry.where, below=below))]
    return replace(file, nodes=nodes)


def _declared_controllers(entry: Entry, *, only_type: bool) -> Iterator[tuple[str, Entry]]:
    """Yield name and block of each declared controller; `only_type` removes all parameters except the type."""
    for name, block in (entry.below or {}).items():
        kind = (block.below or {}).get("type")
        if kind is not None and kind.text:
            yield name, Entry(block.where, below={"type": kind}) if only_type else block


def _nested_entry(entry: Entry, parts: Sequence[str]) -> Entry | None:
    """Return the block at a path; None if there is none."""
    nested: Entry | None = entry
    for part in parts:
        nested = (nested.below or {}).get(part) if nested is not None else None
    return nested


def _wrap_in_namespace(entry: Entry, parts: Sequence[str]) -> Entry:
    for part in reversed(parts):
        entry = Entry(entry.where, below={part: entry})
    return entry


def _report_ros_1_gains(gains: Entry, file: ParameterFile, diagnostics: Diagnostics) -> None:
    below = gains.below or {}
    if _ROS_1_LOOPS in below:
        message = (
            f"{file.path.name}: {_ROS_1_LOOPS} has gains for the plugin of ROS 1; this robot's plugin is for ROS 2"
        )
        hint = "move them to the plugin's own node: pid_gains: {position: {JOINT: {kp: ..., kd: ...}}}"
        diagnostics.warning("SK-CONTROL-011", message, below[_ROS_1_LOOPS].where, hint)


_CONTROLLER_PARAMETERS: Final = ("joint", "joints", "joint_name", "left_wheel", "left_wheel_names", "sensor_name")


def report_unused_parameters(manager: ControllerManager, diagnostics: Diagnostics) -> None:
    """Report every parameter in the files that has no effect, and suggest the closest known name.

    Args:
        manager: manager that uses the files; it has not loaded a controller yet.
        diagnostics: diagnostics for the warnings.
    """
    declared, node = manager.declared(), manager.node
    _report_misspelt_nodes(manager, declared, diagnostics)
    if manager.is_ros_1:
        of_node = manager.files.of_node(node)
        for name, entry in (of_node.below or {}).items() if of_node is not None else ():
            _report_in_ros_1(name, entry, declared, diagnostics)
    nodes = [(pattern, entry) for file in manager.files.files for pattern, entry in file.nodes]
    for pattern, entry in nodes:
        # a pattern with * also matches other nodes, which may use these parameters
        if not pattern.endswith("*") and node_matches(pattern, node):
            for name, parameter in (entry.below or {}).items():
                _report_in_manager(name, parameter, declared, manager.files.node_names(), diagnostics)
    if not declared and not manager.is_started_by_nodes:
        _report_no_controllers(manager.files.files, node, diagnostics)


def report_high_rates(manager: ControllerManager, rate: float | None, diagnostics: Diagnostics) -> None:
    """Report controllers whose update rate is above the manager's `rate` [Hz]."""
    for name, loaded in manager.controllers.items():
        update_rate = loaded.controller.update_rate
        if rate is not None and update_rate > rate * (1.0 + 1e-9):
            message = f"controller {name!r} has an update rate of {update_rate} Hz, above the manager's {rate:g} Hz"
            diagnostics.warning(
                "SK-CONTROL-017", f"{message}; the manager's rate applies", loaded.controller.params.where
            )


def _report_misspelt_nodes(manager: ControllerManager, declared: Mapping[str, str], diagnostics: Diagnostics) -> None:
    """Report nodes that look like controllers, but have an unknown name, another namespace or no type."""
    own_node = manager.files.of_node(manager.node)
    reported_there = (own_node.below or {}) if own_node is not None else {}
    known = {manager.name, manager.plugin.name, *declared, "**", "*"}
    for file in manager.files.files:
        for pattern, entry in file.nodes:
            name, below = pattern.rpartition("/")[2], entry.below or {}
            if name in known:
                continue
            full_name, near = f"{manager.namespace}/{name}", did_you_mean(name, declared)
            if not node_matches(pattern, full_name) and ("type" in below or near):
                message = f"{file.path.name} has parameters for {pattern!r}, outside the manager's namespace"
                hint = f"write {full_name} or /**/{name} instead of {pattern.strip('/')}"
                diagnostics.warning("SK-CONTROL-019", message, entry.where, hint)
            elif near:
                message = f"{file.path.name} has parameters for {name!r}, which no controller manager declares"
                diagnostics.warning("SK-CONTROL-019", message, entry.where, near)
            elif name not in reported_there and any(key in below for key in _CONTROLLER_PARAMETERS):
                _report_no_type(name, entry, diagnostics)


def _report_in_manager(
    name: str, entry: Entry, declared: Mapping[str, str], nodes: Sequence[str], diagnostics: Diagnostics
) -> None:
    """Report a parameter of the manager's node that is unknown, or is in the wrong place, in ROS 2's layout."""
    if name in declared:
        for key, parameter in (entry.below or {}).items():
            if key not in KNOWN_PARAMETERS["declaration"]:
                message = f"{key!r} next to the type of {name!r} is ignored; set it in the controller's own node"
                hint = f"{name}: {{ros__parameters: {{{key}: ...}}}}"
                diagnostics.warning("SK-CONTROL-011", message, parameter.where, hint)
    elif name in KNOWN_PARAMETERS["manager"]:
        return
    elif entry.form in ("block", "nothing") or name in nodes:
        _report_no_type(name, entry, diagnostics)
    else:
        near = did_you_mean(name, KNOWN_PARAMETERS["manager"])
        diagnostics.warning("SK-CONTROL-011", f"the controller manager ignores parameter <{name}>", entry.where, near)


def _report_in_ros_1(name: str, entry: Entry, declared: Mapping[str, str], diagnostics: Diagnostics) -> None:
    """Report an entry in the robot's namespace that has a controller's parameters but no type.

    Other nodes may have parameters in this namespace too, so an entry without a controller's parameters is accepted.
    """
    below = entry.below or {}
    if name not in declared and any(key in below for key in _CONTROLLER_PARAMETERS):
        _report_no_type(name, entry, diagnostics)


def _report_no_type(name: str, entry: Entry, diagnostics: Diagnostics) -> None:
    kind = (entry.below or {}).get("type")
    where = entry.where if kind is None else kind.where
    what = (
        "is not defined" if kind is None else f"is {'empty' if kind.form in ('value', 'nothing') else 'not a string'}"
    )
    message = f"the 'type' param of controller {name!r} {what}; the controller is not loaded"
    near = did_you_mean("type", [key for key in entry.below or {} if key != "type"])
    misspelt = near.removeprefix("did you mean ").rstrip("?")
    hint = f"rename {misspelt} to 'type'" if near else f"{name}: {{type: package/Class}}"
    diagnostics.warning("SK-CONTROL-013", message, where, hint)


def _report_no_controllers(files: Sequence[ParameterFile], node: str, diagnostics: Diagnostics) -> None:
    """Report that no file declares a controller below the manager's node."""
    names = [pattern for file in files for pattern, _ in file.nodes]
    names += [f"/{name}" for file in files if file.root is not None for name in file.root.below or {}]
    if names:  # an empty file has been reported
        file_names = ", ".join(file.path.name for file in files)
        message = f"{file_names} declares no controller for {node or '/'!r}: none is loaded"
        hint = did_you_mean(node, names) or "the files have parameters for: " + ", ".join(names[:20])
        if node in names:
            hint = "a controller needs a type below this name: ros__parameters: {CONTROLLER: {type: package/Class}}"
        diagnostics.warning("SK-CONTROL-003", message, Where(str(files[0].path), 1), hint)
