"""Commands of `ros2 control`."""

from __future__ import annotations

import argparse
import os

from controller_client import ControllerClient, NoServiceError
from controller_manager_msgs.srv import (
    ListControllerTypes,
    ListHardwareComponents,
    ListHardwareInterfaces,
    ReloadControllerLibraries,
    SetHardwareComponentState,
)
from lifecycle_msgs.msg import State
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParameters
from rclpy.node import Node

STATES = {"unconfigured": 1, "inactive": 2, "active": 3, "finalized": 4}
"""Numbers of `lifecycle_msgs/msg/State` by label."""


def control_command(node: Node, words: list[str]) -> int:
    """Run a command of `ros2 control`; return its exit code.

    Args:
        node: node of the command.
        words: words after `ros2`.
    """
    options = _parser().parse_args(words[1:])
    client = ControllerClient(node, options.controller_manager)
    try:
        problem = _run(client, options)
    except NoServiceError as error:
        problem = str(error)
    if problem:
        print(problem)
    return int(bool(problem))


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="ros2 control")
    verbs = parser.add_subparsers(dest="verb", required=True)

    def verb(name: str) -> argparse.ArgumentParser:
        added: argparse.ArgumentParser = verbs.add_parser(name)
        added.add_argument("-c", "--controller-manager", default="/controller_manager")
        added.add_argument("--include-hidden-nodes", action="store_true")
        added.add_argument("--spin-time", type=float, default=0.0)
        return added

    load = verb("load_controller")
    load.add_argument("name")
    load.add_argument("param_file", nargs="?", default="")
    load.add_argument("--set-state", choices=("inactive", "active", "configured", "start", "configure"), default="")
    state = verb("set_controller_state")
    state.add_argument("name")
    state.add_argument("state", choices=("inactive", "active", "start", "stop", "configure", "unconfigured"))
    switch = verb("switch_controllers")
    for flag in ("--activate", "--deactivate", "--start-controllers", "--stop-controllers"):
        switch.add_argument(flag, nargs="*", default=[])
    switch.add_argument("--start", dest="start_controllers", nargs="*", default=[])
    switch.add_argument("--stop", dest="stop_controllers", nargs="*", default=[])
    for flag in ("--strict", "--best-effort", "--activate-asap", "--start-asap"):
        switch.add_argument(flag, action="store_true")
    switch.add_argument("--switch-timeout", type=float, default=5.0)
    verb("unload_controller").add_argument("name")
    lists = verb("list_controllers")
    for flag in ("--claimed-interfaces", "--required-state-interfaces", "--required-command-interfaces"):
        lists.add_argument(flag, action="store_true")
    for flag in ("--chained-interfaces", "--reference-interfaces", "--verbose", "-v"):
        lists.add_argument(flag, action="store_true")
    verb("list_controller_types")
    verb("list_hardware_components")
    verb("list_hardware_interfaces")
    component = verb("set_hardware_component_state")
    component.add_argument("name")
    component.add_argument("state", choices=tuple(STATES))
    verb("reload_controller_libraries").add_argument("--force-kill", action="store_true")
    return parser


def _run(client: ControllerClient, options: argparse.Namespace) -> str:
    """Run a command; return the problem, or an empty text."""
    verb = options.verb
    if verb == "load_controller":
        return _load(client, options)
    if verb == "set_controller_state":
        return _set_state(client, options.name, options.state)
    if verb == "switch_controllers":
        activate = [*options.activate, *options.start_controllers]
        deactivate = [*options.deactivate, *options.stop_controllers]
        if not client.switch(activate, deactivate, is_strict=options.strict):
            return "Error switching controllers, check controller_manager logs"
        print("Successfully switched controllers")
        if activate:
            print(f"Activated: {' '.join(activate)}")
        if deactivate:
            print(f"Deactivated: {' '.join(deactivate)}")
        return ""
    if verb == "unload_controller":
        if not client.unload(options.name):
            return "Error unloading controllers, check controller_manager logs"
        print(f"Successfully unloaded controller {options.name}")
        return ""
    if verb == "set_hardware_component_state":
        target = State(id=STATES[options.state], label=options.state)
        request = SetHardwareComponentState.Request(name=options.name, target_state=target)
        response = client.call(verb, SetHardwareComponentState, request)
        if not response.ok:
            return f"Error setting hardware component to {options.state} state"
        print(f"Successfully set {options.name} to state {options.state}")
        return ""
    if verb == "reload_controller_libraries":
        request = ReloadControllerLibraries.Request(force_kill=options.force_kill)
        return "" if client.call(verb, ReloadControllerLibraries, request).ok else "Error reloading libraries"
    _print_list(client, verb)
    return ""


