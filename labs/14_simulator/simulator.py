"""A simulator in the plane of x and z, in 60 lines: complete five functions. Run them with `simkit lab grade .`

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
    # Exercise 1: the torque of gravity, the new rate, the new angle.


def step(ball, planes, dt):
    """Move a ball by one time step: forces, contacts, places."""
    # Exercise 2: gravity changes the velocity; each contact of `detect` is solved; the velocity changes the place.


def detect(ball, planes):
    """Return the normal and the friction coefficient of each plane that the ball touches."""
    touches = []
    # Exercise 3: append (normal, friction) of each plane whose distance from the surface of the ball is not positive.
    return touches


def solve(ball, normal, friction):
    """Change the velocities of a ball by the impulses of a contact."""
    # Exercise 4: the push along the normal, with restitution; the rub along the tangent, with the limit of Coulomb.


def sense(origin, angle, ball, planes, largest):
    """Return the range of a ray, infinity if it meets nothing up to the largest range."""
    # Exercise 5: the distances of all hits ahead, of the planes and of the ball; the nearest one counts.
    return math.inf
