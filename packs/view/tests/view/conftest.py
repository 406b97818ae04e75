"""A small world that a test steps, with a live view, and pages that are connected to it."""

from __future__ import annotations

import gzip
import json
import time
import urllib.request
from collections.abc import Callable, Iterator
from contextlib import ExitStack, suppress
from typing import Any

import numpy as np
import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect

import simkit
from simkit_view.view.live_view import LiveView
from simkit_view.view.packet import read_packet

TIMEOUT = 20.0  # [s] after which a test fails that waits for a page
YARD = """<sdf version="1.9"><world name="yard">
<physics type="ode"><max_step_size>0.002</max_step_size></physics>
<light name="sun" type="directional"><direction>-0.3 0.2 -1</direction><diffuse>0.8 0.8 0.8 1</diffuse></light>
<model name="ground"><static>true</static><link name="l"><collision name="c"><geometry><plane/></geometry></collision>
<visual name="v"><geometry><plane><size>20 20</size></plane></geometry></visual></link></model>
<model name="wall"><static>true</static><pose>2 0 0.5 0 0 0</pose><link name="l">
<collision name="c"><geometry><box><size>0.1 4 1</size></box></geometry></collision>
<visual name="v"><geometry><box><size>0.1 4 1</size></box></geometry>
<material><diffuse>0.1 0.6 0.2 1</diffuse></material></visual></link></model>
<model name="stone"><pose>-1 0 0.05 0 0 0</pose><link name="l"><inertial><mass>1</mass></inertial>
<collision name="c"><geometry><box><size>0.1 0.1 0.1</size></box></geometry></collision></link></model>
<model name="rover"><pose>0 0 0.1 0 0 0</pose><link name="base">
<inertial><mass>2</mass></inertial>
<collision name="c"><geometry><box><size>0.4 0.2 0.1</size></box></geometry></collision>
<visual name="v"><geometry><box><size>0.4 0.2 0.1</size></box></geometry></visual>
<sensor name="scan" type="lidar"><always_on>1</always_on><update_rate>20</update_rate><topic>/scan</topic>
<lidar><scan><horizontal><samples>9</samples><min_angle>-0.4</min_angle><max_angle>0.4</max_angle></horizontal></scan>
<range><min>0.3</min><max>5</max></range></lidar></sensor></link>
<link name="mast"><pose>0 0 0.2 0 0 0</pose><inertial><mass>0.1</mass></inertial>
<visual name="v"><geometry><cylinder><radius>0.02</radius><length>0.3</length></cylinder></geometry></visual></link>
<joint name="turn" type="revolute"><parent>base</parent><child>mast</child>
<axis><xyz>0 0 1</xyz><limit><lower>-1</lower><upper>1</upper></limit></axis></joint>
<plugin filename="gz-sim-velocity-control-system" name="gz::sim::systems::VelocityControl">
<topic>/cmd_vel</topic></plugin></model></world></sdf>"""


class TestPage:
    """Page without a browser: sends requests and keeps the newest packet of each stream."""

    __test__ = False

    def __init__(self, socket: ClientConnection, pump: Callable[[], None]) -> None:
        self.socket, self._pump = socket, pump
        self.packets: dict[str, tuple[dict[str, Any], dict[str, np.ndarray]]] = {}
        self.answers: list[dict[str, Any]] = []
        self._number = 0

    def read(self) -> None:
        """Take everything that has arrived."""
        while True:
            try:
                data = self.socket.recv(timeout=0.005)
            except (TimeoutError, ConnectionClosed):
                return
            if isinstance(data, str):
                self.answers.append(json.loads(data))
            else:
                head, arrays = read_packet(data)
                self.packets[head["kind"]] = head, arrays

    def until(self, condition: Callable[[], Any]) -> Any:
        """Update the view and read until a condition holds; return its value.

        A condition about a packet that has not arrived raises KeyError and does not hold.
        """
        end = time.monotonic() + TIMEOUT
        while time.monotonic() < end:
            self._pump()
            self.read()
            with suppress(KeyError):
                if found := condition():
                    return found
        raise AssertionError(f"nothing came; packets {list(self.packets)}, answers {self.answers}")

    def want(self, **streams: Any) -> None:
        self.socket.send(json.dumps({"do": "want", "streams": streams}))

    def ask(self, do: str, /, **arguments: Any) -> dict[str, Any]:
        """Send a request and return the answer."""
        self._number += 1
        number = self._number
        self.socket.send(json.dumps({**arguments, "do": do, "id": number}))
        return self.until(lambda: next((a for a in self.answers if a.get("id") == number), None))

    def state(self) -> dict[str, Any]:
        return self.until(lambda: self.packets.get("state"))[0]


class Stage:
    """Simulation with a live view."""

    def __init__(self, stack: ExitStack, world: str = YARD) -> None:
        self._stack = stack
        self.sim = stack.enter_context(simkit.load(world))
        self.view = stack.enter_context(LiveView(self.sim))

    def page(self) -> TestPage:
        """Return a new page that is connected."""
        address = self.view.address.replace("http", "ws", 1).replace("/?", "/ws?")
        socket = self._stack.enter_context(connect(address, max_size=None, close_timeout=0.2))
        page = TestPage(socket, self.pump)
        page.until(lambda: "scene_changed" in page.packets)
        return page

    def pump(self) -> None:
        """Update the view; a world that runs makes no steps here."""
        pausing = self.sim.control.pausing
        if pausing.is_stepping and pausing.until > self.sim.tick:
            pausing.advance(pausing.until - self.sim.tick)
        self.view.update()

    def scene(self) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
        """Load the scene as the page does."""
        with urllib.request.urlopen(self.view.address.replace("/?", "/scene?"), timeout=TIMEOUT) as answer:
            return read_packet(gzip.decompress(answer.read()))


@pytest.fixture
def stage() -> Iterator[Stage]:
    with ExitStack() as stack:
        yield Stage(stack)


@pytest.fixture(scope="module")
def view() -> Iterator[LiveView]:
    """A live view that tests only ask over HTTP."""
    with simkit.load(YARD) as sim, LiveView(sim) as view:
        yield view
