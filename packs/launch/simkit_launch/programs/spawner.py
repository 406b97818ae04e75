"""Loads, configures and activates controllers, as the spawners of ROS 2 and of ROS 1."""

from __future__ import annotations

import argparse
import os
import sys
from itertools import pairwise
from typing import Any

import rclpy
import yaml
from controller_client import ControllerClient, NoServiceError
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParameters
from rclpy.node import Node
from rclpy.utilities import remove_ros_args
from std_msgs.msg import Bool

from simkit.input_file import read_input_text

PARAMETERS = "ros__parameters"


def parse_words(words: list[str]) -> tuple[argparse.Namespace, list[argparse.Namespace]]:
    """Read a command line: options for all controllers, and those of each controller."""
    # an empty word is an option that is not set, unless it is the value of the option before it
    words = [word for before, word in pairwise(["", *words]) if word or before.startswith("-")]
    parser = argparse.ArgumentParser(prog="spawner", allow_abbrev=False)
    parser.add_argument("-c", "--controller-manager", default="controller_manager")
    parser.add_argument("--controller-manager-timeout", type=float, default=0.0)
    parser.add_argument("--switch-timeout", "--service-call-timeout", type=float, default=5.0)
    parser.add_argument("--activate-as-group", action="store_true")
    parser.add_argument("--switch-asap", action=argparse.BooleanOptionalAction, default=False)
    parser.add_argument("-u", "--unload-on-kill", action="store_true")
    parser.add_argument("-n", "--namespace", default="")
    # of ROS 1
    parser.add_argument("--stopped", action="store_true")
    parser.add_argument("--wait-for", default="")
    parser.add_argument("--timeout", type=float, default=30.0)
    parser.add_argument("--no-timeout", action="store_true")
    parser.add_argument("--shutdown-timeout", type=float, default=30.0)
    own = argparse.ArgumentParser(add_help=False, allow_abbrev=False)
    own.add_argument("-p", "--param-file", action="append", default=[])
    own.add_argument("-t", "--controller-type", default="")
    own.add_argument("--load-only", action="store_true")
    own.add_argument("--inactive", "--stopped-controller", action="store_true")
    own.add_argument("--controller-ros-args", action="append", default=[])
    groups = [word for word in words if word == "--controller"]
    if groups:  # each controller has its own options
        starts = [index for index, word in enumerate(words) if word == "--controller"] + [len(words)]
        parsed, _ = parser.parse_known_args(words[: starts[0]])
        controllers = []
        for begin, end in pairwise(starts):
            each, rest = own.parse_known_args(words[begin + 2 : end])
            parsed, _ = parser.parse_known_args(rest, parsed)
            each.name = words[begin + 1]
            controllers.append(each)
        return parsed, controllers
    everything = argparse.ArgumentParser(prog="spawner", parents=[own], allow_abbrev=False, add_help=False)
    everything.add_argument("controllers", nargs="+")
    shared, rest = own.parse_known_args(words)
    parser.add_argument("controllers", nargs="+")
    parsed = parser.parse_args(rest)
    names = [name for name in parsed.controllers if name]
    return parsed, [argparse.Namespace(**{**vars(shared), "name": name}) for name in names]


def parameter_tables(path: str, controller: str, namespace: str) -> list[dict[str, Any]]:
    """Return the parameters of a controller in a file, from the least to the most specific pattern."""
    content = yaml.safe_load(read_input_text(path)) or {}
    full = f"{namespace.rstrip('/')}/{controller}"
    found = []
    everywhere = content.get("/**") or {}
    places = [(content, "/**"), (everywhere, controller), (everywhere, full)]
    places += [(content, name) for name in (controller, full, f"/**/{controller}", f"/**{full}")]
    below = content.get(namespace) or content.get(namespace.strip("/")) or {}
    places.append((below, controller))
    for table, name in places:
        block = table.get(name) if isinstance(table, dict) else None
        if isinstance(block, dict) and isinstance(block.get(PARAMETERS), dict):
            found.append(block[PARAMETERS])
    return found


