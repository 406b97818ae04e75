"""Answer of plugins without lifecycle states to `~/get_state`: programs wait until a node of Nav2 is active."""

from __future__ import annotations

from typing import Final

from simkit import Plugin

GET_STATE: Final = "lifecycle_msgs/srv/GetState"
"""Type of the service."""

_ALWAYS_ACTIVE: Final = {"current_state": {"id": 3, "label": "active"}}


def answer_active(plugin: Plugin) -> None:
    """Answer `active` on `~/get_state`, unless a node with the states of a lifecycle node answers there already."""
    if plugin.ros.topic("~/get_state") not in plugin.sim.communication.services.names():
        plugin.offer("~/get_state", GET_STATE, lambda _: _ALWAYS_ACTIVE)
