"""Forces of water and wind on a link, as freefloating_gazebo computes them from `<buoyancy>` or `<fluid>` in the link.

The formulas are those of `hydro_link.cpp` of freefloating_gazebo, and of `freefloating_gazebo_fluid.cpp` in the branch
of usv_sim_lsa, which adds the wind (T. I. Fossen, "Handbook of Marine Craft Hydrodynamics and Motion Control", 2011,
chapter 8). An element that only the branch has, such as `<waterVelocity>`, selects the defaults of the branch.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit.extend import Vector, counted
from simkit.linear_algebra import matmul
from simkit.number_text import number_or_nan
from simkit_water_and_air.plugins.fluids.added_mass import SmoothedAcceleration, own_inertia

if TYPE_CHECKING:
    from simkit import Params
    from simkit.extend import SceneLink

_GRAVITY: Final = 9.81  # [m/s²], of the source
_BRANCH: Final = ("waterVelocity", "windVelocity", "frontal_area", "lateral_area", "lateral_length")
_BRANCH_DAMPING: Final = 5.0  # times the mass
_BRANCH_LIMIT: Final = 0.1  # [m]
_AIR: Final = 1.184  # density [kg/m³]
_SIDE, _FRONT, _BACK, _CROSS, _HEEL = 0.90, 0.55, 0.60, 0.60, 1.1  # coefficients of a speed boat: CDt, CDlaf, δ, κ
_CENTRE: Final = 0.05  # sL, place of the lateral centroid [m]
_SMALL: Final = 0.01  # smallest area that the wind pushes [m²]
_VELOCITIES: Final = ("global", "local", "none")


@dataclass
class FreefloatingLink:
    """Link in water.

    Attributes:
        centre: Centre of buoyancy in the link's frame [m].
        lift: Upward force of the submerged link [N].
        limit: Height above and below the surface between which the force decreases [m].
        linear, quadratic: Coefficients of damping, shape (6,).
        added: Matrix of the added mass, shape (6, 6); None without added mass.
        inertia: Mass three times and moments of inertia, shape (6,).
        moves_with_water, is_in_wind: Whether the current and the wind act.
        areas: Frontal and lateral area [m²], and length [m], for the wind.
        surface: Height of the water at the link [m], if a topic gave it.
    """

    centre: Vector
    lift: float
    limit: float
    linear: Vector
    quadratic: Vector
    added: Vector | None
    inertia: Vector
    moves_with_water: bool
    is_in_wind: bool
    areas: tuple[float, float, float]
    surface: float | None = None
    acceleration: SmoothedAcceleration | None = field(default=None)

    def share(self, height: float) -> float:
        """Return the share of the buoyancy that acts at a height of the centre above the surface [m]."""
        if height <= -self.limit:
            return 1.0
        if height > self.limit or self.limit <= 0:
            return 0.0
        return math.cos(math.pi / 4 * (height / self.limit + 1))

    def wrench(self, velocity: Vector, period: float) -> Vector:
        """Return the force [N] and torque [N·m] of the moving water, in the axes of the link, shape (6,).

        Args:
            velocity: velocity through the water of the link's origin, and angular velocity, in the axes of the link.
            period: time step [s].
        """
        most = self.inertia / period  # a larger coefficient would turn the motion round within one step
        total: Vector = -np.minimum(self.linear + self.quadratic * np.abs(velocity), most) * velocity
        if self.added is not None and self.acceleration is not None:
            momentum = matmul(self.added, velocity)
            linear = np.cross(momentum[:3], velocity[3:])
            angular = np.cross(momentum[:3], velocity[:3]) + np.cross(momentum[3:], velocity[3:])
            total = total + np.concatenate((linear, angular))
            total -= matmul(self.added, self.acceleration.update(velocity, period))
        return total

    def wind_wrench(self, ahead: float, aside: float, height: float) -> tuple[float, float, float, float]:
        """Return the forces along x and y [N] and the torques about x and z [N·m] of the wind.

        Args:
            ahead: velocity of the link through the air along its x axis [m/s].
            aside: the same along its y axis.
            height: height of the centre of buoyancy above the surface [m].
        """
        dry = 1.0 if self.limit <= 0 else max(0.0, min(1.0, (height + self.limit) / (2 * self.limit)))
        front, side, length = self.areas[0] * dry, self.areas[1] * dry, self.areas[2]
        angle = -math.atan2(aside, ahead)
        facing = _BACK if angle >= math.pi / 2 else _FRONT
        along = facing * front / side if side >= _SMALL else 0.0
        below = 1 - 0.5 * _CROSS * (1 - along / _SIDE) * math.sin(2 * angle)
        c_x = -along * (side / front) * math.cos(angle) / below if front >= _SMALL else 0.0
        c_y = _SIDE * math.sin(angle) / below
        c_n = (_CENTRE / length - 0.18 * (angle - math.pi / 2)) * c_y
        pressure = 0.5 * _AIR * (ahead * ahead + aside * aside)
        lateral = pressure * side
        return pressure * c_x * front, lateral * c_y, lateral * _HEEL * c_y * height, lateral * c_n * length


def read_freefloating_link(link: SceneLink, gravity: float) -> FreefloatingLink | None:
    """Return the forces that the link's `<buoyancy>` or `<fluid>` describes; None without these elements.

    Args:
        link: the link.
        gravity: acceleration of gravity in the world [m/s²].
    """
    found = None
    for element in link.plugin_elements:
        if link.inertial.mass <= 0:
            continue
        is_old = element.name == "buoyancy"
        lifted = element if is_old else element.block("buoyancy")
        moved = element if is_old else element.block("hydrodynamics")
        found = _read(link, gravity, element, lifted, moved)
    return found


def _read(link: SceneLink, gravity: float, element: Params, lifted: Params, moved: Params) -> FreefloatingLink:
    mass, inertia = link.inertial.mass, own_inertia(link)
    is_branch = any(element.has(name) for name in _BRANCH)
    density = element.number("density", 1.0, minimum=0.0, maximum=1e9)
    linear, quadratic = np.zeros(6), np.full(6, _BRANCH_DAMPING * mass if is_branch else 0.0)
    for block in (*moved.all("damping"), *moved.all("drag")):
        target = linear if block.attribute("type") == "linear" else quadratic
        for start, name in ((0, "xyz"), (3, "rpy")):
            if block.attribute(name):
                target[start : start + 3] = _numbers(block, name)
    added = _read_added_mass(moved, density)
    centre = np.array(link.inertial.com if is_branch else (0.0, 0.0, 0.0), float)
    if element.child("origin") is not None:
        centre = _numbers(element.block("origin"), "xyz")
    limit = _BRANCH_LIMIT if is_branch else 0.0
    if lifted.child("limit") is not None:
        limit = max(0.0, float(_numbers(lifted.block("limit"), "radius", 1)[0]))
    compensation = lifted.number("compensation", 0.0, minimum=-1e9, maximum=1e9)
    water = element.choice("waterVelocity", _VELOCITIES, "none" if is_branch else "global")
    wind = element.choice("windVelocity", _VELOCITIES, "none")
    areas = (
        element.number("frontal_area", 0.04, minimum=0.0, maximum=1e9),
        element.number("lateral_area", 0.06, minimum=0.0, maximum=1e9),
        element.number("lateral_length", 1.2, minimum=1e-6, maximum=1e9),
    )
    smoothed = None if added is None else SmoothedAcceleration(inertia, np.diag(added))
    lift = compensation * mass * (gravity if is_branch else _GRAVITY * density)
    return FreefloatingLink(
        centre=centre,
        lift=lift,
        limit=limit,
        linear=linear * density,
        quadratic=quadratic * density,
        added=added,
        inertia=inertia,
        moves_with_water=water != "none",
        is_in_wind=wind != "none",
        areas=areas,
        acceleration=smoothed,
    )


def _read_added_mass(block: Params, density: float) -> Vector | None:
    if block.child("added_mass") is None:
        return None
    numbers = [number_or_nan(word) for word in block.text("added_mass").split()]
    if len(numbers) != 36 or not all(map(math.isfinite, numbers)):
        message = f"found <added_mass> with {counted(len(numbers), 'value')}; expected 36 finite numbers, row by row"
        block.block("added_mass").error("SK-PARAM-002", message)
        return None
    return density * np.array(numbers).reshape(6, 6)


def _numbers(block: Params, name: str, count: int = 3) -> Vector:
    """Return the numbers of an attribute; zeros after an error."""
    words = block.attribute(name).split()
    numbers = np.array([number_or_nan(word) for word in words[:count]])
    if len(numbers) < count or not np.isfinite(numbers).all():
        message = f'found <{block.name} {name}="{block.attribute(name)}">; expected {counted(count, "finite number")}'
        block.error("SK-PARAM-002", message)
        return np.zeros(count)
    return numbers
