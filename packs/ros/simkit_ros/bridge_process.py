"""Bridge process to ROS 2: its options and its environment."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from simkit.bridges.bridge_process import BridgeCodes, BridgeProcess
from simkit.errors import InputError
from simkit_ros.ros_names import is_namespace
from simkit_ros.ros_python import INSTALL_HELP, find_python

_FOLDER: Final = Path(__file__).parent
_MOST_DOMAIN: Final = 232
_LEAVES_LOOPBACK: Final = ("ROS_STATIC_PEERS", "ROS_LOCALHOST_ONLY", "ROS_DISCOVERY_SERVER")
_CODES = BridgeCodes("SK-ROS-002", "SK-ROS-004", "SK-ROS-005")


@dataclass(frozen=True)
class RosOptions:
    """Options of the bridge.

    Attributes:
        python: Python with rclpy; None for the first that is found.
        domain: number of the ROS domain; None for `ROS_DOMAIN_ID`, else 0.
        namespace: namespace of all names in ROS; empty for none.
        uses_network: True to reach other machines; otherwise no socket leaves 127.0.0.1.
        arguments: arguments of ROS, such as `("-r", "/scan:=/lidar")`.
    """

    python: Path | None = None
    domain: int | None = None
    namespace: str = ""
    uses_network: bool = False
    arguments: tuple[str, ...] = ()

    def check(self) -> None:
        """Validate the options.

        Raises:
            InputError: SK-ROS-003 the domain, of the options or of `ROS_DOMAIN_ID`, or the namespace is invalid.
        """
        variable = os.environ.get("ROS_DOMAIN_ID") or "0"
        name, found = ("ROS_DOMAIN_ID", variable) if self.domain is None else ("--ros-domain", str(self.domain))
        try:
            is_valid = 0 <= int(found, 0) <= _MOST_DOMAIN
        except ValueError:
            is_valid = False
        if not is_valid:
            raise InputError("SK-ROS-003", f"{name}: found {found}; expected a number from 0 to {_MOST_DOMAIN}")
        if self.namespace and not is_namespace(self.namespace):
            text = f"--ros-namespace: found {self.namespace!r}; expected letters, digits and _ between slashes"
            raise InputError("SK-ROS-003", text)

    def environment(self) -> dict[str, str]:
        """Return the environment variables of the bridge process."""
        environment = dict(os.environ)
        # ROS from PyPI starts each Python a second time, with its libraries; this mark may be of another environment
        environment.pop("_ROS_WHEELS_BOOTSTRAP_COMPLETE", None)
        environment["RMW_IMPLEMENTATION"] = "rmw_fastrtps_cpp"
        if self.domain is not None:
            environment["ROS_DOMAIN_ID"] = str(self.domain)
        variables = ("FASTRTPS_DEFAULT_PROFILES_FILE", "FASTDDS_DEFAULT_PROFILES_FILE")  # Jazzy, Kilted
        if self.uses_network:
            if not any(name in environment for name in variables):
                environment.update(dict.fromkeys(variables, str(_FOLDER / "network.xml")))
            return environment
        for name in _LEAVES_LOOPBACK:
            environment.pop(name, None)
        environment.update(dict.fromkeys(variables, str(_FOLDER / "loopback.xml")))
        # with LOCALHOST, rmw_fastrtps_cpp would add a transport that uses all addresses
        return {**environment, "ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET", "SKIP_DEFAULT_XML_FILE": "1"}


class RosBridge(BridgeProcess):
    """Bridge process; a context manager that waits for the end of the process.

    Args:
        options: options of the bridge.
        report: callback for a line to the user.

    Raises:
        InputError: SK-ROS-001 there is no Python with rclpy; SK-ROS-003 an option is invalid.
    """

    def __init__(self, options: RosOptions, report: Callable[[str], None]) -> None:
        options.check()
        self._options = options
        inner = options.namespace.strip("/")
        settings = {"namespace": f"/{inner}" if inner else "", "arguments": options.arguments}
        program, python = "simkit_ros.bridge", find_python(options.python)
        super().__init__("bridge to ROS 2", _CODES, program, settings, report, python, options.environment())

    def _ready_text(self, line: dict[str, int]) -> str:
        counts = ", ".join(
            f"{line[name]} {name if line[name] != 1 else name[:-1]}" for name in ("topics", "services", "actions")
        )
        domain = self._options.environment().get("ROS_DOMAIN_ID") or "0"
        return f"ROS 2: {counts} in domain {domain}" + ("" if self._options.uses_network else ", on this machine only")

    def _start_help(self, reason: str) -> str:
        return INSTALL_HELP if "No module named" in reason or "rmw" in reason else ""
