"""Run a plugin of this lab as a program in a terminal of its own. This file needs no change.

In a graded run the four nodes are plugins of one world. In a terminal, a node is a client of a running simulation. The
client has the methods of a plugin, so the same class works in both.
"""

from __future__ import annotations

from contextlib import suppress

from simkit.live import LiveClosed, connect


def run(plugin, name):
    """Run a plugin as the node `name` until Ctrl-C, or until the simulation ends."""
    with suppress(KeyboardInterrupt, LiveClosed), connect(node=name, wait=30.0) as client:
        plugin.sim = client  # has call and send_goal
        for method in ("advertise", "subscribe", "offer", "act", "log"):
            setattr(plugin, method, getattr(client, method))
        plugin.load(None, None)
        client.log.info("ready")
        while not client.is_closed:
            client.spin(1.0 / (plugin.after_step_rate or 10.0))
            plugin.after_step()
