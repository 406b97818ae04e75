"""On-off thruster of a spacecraft: `gz::sim::systems::SpacecraftThrusterModel`.

A command of 0 to 1 is the share of each period 1 / duty_cycle_frequency in which the thruster pushes with its full
thrust along the z axis of its link. The periods begin with the first command.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import ModelPlugin, Params
from simkit.extend import LARGEST, Options, OptionsOf, counted, find_named_link, integer, listens, number, text
from simkit.msgs import valid_topic
from simkit.plugins.joints.joint_commands import ACTUATORS
from simkit_water_and_air.plugins.fluids.link_forces import PushedLinks, moving_data

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import SceneModel, SpecBuilder
    from simkit.msgs import Actuators

_EARLY: Final = 1e-9  # share of a step by which rounding may delay an event


class SpacecraftThrusterOptions(Options):
    """Options of `SpacecraftThrusterModel`."""

    link_name: str = text(None, required=True)
    topic: str = text()
    sub_topic: str = text()
    actuator_number: int = integer(None, minimum=0, required=True)
    max_thrust: float = number(None, "N", minimum=0, maximum=LARGEST, required=True)
    duty_cycle_frequency: float = number(10.0, "Hz", minimum=1e-6, maximum=1e6)


class SpacecraftThrusterModel(ModelPlugin):
    """Pushes a link with pulses of full thrust along its z axis, whose length follows a command from 0 to 1.

    The command is number `<actuator_number>` of `normalized` in an `Actuators` message on `<topic>/<sub_topic>`; the
    topic is the model's name by default.
    """

    endpoints = (listens("/{model}", ACTUATORS, named_by=("topic", "sub_topic")),)
    options = OptionsOf(SpacecraftThrusterOptions)
    filenames = ("gz-sim-spacecraft-thruster-model-system",)
    names = ("gz::sim::systems::SpacecraftThrusterModel",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        self.options.read_all()
        self._link = find_named_link(scene, "link_name", params)

    def load(self, parent: Model, params: Params) -> None:
        options = self.options
        self._links = PushedLinks(self.sim, (self._link,))
        self._share: float | None = None  # None before the first command
        self._start = 0  # tick at which the period began
        topic = options.topic or parent.name
        self.listen(valid_topic(f"/{topic}/{options.sub_topic}"), ACTUATORS, self._on_command)

    def _on_command(self, message: Actuators) -> None:
        shares, number = message.normalized, self.options.actuator_number
        if number >= len(shares):
            what = f"a message has {counted(len(shares), 'normalized value')} and none for actuator {number}"
            self._once.left_out("short", f"{what}; the message is ignored")
        elif math.isnan(shares[number]):
            self._once.not_finite()
        else:
            if self._share is None:
                self._start = self.sim.tick
            self._share = float(shares[number])

    def before_step(self) -> None:
        """Push the link for the next step if the thruster is on."""
        if self._share is None:
            return
        if not self._links.is_current:
            self._links = PushedLinks(self.sim, (self._link,))
        options = self.options
        duration = 1 / (options.duty_cycle_frequency * self.period)  # of a period [steps]
        elapsed = self.sim.tick - self._start
        if elapsed >= duration * (1 - _EARLY):
            self._start, elapsed = self.sim.tick, 0
        if elapsed >= self._share * duration * (1 - _EARLY) or not len(self._links):
            return
        data = moving_data(self.sim)
        body = self._links.ids[0]
        force = data.xmat[body].reshape(3, 3)[:, 2] * options.max_thrust
        self._links.push(data, force[None], np.zeros((1, 3)))
