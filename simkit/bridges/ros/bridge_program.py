"""Program of the bridge process. It writes one JSON object per line to standard output.

`ready` has the numbers of what is open, `note` is for the user, `ended` is the reason for the end of the simulation,
and `error` that of an end with an error.
"""

from __future__ import annotations

import json
import signal
from pathlib import Path
from typing import Any

from simkit.bridges.live.protocol import LiveClosed, LiveError
from simkit.bridges.ros.bridge import Bridge
from simkit.bridges.ros.ros_session import RosSession
from simkit.child_process import exit_with_parent


def _tell(**words: Any) -> None:
    print(json.dumps(words), flush=True)  # noqa: T201 - this is the protocol of the process


def main(options: dict[str, Any]) -> int:
    """Run the bridge until the simulation ends; return the exit code.

    Args:
        options: `socket`, the path of the simulation's socket, `namespace` and `arguments` of ROS.
    """
    exit_with_parent()
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C ends the simulation, which ends the bridge
    try:
        session = RosSession("simkit", options["namespace"], options["arguments"])
    except Exception as error:  # noqa: BLE001 - rclpy raises its own errors, whose class is not known before the import
        _tell(error=f"ROS cannot be opened: {error}")
        return 1
    bridge = None
    try:
        bridge = Bridge(Path(options["socket"]), session, options["namespace"], lambda text: _tell(note=text))
        _tell(ready=bridge.open())
        bridge.run()
    except LiveClosed as end:
        _tell(ended=str(end))
    except LiveError as error:
        _tell(error=str(error))
        return 1
    finally:
        if bridge is not None:
            bridge.close()
        session.close()
    return 0
