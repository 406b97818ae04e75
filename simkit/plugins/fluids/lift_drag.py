"""Lift and drag of a wing: `gz::sim::systems::LiftDrag` and Gazebo Classic's `libLiftDragPlugin.so`."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from simkit.params import Params
from simkit.plugins.base import ModelPlugin
from simkit.plugins.find_entities import find_axis_joint, find_named_link
from simkit.plugins.fluids.aerofoil import AerofoilOptions, MomentAerofoilOptions, Triple, read_aerofoil
from simkit.plugins.fluids.link_forces import moving_data
from simkit.plugins.options import OptionsOf
from simkit.runtime.engine.physics_step import CONTROL

if TYPE_CHECKING:
    import mujoco

    from simkit.compiler import SpecBuilder
    from simkit.runtime import Model
    from simkit.scene import SceneModel


class LiftDragBase(ModelPlugin):
    """Lift, drag and moment on one link, by its motion through the air and by the angle of a control joint.

    Attributes:
        is_about_mass: whether the centre of pressure is seen from the centre of mass instead of the link's origin.
    """

    options = OptionsOf(AerofoilOptions)
    is_about_mass: ClassVar[bool] = False

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self._scoped = find_named_link(scene, "link_name", params)
        self._aerofoil = read_aerofoil(self.options)
        self._centre = self._aerofoil.centre
        if self.is_about_mass:
            link = next((link for link in scene.all_links() if link.scoped == self._scoped), None)
            mass_centre = link.inertial.com if link is not None else (0.0, 0.0, 0.0)
            x, y, z = (float(a + b) for a, b in zip(self._centre, mass_centre, strict=True))
            self._centre = (x, y, z)
        self._joint_name = ""
        if params.has("control_joint_name"):
            joint = find_axis_joint(scene, self.options.control_joint_name, params.block("control_joint_name"))
            self._joint_name = "" if joint is None else joint.scoped

    def load(self, parent: Model, params: Params) -> None:
        self._joint = self.sim.joint(self._joint_name) if self._joint_name else None

    def before_step(self) -> None:
        """Pushes for the step to come."""
        sim = self.sim
        body = sim.engine.names.links[self._scoped].body
        if body <= 0:
            return
        data = moving_data(sim)
        arm, velocity, axes = self._motion(data, body)
        angle = float(self._joint.position) if self._joint is not None else 0.0
        force, moment = self._aerofoil.load(_turned_back(axes, velocity), angle)
        if not (any(force) or any(moment)):
            return
        (fx, fy, fz), (mx, my, mz) = _turned(axes, force), _turned(axes, moment)
        x, y, z = arm
        row = data.xfrc_applied[body]
        row += (fx, fy, fz, mx + y * fz - z * fy, my + z * fx - x * fz, mz + x * fy - y * fx)
        sim.engine.physics.one_shot = True
        sim.engine.physics.changed_body(CONTROL, body)

    def _motion(self, data: mujoco.MjData, body: int) -> tuple[Triple, Triple, list[float]]:
        """The centre of pressure from the centre of mass [m], its velocity through the air [m/s], the link's axes."""
        model = self.sim.mj_model
        axes: list[float] = data.xmat[body].tolist()
        px, py, pz = _turned(axes, self._centre)
        ox, oy, oz = data.xpos[body].tolist()
        gx, gy, gz = data.subtree_com[model.body_rootid[body]].tolist()
        wx, wy, wz, vx, vy, vz = data.cvel[body].tolist()  # about the centre of mass of the whole tree
        rx, ry, rz = ox + px - gx, oy + py - gy, oz + pz - gz
        ax, ay, az = self.sim.engine.wind.at(self.sim.tick)
        velocity = vx + wy * rz - wz * ry - ax, vy + wz * rx - wx * rz - ay, vz + wx * ry - wy * rx - az
        mx, my, mz = data.xipos[body].tolist()
        return (ox + px - mx, oy + py - my, oz + pz - mz), velocity, axes


def _turned(axes: list[float], v: Triple) -> Triple:
    """From link to world; the matrix by rows."""
    x, y, z = v
    return (
        axes[0] * x + axes[1] * y + axes[2] * z,
        axes[3] * x + axes[4] * y + axes[5] * z,
        axes[6] * x + axes[7] * y + axes[8] * z,
    )


def _turned_back(axes: list[float], v: Triple) -> Triple:
    x, y, z = v
    return (
        axes[0] * x + axes[3] * y + axes[6] * z,
        axes[1] * x + axes[4] * y + axes[7] * z,
        axes[2] * x + axes[5] * y + axes[8] * z,
    )


class LiftDrag(LiftDragBase):
    """Lift, drag and pitching moment of a wing, fin or blade, by straight lines over the angle of attack with a stall.

    `<cp>` is in the link's frame. The air moves with the world's wind. Without `<reversible>` a stream from behind does
    nothing.
    """

    options = OptionsOf(MomentAerofoilOptions)
    filenames = ("gz-sim-lift-drag-system",)
    names = ("gz::sim::systems::LiftDrag",)


class LiftDragPlugin(LiftDragBase):
    """Lift and drag of a wing, fin or blade, from whichever side the stream comes; it makes no pitching moment.

    `<cp>` is seen from the link's centre of mass.
    """

    filenames = ("libLiftDragPlugin.so",)
    is_about_mass = True
