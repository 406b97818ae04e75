"""Base class of plugins that apply the forces of air or water to a wing, sail, fin or aircraft."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, ClassVar

from simkit import ModelPlugin
from simkit.runtime.engine.physics_step import CONTROL
from simkit_water_and_air.plugins.fluids.link_forces import moving_data
from simkit_water_and_air.plugins.fluids.tuple_vectors import ZERO, Triple, to_link_axes, to_world_axes

if TYPE_CHECKING:
    import mujoco


class WingBase(ModelPlugin):
    """Applies a force at a point of a link, which depends on the motion of this point through the air.

    A subclass sets `_scoped`, the scoped name of the link, and `_centre`, the point in the link's frame [m].

    Attributes:
        is_in_wind: True if the fluid moves with the world's wind, false if it is at rest.
    """

    is_in_wind: ClassVar[bool] = True

    _scoped: str
    _centre: Triple

    @abstractmethod
    def find_load(self, velocity: Triple, spin: Triple) -> tuple[Triple, Triple]:
        """Return the force at the centre of pressure [N] and the moment [N·m], in the link's frame.

        Args:
            velocity: Velocity of the centre of pressure relative to the air [m/s], in the link's frame.
            spin: Angular velocity of the link [rad/s], in the link's frame.
        """

    def fluid_velocity(self) -> Triple:
        """Return the velocity of the air or the water in the world [m/s]."""
        x, y, z = self.sim.engine.wind.at(self.sim.tick) if self.is_in_wind else ZERO
        return x, y, z

    def before_step(self) -> None:
        """Apply the force and the moment to the link for the next step."""
        sim = self.sim
        body = sim.engine.names.links[self._scoped].body
        if body <= 0:
            return
        data = moving_data(sim)
        arm, velocity, axes = self._motion(data, body)
        p, q, r = data.cvel[body, :3].tolist()
        force, moment = self.find_load(to_link_axes(axes, velocity), to_link_axes(axes, (p, q, r)))
        if not (any(force) or any(moment)):
            return
        (fx, fy, fz), (mx, my, mz) = to_world_axes(axes, force), to_world_axes(axes, moment)
        x, y, z = arm
        row = data.xfrc_applied[body]
        row += (fx, fy, fz, mx + y * fz - z * fy, my + z * fx - x * fz, mz + x * fy - y * fx)
        sim.engine.physics.push_once()
        sim.engine.physics.changed_body(CONTROL, body)

    def _motion(self, data: mujoco.MjData, body: int) -> tuple[Triple, Triple, list[float]]:
        """Return the state of the centre of pressure.

        Returns:
            Position relative to the centre of mass [m], velocity relative to the air [m/s], and the link's axes.
        """
        model = self.sim.mj_model
        axes: list[float] = data.xmat[body].tolist()
        px, py, pz = to_world_axes(axes, self._centre)
        ox, oy, oz = data.xpos[body].tolist()
        gx, gy, gz = data.subtree_com[model.body_rootid[body]].tolist()
        wx, wy, wz, vx, vy, vz = data.cvel[body].tolist()  # cvel refers to the centre of mass of the whole tree
        rx, ry, rz = ox + px - gx, oy + py - gy, oz + pz - gz
        ax, ay, az = self.fluid_velocity()
        velocity = vx + wy * rz - wz * ry - ax, vy + wz * rx - wx * rz - ay, vz + wx * ry - wy * rx - az
        mx, my, mz = data.xipos[body].tolist()
        return (ox + px - mx, oy + py - my, oz + pz - mz), velocity, axes
