"""Host of a differential drive controller, with wheels that turn exactly as commanded, without physics."""

from __future__ import annotations

from typing import Any

import numpy as np

import simkit
from simkit import Params
from simkit.extend import Diagnostics
from simkit_control.controllers.diff_drive import DiffDriveController
from simkit_control.plugins.ros2_control.hardware import Hardware
from simkit_control.plugins.ros2_control.hardware_interfaces import InterfaceTable

PHYSICS = "<physics type='ode'><max_step_size>0.01</max_step_size></physics>"
EMPTY = f"<sdf version='1.9'><world name='lab'>{PHYSICS}</world></sdf>"
RADIUS, SEPARATION = 0.1, 0.4
WHEELS = {"left_wheel_names": ["left"], "right_wheel_names": ["right"]}
PERIOD = 0.01  # [s]


class PerfectWheels(simkit.WorldPlugin):
    """Hosts the controller at 100 Hz, and turns each wheel by its commanded speed times a factor of its own.

    Args:
        values: the controller's parameters.
        factors: by joint, what part of the commanded speed it turns with.
        start: by joint, its angle at the start [rad].
    """

    def __init__(
        self,
        values: dict[str, Any],
        factors: dict[str, float] | None = None,
        start: dict[str, float] | None = None,
    ) -> None:
        super().__init__()
        self.values, self.factors, self.first = values, factors or {}, start or {}
        self.diagnostics = Diagnostics()
        self.written: list[tuple[float, ...]] = []

    def load(self, parent: Any, params: Params) -> None:
        given = Params.from_dict(self.values, "base", self.diagnostics)
        self.controller = controller = DiffDriveController("base", self, given, Hardware())
        controller.configure()
        if self.diagnostics.has_errors:
            return
        commands, states = list(controller.command_interfaces()), list(controller.state_interfaces())
        joints = list(dict.fromkeys(name.split("/")[0] for name in commands))
        table = InterfaceTable(f"{joint}/{what}" for joint in joints for what in ("position", "velocity"))
        self.hardware = Hardware(states=table, commands=InterfaceTable(commands))
        table.values[:] = 0
        for joint, angle in self.first.items():
            table.values[table.index(f"{joint}/position")] = angle
        self.hardware.commands.values[:] = 0
        controller.hardware = self.hardware
        controller.states, controller.commands = table.select(states), self.hardware.commands.select(commands)
        self.joints = joints
        controller.activate()

    def before_step(self) -> None:
        if self.diagnostics.has_errors:
            return
        self.controller.update(self.sim.time_ns, PERIOD)
        commands, states = self.hardware.commands, self.hardware.states
        self.written.append(tuple(commands.values))
        for joint in self.joints:
            speed = commands.values[commands.index(f"{joint}/velocity")] * self.factors.get(joint, 1.0)
            states.values[states.index(f"{joint}/velocity")] = speed
            states.values[states.index(f"{joint}/position")] += speed * PERIOD

    @property
    def speeds(self) -> np.ndarray[Any, Any]:
        """Speed ahead [m/s] and rate of turning [rad/s] that were commanded in each period, by two wheels."""
        left, right = np.array(self.written).T * RADIUS
        return np.array([(left + right) / 2, (right - left) / SEPARATION]).T


def drive(
    values: dict[str, Any] | None = None,
    factors: dict[str, float] | None = None,
    start: dict[str, float] | None = None,
) -> tuple[simkit.Simulation, PerfectWheels]:
    """The controller in an empty world."""
    settings = {**WHEELS, "wheel_separation": SEPARATION, "wheel_radius": RADIUS, **(values or {})}
    host = PerfectWheels({k: v for k, v in settings.items() if v is not None}, factors, start)
    return simkit.load(EMPTY, plugins=[host]), host
