"""Commands that pages send to robots: speeds, goals and initial poses."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, Final

from simkit.bridges.teleop import KEY_TIMEOUT, Teleop, TeleopTarget, find_targets
from simkit.run_spec import JsonObject
from simkit_view.view.packet import make_packet

if TYPE_CHECKING:
    from simkit import Publisher, Simulation, Subscription
    from simkit.msgs import Message

_POSES: Final = {
    "goal": ("/goal_pose", "geometry_msgs/msg/PoseStamped"),
    "initial": ("/initialpose", "geometry_msgs/msg/PoseWithCovarianceStamped"),
}
_RECEIVERS: Final = {
    "goal": "no navigator subscribes to {topic}, so no robot drives there; `simkit run WORLD --web --nav` starts one",
    "initial": "no localisation subscribes to {topic}; `simkit run WORLD --web --nav MAP.yaml` starts one",
}
_NO_SPEEDS: Final = (0.0, 0.0, 0.0)
_FRAME: Final = "map"  # frame of goals, as in RViz; the map of a world has the world's origin
_POSITION_VARIANCE, _YAW_VARIANCE = 0.25, (math.pi / 12) ** 2  # [m²], [rad²]: those of RViz

Speeds = tuple[float, float, float]
"""Forward speed and speed to the left [m/s], and yaw rate to the left [rad/s]."""


class Driving:
    """Robots that pages drive; the run sends the commands that are due. Also the stream `driving` of the commands.

    Args:
        sim: simulation with the robots.
    """

    def __init__(self, sim: Simulation) -> None:
        self._sim, self._sent, self._revision = sim, b"", -1
        self._tick = sim.tick
        self._taps: dict[str, Subscription] = {}
        self._timeouts: dict[str, float] = {}  # of the drives [s]
        self._newest: dict[str, tuple[float, Speeds]] = {}
        self._drivers: dict[str, tuple[Teleop, object]] = {}
        self._publishers: dict[str, Publisher] = {}

    def targets(self) -> list[JsonObject]:
        """Return the robots that can be driven, with their limits; null for a speed without a limit."""
        return [_target_dict(target) for target in find_targets(self._sim)]

    @property
    def next_tick(self) -> int | None:
        """Tick of the next command; None while nothing is sent."""
        ticks = [tick for driver, _ in self._drivers.values() if (tick := driver.next_tick) is not None]
        return min(ticks, default=None)

    def send_due(self) -> None:
        """Send the commands that are due at the present tick."""
        self._forget_before_reset()
        for driver, _ in self._drivers.values():
            driver.send_due()

    def teleop(self, topic: str, client: object) -> Teleop | None:
        """Return the driver of a topic, and note who drives; None if no robot has the topic."""
        self._forget_before_reset()
        driver = self._drivers.get(topic)
        if driver is None:
            target = next((t for t in find_targets(self._sim) if t.topic == topic), None)
            if target is None:
                return None
            driver = (Teleop(self._sim, target), client)
        self._drivers[topic] = (driver[0], client)
        return driver[0]

    def packet(self, options: Sequence[object]) -> bytes | None:
        """Return the present command of each driven topic: of a page that drives, else the newest one of anybody.

        A command has its speeds, its time [s] (null while a page drives), and what was missing when a timeout stopped
        the robot (else an empty text): a key of the page, or a newer command for the drive.
        """
        self._watch()
        self._forget_before_reset()
        rows: JsonObject = {}
        for topic in self._taps:
            driver = self._drivers[topic][0] if topic in self._drivers else None
            since, speeds = self._newest.get(topic, (0.0, _NO_SPEEDS))
            if driver is not None and driver.next_tick is not None:
                rows[topic] = [driver.speeds, None, ""]
            elif speeds != _NO_SPEEDS and self._sim.time - since > self._timeouts[topic]:
                rows[topic] = [_NO_SPEEDS, since, f"no command for {self._timeouts[topic]:g} s"]
            elif since <= self._sim.time:
                is_stopped = driver is not None and driver.is_expired and speeds == _NO_SPEEDS
                rows[topic] = [speeds, since, f"no key for {KEY_TIMEOUT:g} s" if is_stopped else ""]
        packet = make_packet({"kind": "driving", "commands": rows}, {})
        if packet == self._sent:
            return None
        self._sent = packet
        return packet

    def _forget_before_reset(self) -> None:
        """Drop the commands of the time before a reset: the robots are at rest."""
        if self._sim.tick < self._tick:
            self._drivers.clear()
            self._newest.clear()
        self._tick = self._sim.tick

    def _watch(self) -> None:
        """Receive the commands of all robots that can be driven, also of robots that were spawned later."""
        bus = self._sim.communication.bus
        if bus.revision == self._revision:
            return
        self._timeouts = {target.topic: target.command_timeout for target in find_targets(self._sim)}
        for topic in [topic for topic in self._taps if topic not in self._timeouts]:
            self._taps.pop(topic).close()
        for topic in self._timeouts:
            if topic not in self._taps:
                self._taps[topic] = bus.tap(topic, partial(self._take, topic))
        self._revision = bus.revision

    def _take(self, topic: str, message: Message) -> None:
        twist: Any = getattr(message, "twist", message)
        self._newest[topic] = self._sim.time, (float(twist.linear.x), float(twist.linear.y), float(twist.angular.z))

    def close(self) -> None:
        """End the subscriptions, because no page shows the commands."""
        for tap in self._taps.values():
            tap.close()
        self._taps, self._newest, self._sent, self._revision = {}, {}, b"", -1

    def release(self, client: object) -> None:
        """Stop what a page drives, because the page has closed."""
        for driver, driven_by in self._drivers.values():
            if driven_by is client:
                driver.release_keys()

    def send_pose(self, kind: str, x: float, y: float, yaw: float, topic: str = "") -> JsonObject:
        """Publish a goal (`goal`) or the estimate of the robot's own pose (`initial`).

        Returns:
            `topic`, and `missing`: what the user must start because nothing uses the topic; empty if something does.
        """
        default, type_name = _POSES[kind]
        topic, sim = topic or default, self._sim
        if topic not in self._publishers:
            self._publishers[topic] = sim.advertise(topic, type_name)
        stamp = {"sec": sim.time_ns // 1_000_000_000, "nanosec": sim.time_ns % 1_000_000_000}
        turn = {"z": math.sin(yaw / 2), "w": math.cos(yaw / 2)}
        pose: JsonObject = {"position": {"x": x, "y": y}, "orientation": turn}
        if kind == "initial":
            covariance = [0.0] * 36
            covariance[0] = covariance[7] = _POSITION_VARIANCE
            covariance[35] = _YAW_VARIANCE
            pose = {"pose": pose, "covariance": covariance}
        self._publishers[topic].publish({"header": {"stamp": stamp, "frame_id": _FRAME}, "pose": pose})
        return {"topic": topic, "missing": "" if self._is_used(topic) else _RECEIVERS[kind].format(topic=topic)}

    def _is_used(self, topic: str) -> bool:
        """Check whether a plugin, a program or another process receives a topic, besides recorders and displays."""
        bus = self._sim.communication.bus
        ends = (end for _, end, _, role in bus.endpoints(topic) if role == "takes")
        return any(end.active for end in ends) or any(map(_is_program, bus.readers(topic)))


def _is_program(reader: Subscription) -> bool:
    """Check whether a subscription belongs to a plugin, a program, a script or another process.

    Recorders and displays keep no messages; the feed of other processes keeps none either, but knows its readers.
    """
    feed = getattr(reader.callback, "__self__", None)
    is_own = reader.keeps > 0 or reader.owner is not None or bool(reader.node)
    return reader.active and (is_own or bool(getattr(feed, "has_readers", False)))


def _target_dict(target: TeleopTarget) -> JsonObject:
    bounds = {name: [_finite(v) for v in getattr(target, name)] for name in ("linear", "angular")}
    return {"topic": target.topic, "model": target.model, "sideways": target.sideways, **bounds}


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None
