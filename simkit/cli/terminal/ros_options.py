"""Options of the bridge to ROS 2, which `simkit run` and `simkit ros` share."""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from typer import Option

from simkit.cli.terminal.options import option
from simkit.errors import InputError

if TYPE_CHECKING:
    from simkit.bridges.ros.bridge_process import RosOptions

_PYTHON_HELP = "Python with rclpy, or its virtual environment; default: that of the sourced ROS, else simkit's own."
_DOMAIN_HELP = "ROS domain; default: ROS_DOMAIN_ID, else 0."
_NAMESPACE_HELP = "Namespace of all names in ROS."
_NETWORK_HELP = "Reach ROS nodes on other machines; default: only this machine."
_ARGUMENTS_HELP = "Arguments of ROS up to --, such as -r /scan:=/lidar."

Ros = Annotated[bool, Option("--ros", help="Connect the run to ROS 2.")]
RosPython = Annotated[Path | None, option(_PYTHON_HELP, "PYTHON", "--ros-python")]
RosDomain = Annotated[int | None, option(_DOMAIN_HELP, "N", "--ros-domain")]
RosNamespace = Annotated[str | None, option(_NAMESPACE_HELP, "NS", "--ros-namespace")]
RosNetwork = Annotated[bool, Option("--ros-network", help=_NETWORK_HELP)]
RosArguments = Annotated[str | None, option(_ARGUMENTS_HELP, "…", "--ros-args")]


def join_ros_arguments(args: Sequence[str]) -> list[str]:
    """Join the words after `--ros-args`, up to `--` or the end, to the value of the option."""
    if "--ros-args" not in args:
        return list(args)
    begin = args.index("--ros-args")
    words = list(args[begin + 1 :])
    end = words.index("--") if "--" in words else len(words)
    return [*args[:begin], f"--ros-args={shlex.join(words[:end])}", *words[end + 1 :]]


def ros_options(
    python: Path | None, domain: int | None, namespace: str | None, network: bool, arguments: str | None
) -> RosOptions:
    """Return the options of the bridge.

    Raises:
        InputError: SK-ROS-003 an option is invalid.
    """
    from simkit.bridges.ros.bridge_process import RosOptions

    found = RosOptions(python, domain, namespace or "", network, tuple(shlex.split(arguments or "")))
    found.check()
    return found


def run_ros_options(
    is_requested: bool,
    python: Path | None,
    domain: int | None,
    namespace: str | None,
    network: bool,
    arguments: str | None,
) -> RosOptions | None:
    """Return the options of the bridge of a run; None for a run without ROS.

    Raises:
        InputError: SK-ROS-003 an option is invalid, or is given without --ros.
    """
    if is_requested:
        return ros_options(python, domain, namespace, network, arguments)
    given = {
        "--ros-python": python,
        "--ros-domain": domain,
        "--ros-namespace": namespace,
        "--ros-network": network or None,
    }
    given["--ros-args"] = arguments
    for name, value in given.items():
        if value is not None:
            raise InputError(f"SK-ROS-003 {name} needs --ros", "SK-ROS-003")
    return None
