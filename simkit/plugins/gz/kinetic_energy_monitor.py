"""Kinetic energy monitor of Gazebo: `gz::sim::systems::KineticEnergyMonitor`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import mujoco
import numpy as np

from simkit import msgs
from simkit.linear_algebra import dot
from simkit.params import Params
from simkit.plugins.base import ModelPlugin
from simkit.plugins.find_entities import find_named_link, read_topic
from simkit.plugins.options import Options, OptionsOf, number, text
from simkit.plugins.publish_on_demand import watch_while_subscribed

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.pose import Vector
    from simkit.runtime import Model
    from simkit.scene import SceneModel

DOUBLE: Final = "std_msgs/msg/Float64"
_BODY: Final = int(mujoco.mjtObj.mjOBJ_BODY)  # velocity at the centre of mass, in the axes of the inertia


class KineticEnergyMonitorOptions(Options):
    """Options of `KineticEnergyMonitor`."""

    link_name: str = text(required=True)
    kinetic_energy_threshold: float = number(7.0, minimum=0.0)
    topic: str = text()


class KineticEnergyMonitor(ModelPlugin):
    """Publishes the kinetic energy [J] that a link lost within one step, if it exceeds a threshold.

    The energy of translation and rotation, m v²/2 + ω·Iω/2, is computed from the link's own mass and inertia.
    """

    options = OptionsOf(KineticEnergyMonitorOptions)
    filenames = ("gz-sim-kinetic-energy-monitor-system",)
    names = ("gz::sim::systems::KineticEnergyMonitor",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self._scoped = find_named_link(scene, "link_name", params)
        self._threshold = self.options.kinetic_energy_threshold

    def load(self, parent: Model, params: Params) -> None:
        self._lost = self.advertise(read_topic(params, "topic", f"/model/{parent.name}/kinetic_energy"), DOUBLE)
        self._energy = 0.0
        self._was_heard = False
        watch_while_subscribed(self, (self._lost,), "look")

    def begin(self) -> None:
        """Store the link's kinetic energy when the first subscriber appears."""
        self._energy = self._kinetic_energy()

    def look(self) -> None:
        """Publish the loss of kinetic energy since the previous step, if it exceeds the threshold."""
        before, self._energy = self._energy, self._kinetic_energy()
        lost = before - self._energy
        if lost > self._threshold and self._lost.wanted:
            self._lost.publish(msgs.type_of(DOUBLE)(lost))

    def _kinetic_energy(self) -> float:
        """Return the kinetic energy of the link [J]."""
        sim = self.sim
        body = sim.engine.names.link(self._scoped).body
        if not body:
            return 0.0
        twist = np.zeros(6)
        mujoco.mj_objectVelocity(sim.mj_model, sim.engine.physics.fresh(), _BODY, body, twist, 1)
        turning, moving = twist[:3], twist[3:]
        inertia: Vector = sim.mj_model.body_inertia[body]
        return 0.5 * (float(sim.mj_model.body_mass[body]) * dot(moving, moving) + dot(inertia, turning * turning))
