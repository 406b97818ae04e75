"""Run part `--ros`: connect the run to ROS 2. `simkit ros` has the same options, without `--ros`."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, ClassVar

from simkit import RunSpec
from simkit.cli.run_verdict import RunVerdict
from simkit.cli.terminal.output import print_message
from simkit.errors import InputError
from simkit.extend import OpenRun, RunPart, option

if TYPE_CHECKING:
    from simkit_ros.bridge_process import RosBridge, RosOptions

_PYTHON_HELP = "Python with rclpy, or its virtual environment; default: that of the sourced ROS, else simkit's own."
_DOMAIN_HELP = "ROS domain; default: ROS_DOMAIN_ID, else 0."
_NAMESPACE_HELP = "Namespace of all names in ROS."
_NETWORK_HELP = "Reach ROS nodes on other machines; default: only this machine."
_ARGUMENTS_HELP = "Arguments of ROS up to --, such as -r /scan:=/lidar."

RosPython = Annotated[Path | None, option(_PYTHON_HELP, "PYTHON", "--ros-python")]
RosDomain = Annotated[int | None, option(_DOMAIN_HELP, "N", "--ros-domain")]
RosNamespace = Annotated[str | None, option(_NAMESPACE_HELP, "NS", "--ros-namespace")]
RosNetwork = Annotated[bool, option(_NETWORK_HELP, None, "--ros-network")]
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
    from simkit_ros.bridge_process import RosOptions

    options = RosOptions(python, domain, namespace or "", network, tuple(shlex.split(arguments or "")))
    options.check()
    return options


@dataclass
class RosConnection(RunPart):
    """Bridge to ROS 2 in a process of its own."""

    place: ClassVar[int] = 70

    ros: Annotated[bool, option("Connect the run to ROS 2.", None, "--ros")] = False
    ros_python: RosPython = None
    ros_domain: RosDomain = None
    ros_namespace: RosNamespace = None
    ros_network: RosNetwork = False
    ros_args: RosArguments = None
    options: RosOptions | None = field(init=False, default=None)
    bridge: RosBridge | None = field(init=False, default=None)

    def __post_init__(self) -> None:
        """Read the options.

        Raises:
            InputError: SK-ROS-003 an option is invalid, or is given without --ros.
        """
        values = (self.ros_python, self.ros_domain, self.ros_namespace, self.ros_network, self.ros_args)
        if self.ros:
            self.options = ros_options(*values)
            return
        for name, value in zip(("python", "domain", "namespace", "network", "args"), values, strict=True):
            if value not in (None, False):
                raise InputError("SK-ROS-003", f"--ros-{name} needs --ros")

    @classmethod
    def complete_words(cls, words: list[str]) -> list[str]:
        """Join the arguments of ROS to one value."""
        return join_ros_arguments(words) if "--ros" in words else words

    @contextmanager
    def around_run(self, spec: RunSpec, verdict: RunVerdict) -> Iterator[None]:
        """Check the bridge, which is not started yet, and end it after the run.

        Raises:
            InputError: SK-ROS-001 there is no Python with rclpy.
        """
        if self.options is None:
            yield
            return
        from simkit_ros.bridge_process import RosBridge

        with RosBridge(self.options, print_message) as self.bridge:
            yield

    @contextmanager
    def around_loop(self, run: OpenRun) -> Iterator[None]:
        """Start the bridge, which receives the first messages.

        Raises:
            InputError: SK-ROS-002 the bridge cannot start.
        """
        if self.bridge is not None:
            run.start_bridge(self.bridge)
        yield
