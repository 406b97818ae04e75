"""Forces of the water on one link, as `HydrodynamicModel.cc` and `BuoyantObject.cc` of uuv_simulator compute them.

The equations are those of T. I. Fossen, "Handbook of Marine Craft Hydrodynamics and Motion Control" (2011). Their axes
point forward, to the right and down: they are Gazebo's axes with y and z reversed. Matrices in the file are for these
axes, and damping coefficients are negative.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit.extend import Vector, counted
from simkit.linear_algebra import matmul
from simkit.number_text import number_or_nan
from simkit_water_and_air.plugins.fluids.added_mass import SmoothedAcceleration, own_inertia

if TYPE_CHECKING:
    from simkit import Params
    from simkit.extend import SceneLink

SEA_WATER: Final = 1028.0
"""Default density [kg/m³]."""
_DOWN: Final = np.array((1.0, -1.0, -1.0, 1.0, -1.0, -1.0))
_KINDS: Final = ("fossen", "sphere", "cylinder", "spheroid", "box")
_CIRCLE_DRAG: Final = ((1.0, 0.91), (2.0, 0.85), (4.0, 0.87), (math.inf, 0.99))  # by length / diameter
_SIDE_DRAG: Final = ((1.0, 0.63), (2.0, 0.68), (5.0, 0.74), (10.0, 0.82), (math.inf, 0.98))
_SPHERE_DRAG: Final = 0.5
_MOST: Final = 1e9

SCALES: Final = {
    "fluid_density": SEA_WATER,
    "volume_scaling": 1.0,
    "added_mass_scaling": 1.0,
    "damping_scaling": 1.0,
    "volume_offset": 0.0,
    "added_mass_offset": 0.0,
    "linear_damping_offset": 0.0,
    "linear_forward_speed_damping_offset": 0.0,
    "nonlinear_damping_offset": 0.0,
}
"""Numbers that services change, with their defaults."""


class HydrodynamicModel:
    """Hydrodynamic and buoyant forces on a link.

    Args:
        link: the link.
        block: `<link>` element of the plugin.
        density: density of the water [kg/m³].
        size: length, width and height of the link's collisions [m], if the block has no `<box>`.

    Attributes:
        name: scoped name of the link.
        scales: present values of `SCALES`.
        added, linear, forward, quadratic: matrices of added mass and damping, shape (6, 6).
        is_submerged: False while the link is partly above the surface, at z = 0.
        parts: forces and torques of the last step by cause, in the reversed axes, shape (6,).
    """

    def __init__(self, link: SceneLink, block: Params, density: float, size: Vector) -> None:
        self.name, self.mass = link.scoped, link.inertial.mass
        self.scales = {**SCALES, "fluid_density": density}
        self.volume = block.number("volume", 0.0, minimum=0.0, maximum=_MOST)
        self.buoyancy_centre = np.array(block.vector3("center_of_buoyancy", (0.0, 0.0, 0.0)))
        self.size = _read_size(block, size)
        self.is_neutral = block.boolean("neutrally_buoyant", False)
        if self.is_neutral:
            self.volume = self.mass / density
        self._metacentres = _read_metacentres(block)
        self.added, self.linear, self.forward, self.quadratic = (np.zeros((6, 6)) for _ in range(4))
        self._read_matrices(block.block("hydrodynamic_model"))
        self._inertia = own_inertia(link)
        self._acceleration = SmoothedAcceleration(self._inertia, np.diag(self.added))
        self.is_submerged = True
        self.parts: dict[str, Vector] = {}

    def set_scale(self, name: str, value: float) -> None:
        """Set one of `scales`."""
        self.scales[name] = value
        if name.startswith("added_mass"):
            self._acceleration = SmoothedAcceleration(self._inertia, np.diag(self._added_now()))

    def _added_now(self) -> Vector:
        scales = self.scales
        mass: Vector = scales["added_mass_scaling"] * (self.added + scales["added_mass_offset"] * np.eye(6))
        return mass

    def wrench(self, velocity: Vector, period: float) -> Vector:
        """Return the force [N] and torque [N·m] of the moving water, in the axes of the link, shape (6,).

        Args:
            velocity: velocity through the water of the link's origin, and angular velocity, in the axes of the link.
            period: time step [s].
        """
        scales, relative, added = self.scales, _DOWN * velocity, self._added_now()
        momentum = matmul(added, relative)
        coriolis = np.concatenate(
            (
                np.cross(momentum[:3], relative[3:]),
                np.cross(momentum[:3], relative[:3]) + np.cross(momentum[3:], relative[3:]),
            )
        )
        damping = self.linear + scales["linear_damping_offset"] * np.eye(6)
        ahead = self.forward + scales["linear_forward_speed_damping_offset"] * np.eye(6)
        damping = damping + relative[0] * ahead
        slowed = matmul(damping, relative)
        slowed += (np.diag(self.quadratic) + scales["nonlinear_damping_offset"]) * np.abs(relative) * relative
        pushed = -matmul(added, self._acceleration.update(relative, period))
        self.parts = {"damping": scales["damping_scaling"] * slowed, "added_mass": pushed, "added_coriolis": coriolis}
        total: Vector = _DOWN * (self.parts["damping"] + pushed + coriolis)
        return total

    def buoyancy(self, height: float, axes: Vector, gravity: float) -> tuple[float, Vector]:
        """Return the upward force [N], and its torque [N·m] about the link's origin, in world axes.

        Args:
            height: z of the link's origin [m]; the surface is at z = 0.
            axes: rotation matrix of the link.
            gravity: acceleration of gravity [m/s²].
        """
        density, tall = self.scales["fluid_density"], float(self.size[2])
        if self._metacentres is not None:
            return self._vessel_buoyancy(height, axes, density, gravity)
        whole = max(0.0, self.scales["volume_scaling"] * (self.volume + self.scales["volume_offset"]))
        volume = 0.0
        if height < 0.0 < height + tall / 2:
            self.is_submerged, volume = False, whole * (abs(height) + tall / 2) / tall
        elif height + tall / 2 <= 0.0:
            self.is_submerged, volume = True, whole
        force = volume * density * gravity
        if self.is_neutral and volume == self.volume:
            force = self.mass * gravity
        x, y, _ = matmul(axes, self.buoyancy_centre).tolist()
        self.parts["restoring"] = np.array((0.0, 0.0, force, 0.0, 0.0, 0.0))
        return force, np.array((y * force, -x * force, 0.0))

    def _vessel_buoyancy(self, height: float, axes: Vector, density: float, gravity: float) -> tuple[float, Vector]:
        """Return force and torque by the theory of small angles for a vessel with the shape of a box (Fossen, 2011)."""
        assert self._metacentres is not None
        wide, long, draught = self._metacentres
        tall = float(self.size[2])
        plane = self.mass / (density * draught)
        under = 0.0 if height > tall / 2 else tall if height < -tall / 2 else tall / 2 - height
        force = under * plane * density * gravity
        roll = math.atan2(float(axes[2, 1]), float(axes[2, 2]))
        sine_of_pitch = -float(axes[2, 0])
        torque = matmul(axes, np.array((-wide * math.sin(roll) * force, -long * sine_of_pitch * force, 0.0)))
        self.parts["restoring"] = np.array((0.0, 0.0, force, 0.0, 0.0, 0.0))
        return force, torque

    def _read_matrices(self, block: Params) -> None:
        kind = block.choice("type", _KINDS, required=True)
        self.added = _matrix(block, "added_mass", only_full=True)
        self.linear = _matrix(block, "linear_damping")
        self.forward = _matrix(block, "linear_damping_forward_speed")
        self.quadratic = _matrix(block, "quadratic_damping")
        if kind == "sphere":
            self._become_sphere(block.number("radius", float(min(self.size)), minimum=0.0, maximum=_MOST))
        elif kind == "cylinder":
            self._become_cylinder(block)
        elif kind == "spheroid":
            self._become_spheroid(block)
        elif kind == "box":
            drag = block.number("cd", 1.0, minimum=0.0, maximum=_MOST)
            sides = [block.number(n, 0.0, required=True, minimum=0.0) for n in ("length", "width", "height")]
            area = sides[1] * sides[2], sides[0] * sides[2], sides[0] * sides[1]
            for axis in range(3):
                self.quadratic[axis, axis] = -0.5 * drag * area[axis] * self.scales["fluid_density"]

    def _become_sphere(self, radius: float) -> None:
        density = SEA_WATER
        for axis in range(3):
            self.added[axis, axis] = 2.0 / 3.0 * density * math.pi * radius**3
            self.quadratic[axis, axis] = -0.5 * density * _SPHERE_DRAG * math.pi * radius**2

    def _become_cylinder(self, block: Params) -> None:
        radius = block.number("radius", float(min(self.size)), minimum=1e-9, maximum=_MOST)
        length = block.number("length", float(max(self.size)), minimum=1e-9, maximum=_MOST)
        longest = "ijk"[int(np.argmax(self.size))]
        along = "ijk".index(block.choice("axis", ("i", "j", "k"), longest))
        density, ratio, area = SEA_WATER, length / (2 * radius), math.pi * radius**2
        circle = next(drag for most, drag in _CIRCLE_DRAG if ratio <= most)
        side = next(drag for most, drag in _SIDE_DRAG if ratio <= most)
        for axis in range(3):
            is_along = axis == along
            self.added[axis, axis] = density * area * (1.0 if is_along else length)
            self.quadratic[axis, axis] = -0.5 * density * (circle * area if is_along else side * radius * length)
            if not is_along:
                self.added[3 + axis, 3 + axis] = density * area * length**3 / 12

    def _become_spheroid(self, block: Params) -> None:
        radius = block.number("radius", float(min(self.size)), minimum=1e-9, maximum=_MOST)
        length = block.number("length", float(max(self.size)), minimum=1e-9, maximum=_MOST)
        if radius >= length:
            message = f"found <radius> {radius:g} and <length> {length:g}; expected a length above the radius"
            block.error("SK-PARAM-002", message)
            return
        square = 1 - (radius / length) ** 2
        ecc = math.sqrt(square)
        ln = math.log((1 + ecc) / (1 - ecc))
        alpha = 2 * (1 - square) / ecc**3 * (0.5 * ln - ecc)
        beta = 1 / square - (1 - square) / (2 * ecc**3) * ln
        self.added[0, 0] = self.mass * alpha / (2 - alpha)
        self.added[1, 1] = self.added[2, 2] = self.mass * beta / (2 - beta)
        less, more = radius**2 - length**2, radius**2 + length**2
        turned = -0.2 * self.mass * less**2 * (alpha - beta) / (2 * less - more * (alpha - beta))
        self.added[4, 4] = self.added[5, 5] = turned


def _read_size(block: Params, size: Vector) -> Vector:
    box = block.child("box")
    if box is None:
        return size
    names = ("width", "length", "height")  # along x, y and z, as in the source
    return np.array([box.number(name, 0.0, required=True, minimum=0.0, maximum=_MOST) for name in names])


def _read_metacentres(block: Params) -> tuple[float, float, float] | None:
    """Return the metacentric width and length and the draught [m] of a vessel; None for an underwater vehicle."""
    names = ("metacentric_width", "metacentric_length", "submerged_height")
    if not all(block.has(name) for name in names):
        return None
    wide, long = (block.number(name, 0.0, minimum=-_MOST, maximum=_MOST) for name in names[:2])
    return wide, long, block.number(names[2], 1.0, minimum=1e-9, maximum=_MOST)


def _matrix(block: Params, name: str, *, only_full: bool = False) -> Vector:
    """Return a matrix of 36 numbers, or of the 6 numbers of its diagonal; zeros without the element."""
    written = block.text(name, "")
    numbers = [number_or_nan(word) for word in written.split()]
    sizes = (36,) if only_full else (6, 36)
    if not numbers and not block.has(name):
        return np.zeros((6, 6))
    if len(numbers) not in sizes or not all(abs(value) <= _MOST for value in numbers):
        expected = " or ".join(str(size) for size in sizes)
        block.error(
            "SK-PARAM-002", f"found {counted(len(numbers), 'word')} in <{name}>; expected {expected} finite numbers"
        )
        return np.zeros((6, 6))
    values = np.array(numbers)
    return np.diag(values) if len(numbers) == 6 else values.reshape(6, 6)
