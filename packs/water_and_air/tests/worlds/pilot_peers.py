"""Quadrotor, and autopilots for it that the tests play themselves, between two steps of the simulation."""

from __future__ import annotations

import json
import math
import socket
import struct
from typing import Any

import numpy as np

from simkit_water_and_air.plugins.autopilots.mavlink import MavlinkDecoder, encode

MASS, ROTOR_MASS, G = 1.5, 0.025, 9.8
PLACES = ((0.13, -0.22, 1), (-0.13, 0.2, 1), (0.13, 0.22, -1), (-0.13, -0.2, -1))
"""Places of the rotors [m], forward and left, and their direction: 1 counter-clockwise."""

LINKS = "".join(
    f"""<link name="rotor_{i}"><pose>{x} {y} 0.023 0 0 0</pose><inertial><mass>{ROTOR_MASS}</mass>
      <inertia><ixx>9.75e-06</ixx><iyy>1.66704e-4</iyy><izz>1.67604e-4</izz></inertia></inertial></link>
    <joint name="rotor_{i}_joint" type="revolute"><parent>base_link</parent><child>rotor_{i}</child>
      <axis><xyz>0 0 1</xyz></axis></joint>"""
    for i, (x, y, _) in enumerate(PLACES)
)


def vehicle(plugins: str, imu: str = "", step: float = 0.001, height: float = 2.0, world: str = "") -> str:
    """Return a world with a quadrotor in the air; `imu` is the content of its IMU, with axes forward-right-down."""
    return f"""<sdf version="1.9"><world name="w"><gravity>0 0 -{G}</gravity>
      <physics name="p" type="ode"><max_step_size>{step}</max_step_size></physics>{world}
      <model name="quad"><pose>0 0 {height} 0 0 0</pose>
      <link name="base_link"><inertial><mass>{MASS}</mass>
        <inertia><ixx>0.008</ixx><iyy>0.015</iyy><izz>0.017</izz></inertia></inertial>
        <sensor name="imu_sensor" type="imu"><pose degrees="true">0 0 0 180 0 0</pose>{imu}</sensor></link>
      {LINKS}{plugins}</model></world></sdf>"""


def hover_shares(
    position: Any, velocity: Any, attitude: Any, gyro: Any, target: Any, thrust_at_full: float, yaw_gain: float
) -> np.ndarray:
    """Return the output of each rotor, from 0 to 1, that flies to a place with a proportional-derivative controller.

    Args:
        position, velocity: north-east-down [m, m/s].
        attitude: quaternion from body to north-east-down, w x y z.
        gyro: angular rate, forward-right-down [rad/s].
        target: wanted position, north-east-down [m].
        thrust_at_full: thrust of a rotor at full output [N]; it is the square of the output.
        yaw_gain: share of the thrust that turns the vehicle, per rad/s.
    """
    w, x, y, z = attitude
    yaw = math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    roll = math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
    pitch = math.asin(max(-1.0, min(1.0, 2 * (w * y - z * x))))
    wish = 1.2 * (np.asarray(target) - position) - 1.6 * np.asarray(velocity)
    forward = wish[0] * math.cos(yaw) + wish[1] * math.sin(yaw)
    right = -wish[0] * math.sin(yaw) + wish[1] * math.cos(yaw)
    wanted_pitch, wanted_roll = np.clip((-forward / G, right / G), -0.3, 0.3)
    total = (MASS + 4 * ROTOR_MASS) * max(1.0, G - 2 * wish[2])
    mx = 1.0 * (wanted_roll - roll) - 0.15 * gyro[0]
    my = 1.5 * (wanted_pitch - pitch) - 0.25 * gyro[1]
    mz = -yaw_gain * gyro[2]
    thrusts = []
    for ahead, left, way in PLACES:
        thrusts.append(total / 4 + mx * left / (4 * 0.21**2) + my * ahead / (4 * 0.13**2) + way * mz)
    return np.sqrt(np.clip(thrusts, 0.0, thrust_at_full) / thrust_at_full)


class JsonPeer:
    """ArduPilot, as the plugin sees it: servo packets with numbered frames out, lines of JSON in."""

    def __init__(self, port: int, channels: int = 16) -> None:
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.connect(("127.0.0.1", port))
        self.socket.settimeout(5.0)
        self.channels, self.frame = channels, 0

    def packet(self, widths: Any, frame: int | None = None) -> bytes:
        if frame is None:
            self.frame += 1
            frame = self.frame
        magic = 18458 if self.channels == 16 else 29569
        filled = [*map(int, widths), *[0] * (self.channels - len(widths))]
        return struct.pack(f"<HHI{self.channels}H", magic, 400, frame, *filled)

    def send(self, widths: Any = (1000,) * 4, frame: int | None = None) -> None:
        self.socket.send(self.packet(widths, frame))

    def receive(self) -> dict[str, Any]:
        data = self.socket.recv(65536)
        assert data.startswith(b"\n{") and data.endswith(b"}\n") and b" " not in data
        state: dict[str, Any] = json.loads(data)
        return state

    def receive_all(self) -> list[dict[str, Any]]:
        """Return everything that has arrived."""
        found = []
        self.socket.setblocking(False)
        try:
            while True:
                found.append(json.loads(self.socket.recv(65536)))
        except BlockingIOError:
            return found
        finally:
            self.socket.settimeout(5.0)

    def close(self) -> None:
        self.socket.close()


class MavlinkPeer:
    """PX4, as the plugin sees it: a TCP client that reads MAVLink frames and sends actuator controls."""

    def __init__(self, port: int) -> None:
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=5.0)
        self.decoder = MavlinkDecoder()
        self.sequence = 0

    def send(self, controls: Any = (0.0,) * 4, mode: int = 128) -> None:
        self.sequence += 1
        fields = {"time_usec": self.sequence, "controls": (*controls, *(0.0,) * (16 - len(controls))), "mode": mode}
        self.socket.sendall(encode("HIL_ACTUATOR_CONTROLS", fields, self.sequence, 1, 1))

    def receive(self) -> dict[str, Any]:
        """Return the messages of one step by name."""
        found: dict[str, Any] = {}
        while "HIL_STATE_QUATERNION" not in found:
            data = self.socket.recv(4096)
            assert data, "closed"
            for message in self.decoder.feed(data):
                found[message.name] = message.fields
        return found

    def close(self) -> None:
        self.socket.close()
