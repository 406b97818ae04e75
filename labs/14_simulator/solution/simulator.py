"""A simulator in the plane of x and z, in 60 lines: a solution.

Lengths m, masses kg, times s, angles rad. A plane is (normal, offset, friction): its points p have normal · p = offset,
and its normal (nx, nz) points to the free side.
"""

from __future__ import annotations

import math

GRAVITY = 9.8  # [m/s²]
SLOW = 0.02  # [m/s], approach without a rebound


class Pendulum:
    def __init__(self, angle, mass, length, inertia):
        self.angle, self.rate = angle, 0.0
        self.mass, self.length, self.inertia = mass, length, inertia  # inertia about the middle of the bob [kg m²]


class Ball:
    def __init__(self, place, velocity, mass, radius, restitution):
        self.place, self.velocity, self.spin = place, velocity, 0.0  # (x, z), (vx, vz), [rad/s] about y
        self.mass, self.radius, self.inertia = mass, radius, 0.4 * mass * radius**2
        self.restitution = restitution


def swing(pendulum, dt):
    """Move a pendulum by one time step."""
    torque = -pendulum.mass * GRAVITY * pendulum.length * math.sin(pendulum.angle)
    pendulum.rate += torque / (pendulum.inertia + pendulum.mass * pendulum.length**2) * dt
    pendulum.angle += pendulum.rate * dt


def step(ball, planes, dt):
    """Move a ball by one time step: forces, contacts, places."""
    x, z = ball.velocity
    ball.velocity = x, z - GRAVITY * dt
    for normal, friction in detect(ball, planes):
        solve(ball, normal, friction)
    ball.place = tuple(p + v * dt for p, v in zip(ball.place, ball.velocity, strict=True))


def detect(ball, planes):
    """Return the normal and the friction coefficient of each plane that the ball touches."""
    touches = []
    for (nx, nz), offset, friction in planes:
        if nx * ball.place[0] + nz * ball.place[1] - offset - ball.radius <= 0.0:
            touches.append(((nx, nz), friction))
    return touches


def solve(ball, normal, friction):
    """Change the velocities of a ball by the impulses of a contact."""
    (nx, nz), (vx, vz) = normal, ball.velocity
    approach = nx * vx + nz * vz
    if approach >= 0.0:
        return
    restitution = ball.restitution if approach < -SLOW else 0.0
    push = -(1.0 + restitution) * ball.mass * approach
    tx, tz = nz, -nx
    slip = tx * vx + tz * vz - ball.radius * ball.spin
    stop = -slip / (1.0 / ball.mass + ball.radius**2 / ball.inertia)
    rub = max(-friction * push, min(friction * push, stop))
    ball.velocity = vx + (push * nx + rub * tx) / ball.mass, vz + (push * nz + rub * tz) / ball.mass
    ball.spin -= rub * ball.radius / ball.inertia


def sense(origin, angle, ball, planes, largest):
    """Return the range of a ray, infinity if it meets nothing up to the largest range."""
    dx, dz = math.cos(angle), math.sin(angle)
    hits = []
    for (nx, nz), offset, _ in planes:
        fall = -(nx * dx + nz * dz)
        if fall > 0.0:
            hits.append((nx * origin[0] + nz * origin[1] - offset) / fall)
    cx, cz = ball.place[0] - origin[0], ball.place[1] - origin[1]
    ahead = cx * dx + cz * dz
    inside = ball.radius**2 - (cx * cx + cz * cz - ahead**2)
    if inside >= 0.0 and ahead > 0.0:
        hits.append(ahead - math.sqrt(inside))
    nearest = min(hits, default=math.inf)
    return nearest if nearest <= largest else math.inf
