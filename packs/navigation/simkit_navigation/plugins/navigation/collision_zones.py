"""Zones around a robot in which points of obstacles stop it, slow it down or limit its speed."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Final, Literal

import numpy as np

from simkit_navigation.plugins.navigation.planar_pose import Floats

Action = Literal["stop", "slowdown", "limit", "approach", "none"]
Velocity = tuple[float, float, float]
"""Speeds along x and y [m/s] and turning rate [rad/s], in the frame of the robot."""

ACTIONS: Final[tuple[Action, ...]] = ("stop", "slowdown", "limit", "approach", "none")


@dataclass(frozen=True, eq=False)
class VelocityRange:
    """Velocities for which a zone has a polygon (a sub-polygon of Nav2's `VelocityPolygon`).

    Attributes:
        corners: corners of the polygon [m], shape (n, 2).
        linear: smallest and largest forward speed [m/s]; of a holonomic robot, of the speed in any direction.
        angular: smallest and largest turning rate [rad/s].
        direction: first and last direction of the motion of a holonomic robot [rad], or None.
    """

    corners: Floats
    linear: tuple[float, float]
    angular: tuple[float, float]
    direction: tuple[float, float] | None = None

    def contains(self, velocity: Velocity) -> bool:
        """Check whether a velocity is in the range."""
        forward, aside, turn = velocity
        speed = forward
        if self.direction is not None:
            speed = math.hypot(forward, aside)
            first, last = self.direction
            heading = math.atan2(aside, forward) if speed > 0 else 0.0
            is_ahead = first <= heading <= last if first <= last else heading >= first or heading <= last
            if not is_ahead:
                return False
        return self.angular[0] <= turn <= self.angular[1] and self.linear[0] <= speed <= self.linear[1]


@dataclass(frozen=True, eq=False)
class CollisionZone:
    """Polygon or circle around the robot.

    Attributes:
        name: name.
        action: what happens if enough points are within the zone.
        corners: corners of the polygon [m], shape (n, 2); None for a circle.
        radius: radius of the circle [m].
        min_points: number of points within the zone from which on the action happens.
        ratio: factor of all speeds for the action "slowdown".
        linear_limit, angular_limit: largest speeds for the action "limit" [m/s, rad/s].
        horizon: time before a collision from which on the robot slows down, for the action "approach" [s].
        step: time step of the motion that is looked ahead [s].
        sources: names of the sources whose points count; None for all.
        ranges: polygons by velocity; empty for a zone that does not depend on the velocity.
    """

    name: str
    action: Action
    corners: Floats | None
    radius: float = 0.0
    min_points: int = 4
    ratio: float = 0.5
    linear_limit: float = 0.5
    angular_limit: float = 0.5
    horizon: float = 2.0
    step: float = 0.1
    sources: tuple[str, ...] | None = None
    ranges: tuple[VelocityRange, ...] = ()

    def at_velocity(self, velocity: Velocity) -> CollisionZone:
        """Return the zone with the first polygon whose velocities contain the given one; else the zone itself."""
        matching = next((each for each in self.ranges if each.contains(velocity)), None)
        return self if matching is None else replace(self, corners=matching.corners)

    def is_hit(self, points: Floats) -> bool:
        """Check whether enough points [m], shape (n, 2), are within the zone."""
        return self._count(points) >= max(self.min_points, 1)

    def _count(self, points: Floats) -> int:
        if self.corners is None:
            return int((points[:, 0] ** 2 + points[:, 1] ** 2 < self.radius**2).sum())
        if len(self.corners) < 3:
            return 0
        is_inside = np.zeros(len(points), bool)
        x, y = points[:, 0], points[:, 1]
        for (x1, y1), (x2, y2) in zip(self.corners, np.roll(self.corners, 1, axis=0), strict=True):
            if y1 != y2:  # an edge is crossed by the ray to the right
                is_inside ^= ((y1 > y) != (y2 > y)) & (x < (x2 - x1) * (y - y1) / (y2 - y1) + x1)
        return int(is_inside.sum())

    def change(self, velocity: Velocity, points: Floats) -> Velocity:
        """Return the velocity that the zone allows."""
        if self.action == "approach":
            time = self._time_to_collision(velocity, points)
            return velocity if time is None else _scaled(velocity, time / self.horizon)
        if self.action == "none" or not self.is_hit(points):
            return velocity
        if self.action == "stop":
            return 0.0, 0.0, 0.0
        if self.action == "slowdown":
            return _scaled(velocity, self.ratio)
        x, y, turn = velocity
        share = 1.0
        for limit, speed in ((self.linear_limit, math.hypot(x, y)), (self.angular_limit, abs(turn))):
            share = min(share, limit / speed) if speed > limit else share
        return _scaled(velocity, share)

    def _time_to_collision(self, velocity: Velocity, points: Floats) -> float | None:
        """Return the time after which the zone, which moves with the robot, contains enough points [s].

        As in Nav2's `Polygon::getCollisionTime`, this is the time before the step that leads to the collision.
        """
        if self.is_hit(points):
            return 0.0
        if velocity == (0.0, 0.0, 0.0):
            return None
        forward, aside, turn = velocity
        size = self.radius if self.corners is None else float(np.hypot(*self.corners.T).max(initial=0.0))
        reach = math.hypot(forward, aside) * (self.horizon + self.step) + size
        points = points[np.hypot(points[:, 0], points[:, 1]) <= reach]
        if len(points) < max(self.min_points, 1):
            return None
        x = y = yaw = 0.0
        time = 0.0
        while time <= self.horizon:
            x += self.step * (forward * math.cos(yaw) - aside * math.sin(yaw))
            y += self.step * (forward * math.sin(yaw) + aside * math.cos(yaw))
            yaw += self.step * turn
            cosine, sine = math.cos(yaw), math.sin(yaw)
            right, up = points[:, 0] - x, points[:, 1] - y
            if self.is_hit(np.column_stack((cosine * right + sine * up, cosine * up - sine * right))):
                return time
            time += self.step
        return None


def _scaled(velocity: Velocity, share: float) -> Velocity:
    x, y, turn = velocity
    return x * share, y * share, turn * share


def allowed_velocity(
    zones: Iterable[CollisionZone], velocity: Velocity, points: Mapping[str, Floats]
) -> tuple[Velocity, CollisionZone | None]:
    """Return the smallest velocity that the zones allow, and the zone that causes it; None if no zone changes it.

    Args:
        zones: zones.
        velocity: wanted velocity.
        points: points of obstacles by the name of their source [m], each of shape (n, 2).
    """
    best: tuple[Velocity, CollisionZone | None] = velocity, None
    for zone in zones:
        seen = points_of(zone, points)
        if zone.action == "stop" and zone.is_hit(seen):
            return (0.0, 0.0, 0.0), zone
        changed = zone.change(velocity, seen)
        if changed != velocity and _size(changed) < _size(best[0]):
            best = changed, zone
    return best


def points_of(zone: CollisionZone, points: Mapping[str, Floats]) -> Floats:
    """Return the points of the sources that a zone uses, shape (n, 2)."""
    kept = [found for name, found in points.items() if zone.sources is None or name in zone.sources]
    return np.concatenate([np.zeros((0, 2)), *kept])


def _size(velocity: Velocity) -> float:
    return math.hypot(*velocity)