class Spawner(Node):
    """Node that starts controllers.

    Args:
        options: options of the command line.
        controllers: options of each controller.
        files: parameter files after `--ros-args`, which hold for each controller.
    """

    def __init__(self, options: argparse.Namespace, controllers: list[argparse.Namespace], files: list[str]) -> None:
        super().__init__(f"spawner_{controllers[0].name}".replace("/", "_").replace(".", "_"))
        self._options, self._controllers, self._files = options, controllers, files
        manager = options.controller_manager
        if options.namespace and not manager.startswith("/"):
            manager = f"/{options.namespace.strip('/')}/{manager}"
        self._client = ControllerClient(self, manager, options.controller_manager_timeout)
        self.is_ros1 = False

    def start(self) -> bool:
        """Start the controllers; return whether all of them were started.

        The spawner of ROS 1 starts those that it could load, and does not fail because of the others.
        """
        if self._options.wait_for:
            self._wait_for(self._options.wait_for)
        started = []
        for controller in self._controllers:
            if not self._prepare(controller):
                if not self._client.is_ros1:
                    return False
                self.is_ros1 = True
                continue
            is_wanted = not (controller.inactive or controller.load_only or self._options.stopped)
            if is_wanted and self._state(controller.name) not in ("active", "running"):
                started.append(controller.name)
                if not (self._options.activate_as_group or self.is_ros1) and not self._activate([started.pop()]):
                    return False
        return not started or self._activate(started)

    def _prepare(self, controller: argparse.Namespace) -> bool:
        """Load and configure a controller."""
        log, name = self.get_logger(), controller.name
        state = self._client.state(name)
        if state:
            log.warning("Controller already loaded, skipping load_controller")
        else:
            if not self._set_parameters(controller):
                return False
            if not self._client.load(name):
                log.fatal(f"Failed loading controller {name}")
                return False
            log.info(f"Loaded {name}")
            state = self._state(name)
        self.is_ros1 = state in ("stopped", "running", "initialized")
        if state == "unconfigured" and not controller.load_only:
            if not self._client.configure(name):
                log.error(f"Failed to configure controller {name}")
                return False
            if controller.inactive:
                log.info(f"Configured {name}")
        return True

    def _activate(self, names: list[str]) -> bool:
        if not self._client.switch(names, []):
            self.get_logger().error(f"Failed to activate controller : {', '.join(names)}")
            return False
        done = "Started" if self.is_ros1 else "Configured and activated"
        self.get_logger().info(f"{done} {', '.join(names)}")
        return True

    def _state(self, name: str) -> str:
        return self._client.state(name)

    def _set_parameters(self, controller: argparse.Namespace) -> bool:
        """Set the type, the parameter files and the arguments of a controller before it is loaded."""
        namespace = self._client.manager.rpartition("/")[0]
        values: dict[str, Any] = {}
        files, kind = [], controller.controller_type
        for path in dict.fromkeys((*controller.param_file, *self._files)):
            if not os.path.isfile(path):
                self.get_logger().fatal(f"Parameter file not found: {path}")
                return False
            tables = parameter_tables(path, controller.name, namespace)
            if tables:
                files.append(os.path.abspath(path))
            for table in tables:
                kind = str(table.get("type", kind)) if not controller.controller_type else kind
        if controller.controller_ros_args:
            values["node_options_args"] = [word for text in controller.controller_ros_args for word in text.split()]
        if files:
            values["params_file"] = files
        if kind:
            values["type"] = kind
        return all(self._set_parameter(controller.name, name, value) for name, value in values.items())

    def _set_parameter(self, controller: str, name: str, value: Any) -> bool:
        if isinstance(value, list):
            message = ParameterValue(type=ParameterType.PARAMETER_STRING_ARRAY, string_array_value=value)
        else:
            message = ParameterValue(type=ParameterType.PARAMETER_STRING, string_value=value)
        parameter = Parameter(name=f"{controller}.{name}", value=message)
        request = SetParameters.Request(parameters=[parameter])
        (result,) = self._client.call("set_parameters", SetParameters, request).results
        if result.successful:
            self.get_logger().info(f'Setting controller param "{name}" to "{value}" for {controller}')
        else:
            self.get_logger().fatal(f'Could not set controller param "{name}" for {controller}: {result.reason}')
        return bool(result.successful)

    def _wait_for(self, topic: str) -> None:
        """Wait until a topic says that the robot is ready, as in ROS 1."""
        is_ready = [False]

        def receive(message: Any) -> None:
            is_ready[0] = is_ready[0] or bool(message.data)

        subscription = self.create_subscription(Bool, topic, receive, 10)
        while not is_ready[0]:
            rclpy.spin_once(self)
        self.destroy_subscription(subscription)


def main() -> int:
    """Start the controllers of the command line."""
    rclpy.init()
    words = sys.argv[1:]
    files = [value for word, value in pairwise(words) if word == "--params-file"]
    options, controllers = parse_words(remove_ros_args(sys.argv)[1:])
    spawner = Spawner(options, controllers, files)
    try:
        if not spawner.start():
            return 1
        if spawner.is_ros1:
            rclpy.spin(spawner)  # in ROS 1, the spawner stops its controllers when it ends
    except NoServiceError as error:
        spawner.get_logger().fatal(str(error))
        return 1
    except KeyboardInterrupt:
        pass
    finally:
        spawner.destroy_node()
        rclpy.try_shutdown()
    return 0


if __name__ == "__main__":
    sys.exit(main())
