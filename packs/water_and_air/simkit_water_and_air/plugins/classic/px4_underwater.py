"""Water around PX4's underwater vehicles for Gazebo Classic: `libgazebo_uuv_plugin.so`.

Parameters and formulas are those of `gazebo_uuv_plugin.cpp` of PX4-SITL_gazebo-classic (after T. I. Fossen, 2011).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from simkit import ModelPlugin, Params
from simkit.extend import (
    Options,
    OptionsOf,
    blocks,
    find_link,
    find_named_link,
    number,
    text,
    vector3,
    without_effect,
)
from simkit.linear_algebra import matmul
from simkit_water_and_air.plugins.fluids.link_forces import PushedLinks, moving_data

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import SceneModel, SpecBuilder, Vector


class BuoyantLinkOptions(Options):
    """Options of a `<buoyancy>`."""

    link: str = text(element="link_name", required=True)
    origin: tuple[float, float, float] = vector3(unit="m")
    compensation: float = number(0.0, minimum=-1e6, maximum=1e6)
    limit: float = number(0.1, "m", element="height_scale_limit", minimum=1e-9, maximum=1e6)


class Px4UnderwaterOptions(Options):
    """Options of `Px4Underwater`."""

    namespace: bool = without_effect(element="robotNamespace")
    topic: bool = without_effect(element="commandSubTopic")
    base: str = text(None, element="baseLinkName", required=True)
    added_linear: tuple[float, float, float] = vector3(unit="kg", element="addedMassLinear")
    added_angular: tuple[float, float, float] = vector3(unit="kg·m²", element="addedMassAngular")
    damping_linear: tuple[float, float, float] = vector3(unit="N·s/m", element="dampingLinear")
    damping_angular: tuple[float, float, float] = vector3(unit="N·m·s", element="dampingAngular")
    buoyancy: tuple[BuoyantLinkOptions, ...] = blocks(BuoyantLinkOptions)


class Px4Underwater(ModelPlugin):
    """Lifts links and brakes a vehicle in water whose surface is at z = 0.

    Each `<buoyancy>` lifts a link by `<compensation>` times its weight, less within `<height_scale_limit>` of the
    surface. The added mass acts only through its Coriolis forces, as in the source.
    """

    options = OptionsOf(Px4UnderwaterOptions)
    filenames = ("libgazebo_uuv_plugin.so",)
    reads_at_load = ("inertial",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        options = self.options.read_all()
        self._base = find_named_link(scene, "baseLinkName", params)
        self._lifted: list[tuple[str, float, BuoyantLinkOptions]] = []
        for buoyancy in options.buoyancy:
            buoyancy.read_all()
            link = find_link(scene, buoyancy.link, buoyancy.params.block("link_name"))
            if link is not None:
                self._lifted.append((link.scoped, link.inertial.mass, buoyancy))

    def load(self, parent: Model, params: Params) -> None:
        self._bind()

    def _bind(self) -> None:
        self._links = PushedLinks(self.sim, [*dict.fromkeys((self._base, *(name for name, _, _ in self._lifted)))])

    def before_step(self) -> None:
        """Apply the forces of the water for the next step."""
        if not self._links.is_current:
            self._bind()
        links = self._links
        if not len(links):
            return
        data = moving_data(self.sim)
        forces, torques = np.zeros((len(links), 3)), np.zeros((len(links), 3))
        gravity = self.sim.mj_model.opt.gravity
        axes = links.axes(data)
        for name, mass, options in self._lifted:
            if name not in links.names:
                continue
            row = links.names.index(name)
            body = links.ids[row]
            place = data.xpos[body] + matmul(axes[row], np.array(options.origin))
            share = max(0.0, min(1.0, (options.limit - float(place[2])) / (2 * options.limit)))
            force = -options.compensation * mass * share * gravity
            forces[row] += force
            torques[row] += np.cross(place - data.xipos[body], force)
        if self._base in links.names:
            row = links.names.index(self._base)
            linear = matmul(links.velocities(data)[row], axes[row])
            force, torque = self._drag(linear, matmul(data.cvel[links.ids[row], :3], axes[row]))
            forces[row] += matmul(axes[row], force)
            torques[row] += matmul(axes[row], torque)
        links.push(data, forces, torques)

    def _drag(self, linear: Vector, angular: Vector) -> tuple[Vector, Vector]:
        """Return force and torque for velocities, all in the axes of the link."""
        options = self.options
        momentum = np.array(options.added_linear) * linear
        spin = np.array(options.added_angular) * angular
        force = np.cross(momentum, angular) - np.array(options.damping_linear) * linear
        torque = np.cross(momentum, linear) + np.cross(spin, angular) - np.array(options.damping_angular) * angular
        return force, torque
