"""Forces of water on a vehicle: `gz::sim::systems::Hydrodynamics`.

The equations are those of T. I. Fossen, "Handbook of Marine Craft Hydrodynamics and Motion Control" (2011), in the axes
of the link, for its velocity ν = (u, v, w, p, q, r) through the water:

    wrench = -M·dν/dt - C(ν)·ν + (linear terms)·ν + (quadratic terms)

M is the added mass, whose elements the file gives with the opposite sign (`<xDotU>` is negative), and C(ν) its Coriolis
and centripetal matrix (theorem 6.2). Elements of the file have the names of SNAME (1950): `xU` is the force along x for
a velocity along x, `xUabsU` the force for u·|u|, `nVR` the torque about z for v·r.

The added mass acts through the acceleration of the last steps: see `simkit_water_and_air.plugins.fluids.added_mass`.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import ModelPlugin, Params
from simkit.extend import (
    Options,
    OptionsOf,
    Vector,
    boolean,
    find_named_link,
    listens,
    number,
    text,
    vector3,
    without_effect,
)
from simkit.linear_algebra import matmul
from simkit.msgs import valid_topic
from simkit.plugins.one_time_warnings import are_usable
from simkit_water_and_air.plugins.fluids.added_mass import SmoothedAcceleration, own_inertia
from simkit_water_and_air.plugins.fluids.link_forces import PushedLinks, moving_data

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import SceneModel, SpecBuilder
    from simkit.msgs import Vector3

VECTOR: Final = "geometry_msgs/msg/Vector3"
_FORCES, _SPEEDS = "xyzkmn", "UVWPQR"
_COEFFICIENT: Final = re.compile(rf"([{_FORCES}])(?:(Dot)([{_SPEEDS}])|([{_SPEEDS}])(?:(abs)?([{_SPEEDS}]))?)")


class HydrodynamicsOptions(Options):
    """Options of `Hydrodynamics`; terms that couple different axes, such as `yR` or `nVabsR`, may be given, too."""

    link_name: str = text(None, required=True)
    namespace: str = text()
    default_current: tuple[float, float, float] = vector3(unit="m/s")
    disable_coriolis: bool = boolean()
    disable_added_mass: bool = boolean()
    density: bool = without_effect(element="water_density")
    old_density: bool = without_effect(element="waterDensity")
    added_x: float = number(0.0, "kg", element="xDotU")
    added_y: float = number(0.0, "kg", element="yDotV")
    added_z: float = number(0.0, "kg", element="zDotW")
    added_roll: float = number(0.0, "kg·m²", element="kDotP")
    added_pitch: float = number(0.0, "kg·m²", element="mDotQ")
    added_yaw: float = number(0.0, "kg·m²", element="nDotR")
    linear_x: float = number(0.0, "N·s/m", element="xU")
    linear_y: float = number(0.0, "N·s/m", element="yV")
    linear_z: float = number(0.0, "N·s/m", element="zW")
    linear_roll: float = number(0.0, "N·m·s", element="kP")
    linear_pitch: float = number(0.0, "N·m·s", element="mQ")
    linear_yaw: float = number(0.0, "N·m·s", element="nR")
    quadratic_x: float = number(0.0, "N·s²/m²", element="xUabsU")
    quadratic_y: float = number(0.0, "N·s²/m²", element="yVabsV")
    quadratic_z: float = number(0.0, "N·s²/m²", element="zWabsW")
    quadratic_roll: float = number(0.0, "N·m·s²", element="kPabsP")
    quadratic_pitch: float = number(0.0, "N·m·s²", element="mQabsQ")
    quadratic_yaw: float = number(0.0, "N·m·s²", element="nRabsR")


class Hydrodynamics(ModelPlugin):
    """Applies added mass, Coriolis forces and damping of water to a link, relative to a current.

    The current [m/s] is `<default_current>` until a `Vector3` arrives on `/ocean_current`, or on
    `/model/<namespace>/ocean_current` with `<namespace>`.
    """

    endpoints = (listens("/ocean_current", VECTOR),)
    options = OptionsOf(HydrodynamicsOptions)
    filenames = ("gz-sim-hydrodynamics-system",)
    names = ("gz::sim::systems::Hydrodynamics",)
    reads_at_load = ("inertial",)  # the smoothing follows from the mass

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        options = self.options.read_all()
        self._link = find_named_link(scene, "link_name", params)
        self._added, self._linear = np.zeros((6, 6)), np.zeros((6, 6))
        self._signed, self._absolute = np.zeros((6, 6, 6)), np.zeros((6, 6, 6))
        self._read_coefficients(params, bool(builder.world.gazebo_quirks))
        if options.disable_added_mass:
            self._applied_mass = np.zeros((6, 6))
        else:
            self._applied_mass = self._added
        link = next((link for link in scene.all_links() if link.scoped == self._link), None)
        self._acceleration = SmoothedAcceleration(own_inertia(link), np.diag(self._applied_mass))

    def _read_coefficients(self, params: Params, as_gazebo_8: bool) -> None:
        """Read all coefficients that the file has."""
        drags: list[str] = []
        reversed_signs: list[Params] = []
        declared = {field.element: getattr(self.options, name) for name, field in self.options.fields().items()}
        for child in params.children:
            match = _COEFFICIENT.fullmatch(child.name)
            if match is None:
                continue
            row, dot, column, first, is_absolute, second = match.groups()
            value = declared[child.name] if child.name in declared else params.number(child.name, 0.0)
            i = _FORCES.index(row)
            if (
                value > 0
                and _SPEEDS[i] == (column or first)
                and second in (None, first)
                and (is_absolute or not second)
            ):
                reversed_signs.append(child)
            if dot:
                self._added[i, _SPEEDS.index(column)] = -value
            elif second is None:
                self._linear[i, _SPEEDS.index(first)] = value
            else:
                j, k = _SPEEDS.index(first), _SPEEDS.index(second)
                is_drag = i == j == k and not is_absolute and not as_gazebo_8
                if is_drag and value:
                    drags.append(child.name)
                (self._absolute if is_absolute or is_drag else self._signed)[i, j, k] += value
        for child in reversed_signs:
            _report_sign(child, is_added_mass="Dot" in child.name)
        if drags:
            listed = ", ".join(f"<{name}>" for name in drags)
            message = f"{listed}: read as factors of v·|v|, such as <xUabsU>, as in Gazebo before version 8"
            hint = "rename them: a force that does not change its direction with the velocity is no drag"
            params.warning("SK-PLUGIN-117", message, hint)

    def load(self, parent: Model, params: Params) -> None:
        options = self.options
        self._links = PushedLinks(self.sim, (self._link,))
        self._current = np.array(options.default_current)
        prefix = f"/model/{options.namespace}" if options.namespace else ""
        self.listen(valid_topic(f"{prefix}/ocean_current"), VECTOR, self._on_current)

    def _on_current(self, message: Vector3) -> None:
        current = float(message.x), float(message.y), float(message.z)
        if are_usable(*current):
            self._current = np.array(current)
        else:
            self._once.not_finite()

    def before_step(self) -> None:
        """Apply the wrench of the water for the next step."""
        if not self._links.is_current:
            self._links = PushedLinks(self.sim, (self._link,))
        if not len(self._links):
            return
        data = moving_data(self.sim)
        body = self._links.ids[0]
        axes: Vector = data.xmat[body].reshape(3, 3)
        relative = self._links.velocities(data)[0] - self._current
        velocity = np.concatenate((matmul(relative, axes), matmul(data.cvel[body, :3], axes)))
        wrench = self._wrench(velocity)
        force, torque = matmul(axes, wrench[:3]), matmul(axes, wrench[3:])
        arm = data.xpos[body] - data.xipos[body]
        self._links.push(data, force[None], (torque + np.cross(arm, force))[None])

    def _wrench(self, velocity: Vector) -> Vector:
        """Return force [N] and torque [N·m] at the link's origin, in its axes, and store the velocity."""
        acceleration = self._acceleration.update(velocity, self.period)
        wrench = matmul(self._linear, velocity) - matmul(self._applied_mass, acceleration)
        wrench += matmul(self._absolute, np.abs(velocity), velocity) + matmul(self._signed, velocity, velocity)
        if not self.options.disable_coriolis:
            momentum = matmul(self._added, velocity)
            linear, angular = velocity[:3], velocity[3:]
            wrench[:3] += np.cross(momentum[:3], angular)
            wrench[3:] += np.cross(momentum[:3], linear) + np.cross(momentum[3:], angular)
        total: Vector = wrench
        return total


def _report_sign(element: Params, *, is_added_mass: bool) -> None:
    """Warn about a positive coefficient of one axis."""
    text = f"<{element.name}>{element.value}</{element.name}> is positive"
    if is_added_mass:
        effect = "the water reduces the inertia of the link, and the simulation may diverge"
    else:
        effect = "the water accelerates the link along its velocity instead of braking it"
    hint = f"write a negative number: <{element.name}>-{element.value.lstrip('+')}</{element.name}>"
    element.warning("SK-PLUGIN-118", f"{text}: {effect}", hint)