def _load(client: ControllerClient, options: argparse.Namespace) -> str:
    name, manager = options.name, client.node
    if options.param_file:
        if not os.path.isfile(options.param_file):
            return f"Parameter file not found: {options.param_file}"
        path = os.path.abspath(options.param_file)
        value = ParameterValue(type=ParameterType.PARAMETER_STRING_ARRAY, string_array_value=[path])
        request = SetParameters.Request(parameters=[Parameter(name=f"{name}.params_file", value=value)])
        client.call("set_parameters", SetParameters, request)
    state = client.state(name)
    if not state and not client.load(name):
        return f"Error loading controller {name}, check controller_manager logs"
    manager.get_logger().debug(f"loaded {name}")
    if not options.set_state:
        print(f"Successfully loaded controller {name}")
        return ""
    state = client.state(name)
    if state == "unconfigured" and not client.configure(name):
        return "Error configuring controller"
    is_active = options.set_state in ("active", "start")
    if is_active and client.state(name) not in ("active", "running") and not client.switch([name], []):
        return "Error activating controller, check controller_manager logs"
    print(f"Successfully loaded controller {name} into state {'active' if is_active else 'inactive'}")
    return ""


def _set_state(client: ControllerClient, name: str, state: str) -> str:
    before = client.state(name)
    if not before:
        return f"controller {name} does not seem to be loaded"
    is_active = state in ("active", "start")
    if before == "unconfigured" and not client.configure(name):
        return "Error configuring controller"
    done = True
    if is_active and client.state(name) not in ("active", "running"):
        done = client.switch([name], [])
    elif not is_active and before in ("active", "running"):
        done = client.switch([], [name])
    if not done:
        return f"Error setting controller {name} to {state}, check controller_manager logs"
    print(f"Successfully {'activated' if is_active else 'deactivated' if before == 'active' else 'configured'} {name}")
    return ""


def _print_list(client: ControllerClient, verb: str) -> None:
    if verb == "list_controllers":
        for name, controller in client.controllers().items():
            print(f"{name:<30} {controller.type:<50} {controller.state}")
    elif verb == "list_controller_types":
        response = client.call(verb, ListControllerTypes, ListControllerTypes.Request())
        for kind, base in zip(response.types, response.base_classes, strict=True):
            print(f"{kind:<70} {base}")
    elif verb == "list_hardware_components":
        response = client.call(verb, ListHardwareComponents, ListHardwareComponents.Request())
        for number, component in enumerate(response.component, 1):
            print(f"Hardware Component {number}\n\tname: {component.name}\n\ttype: {component.type}")
            print(
                f"\tplugin name: {component.class_type}\n\tstate: id={component.state.id} label={component.state.label}"
            )
    else:
        response = client.call(verb, ListHardwareInterfaces, ListHardwareInterfaces.Request())
        for kind, interfaces in (("command", response.command_interfaces), ("state", response.state_interfaces)):
            print(f"{kind} interfaces")
            for each in interfaces:
                claim = f" [{'claimed' if each.is_claimed else 'unclaimed'}]" if kind == "command" else ""
                print(f"\t{each.name} [{'available' if each.is_available else 'unavailable'}]{claim}")
