"""Program of the process that connects a simulation to ROS 2."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from simkit.bridges.bridge_program import begin, run_until_end, tell
from simkit.bridges.ros.bridge import Bridge
from simkit.bridges.ros.ros_session import RosSession


def main(options: dict[str, Any]) -> int:
    """Run the bridge until the simulation ends; return the exit code.

    Args:
        options: `socket`, the path of the simulation's socket, `namespace` and `arguments` of ROS.
    """
    begin()
    try:
        session = RosSession("simkit", options["namespace"], options["arguments"])
    except Exception as error:  # noqa: BLE001 - rclpy raises its own errors, whose class is not known before the import
        tell(error=f"ROS cannot be opened: {error}")
        return 1

    def run() -> None:
        bridge = Bridge(Path(options["socket"]), session, options["namespace"], lambda text: tell(note=text))
        try:
            tell(ready=bridge.open())
            bridge.run()
        finally:
            bridge.close()

    try:
        return run_until_end(run)
    finally:
        session.close()
