"""Buoyancy and drag of simple shapes in waves: `vrx::PolyhedraBuoyancyDrag` of VRX.

Each `<buoyancy>` block attaches a box, sphere or cylinder to a link. Its part below the surface, with volume V of the
whole volume V₀, is lifted by the weight of the water that it displaces. With the mass m of the link, the velocity v of
its origin, its angular velocity ω and the vertical velocity w of the water at the shape, the drag is

    force  linear_drag · m·V/V₀ · ((0, 0, w) - v)        torque  -angular_drag · m·V/V₀ · length² · ω

The length is the mean side of a box, the diameter of a sphere, or (2·radius + length)/2 of a cylinder. The vertical
force is never negative.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import Params, Pose
from simkit.extend import (
    Box,
    Cylinder,
    Options,
    OptionsOf,
    SharedByCopies,
    Sphere,
    Vector,
    block,
    blocks,
    find_named_link,
    listens,
    number,
    pose,
    text,
    vector3,
)
from simkit.float_sum import float_sum
from simkit.linear_algebra import matmul
from simkit.scene import Geometry
from simkit_water_and_air.plugins.fluids.link_forces import PushedLinks, moving_data
from simkit_water_and_air.plugins.fluids.submerged_volume import Solid, solid_of
from simkit_water_and_air.plugins.fluids.wave_field import PARAMETERS, WavefieldOptions, WavesBase

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import SceneModel, SpecBuilder

_MOST: Final = 1e9
_LEAST: Final = 1e-6  # [m³], volume below which a shape counts as dry


class FloatBoxOptions(Options):
    """Options of a `<box>` block."""

    size: tuple[float, float, float] = vector3((0.0, 0.0, 0.0), "m", required=True)


class FloatSphereOptions(Options):
    """Options of a `<sphere>` block."""

    radius: float = number(None, "m", minimum=1e-9, maximum=1e4, required=True)


class FloatCylinderOptions(FloatSphereOptions):
    """Options of a `<cylinder>` block."""

    length: float = number(None, "m", minimum=1e-9, maximum=1e4, required=True)


class FloatGeometryOptions(Options):
    """Options of a `<geometry>` block."""

    box: FloatBoxOptions = block(FloatBoxOptions)
    sphere: FloatSphereOptions = block(FloatSphereOptions)
    cylinder: FloatCylinderOptions = block(FloatCylinderOptions)

    def read(self) -> tuple[Geometry, float] | None:
        """Return the shape and its length for the drag; None after an error."""
        if self.box.is_given:
            size = self.box.size
            if min(size) <= 0:
                self.box.params.error("SK-PARAM-002", f"found a <box> of {size}; expected lengths above 0")
                return None
            return Box(size), float_sum(size) / 3
        if self.sphere.is_given:
            return Sphere(self.sphere.radius), 2 * self.sphere.radius
        if self.cylinder.is_given:
            radius, length = self.cylinder.radius, self.cylinder.length
            return Cylinder(radius, length), (2 * radius + length) / 2
        self.params.error("SK-PARAM-001", "<geometry> needs a <box>, a <sphere> or a <cylinder>")
        return None


class BuoyancyObjectOptions(Options):
    """Options of a `<buoyancy>` block."""

    name: str = text(element="@name")
    link_name: str = text(None, required=True)
    offset: Pose = pose(element="pose")
    geometry: FloatGeometryOptions = block(FloatGeometryOptions)


class PolyhedraBuoyancyDragOptions(Options):
    """Options of `PolyhedraBuoyancyDrag`."""

    fluid_density: float = number(997.0, "kg/m³", minimum=0, maximum=_MOST)
    fluid_level: float = number(0.0, "m", minimum=-1e6, maximum=1e6)
    linear_drag: float = number(0.0, "1/s", minimum=0, maximum=_MOST)
    angular_drag: float = number(0.0, "1/s", minimum=0, maximum=_MOST)
    buoyancy: tuple[BuoyancyObjectOptions, ...] = blocks(BuoyancyObjectOptions)
    wavefield: WavefieldOptions = block(WavefieldOptions)


@dataclass(frozen=True, eq=False)
class _Float(SharedByCopies):
    """Shape that displaces water.

    Attributes:
        link: Scoped name of its link.
        mass: Mass of the link [kg].
        solid: Shape.
        length: Length for the drag torque [m].
        axes, origin: Rotation matrix and position [m] of the shape in the link's frame.
    """

    link: str
    mass: float
    solid: Solid
    length: float
    axes: Vector
    origin: Vector


class PolyhedraBuoyancyDrag(WavesBase):
    """Lifts and brakes links by boxes, spheres and cylinders below the surface of the waves.

    The waves are set by `<wavefield>` or by messages on its `<topic>`; without both, the water is calm.
    """

    endpoints = (listens("/wavefield/parameters", PARAMETERS, named_by=("wavefield/topic",)),)
    options = OptionsOf(PolyhedraBuoyancyDragOptions)
    filenames = ("libPolyhedraBuoyancyDrag.so",)
    names = ("vrx::PolyhedraBuoyancyDrag",)
    reads_at_load = ("inertial",)  # the drag follows from the mass

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        options = self.options.read_all()
        self.read_waves(options.wavefield)
        masses = {link.scoped: float(link.inertial.mass) for link in scene.all_links()}
        self._floats: list[_Float] = []
        for item in options.buoyancy:
            item.read_all()
            link, shape = find_named_link(scene, "link_name", item.params), item.geometry.read()
            if not link or shape is None:
                continue
            solid = solid_of(shape[0], lambda _: None)
            if solid is not None:
                place = item.offset
                origin = np.asarray(place.position, float)
                self._floats.append(_Float(link, masses[link], solid, shape[1], place.matrix, origin))

    def load(self, parent: Model, params: Params) -> None:
        self._links = self._bound_links()
        self.listen_to_waves(self.options.wavefield)

    def _bound_links(self) -> PushedLinks:
        return PushedLinks(self.sim, list(dict.fromkeys(item.link for item in self._floats)))

    def before_step(self) -> None:
        """Apply buoyancy and drag for the next step."""
        if not self._links.is_current:
            self._links = self._bound_links()
        links = self._links
        if not len(links):
            return
        data = moving_data(self.sim)
        velocities, spins = links.velocities(data), data.cvel[links.bodies, :3]
        gravity = self.sim.mj_model.opt.gravity
        forces, torques = np.zeros((len(links), 3)), np.zeros((len(links), 3))
        for item in self._floats:
            if item.link not in links.names:
                continue
            row = links.names.index(item.link)
            body = links.ids[row]
            frame: Vector = data.xmat[body].reshape(3, 3)
            axes, origin = matmul(frame, item.axes), data.xpos[body] + matmul(frame, item.origin)
            volume, moment, rise = self._submerged(item, axes, origin)
            if volume <= _LEAST:
                continue
            options = self.options
            mass = item.mass * volume / item.solid.volume
            force = -options.fluid_density * volume * gravity
            force += options.linear_drag * mass * (np.array((0.0, 0.0, rise)) - velocities[row])
            force[2] = max(force[2], 0.0)
            centre = origin + matmul(axes, moment / volume)
            forces[row] += force
            torques[row] += np.cross(centre - data.xipos[body], force)
            torques[row] -= options.angular_drag * mass * item.length**2 * spins[row]
        links.push(data, forces, torques)

    def _submerged(self, item: _Float, axes: Vector, origin: Vector) -> tuple[float, Vector, float]:
        """Return the volume below the surface [m³], its moment in the frame of the shape [m⁴], and the water's rise.

        Args:
            item: Shape.
            axes: World rotation matrix of the shape.
            origin: World position of the shape [m].
        """
        x, y, z = origin.tolist()
        time = self.sim.time
        level = self.options.fluid_level + self._waves.height(x, y, time)
        nx, ny, nz = axes[2].tolist()
        volume, mx, my, mz = item.solid.cut(nx, ny, nz, level - z)
        return volume, np.array((mx, my, mz)), self._waves.vertical_velocity(x, y, time)
