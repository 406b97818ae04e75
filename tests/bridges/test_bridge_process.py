"""Notes of a bridge: a client that sends invalid requests cannot fill the terminal."""

from __future__ import annotations

import json

from simkit.bridges.bridge_process import BridgeCodes, BridgeProcess


def test_a_flood_of_notes_is_cut_and_counted() -> None:
    lines: list[str] = []
    bridge = BridgeProcess("bridge", BridgeCodes("SK-ROS-002", "SK-ROS-004", "SK-ROS-005"), "none", {}, lines.append)
    for number in range(1000):
        bridge._take_line(json.dumps({"note": f"/add failed: {number}"}))
    bridge._report_last_notes()
    assert lines[0] == "note SK-ROS-005: /add failed: 0"
    assert lines[-1] == "note SK-ROS-005: 980 more notes are not shown"
    assert len(lines) == 21
