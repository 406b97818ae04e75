"""Host of controllers with joints that follow commands at once, or as far as a test allows, without physics."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

import simkit
from simkit import Params
from simkit.extend import Diagnostics
from simkit_control.plugins.ros2_control.controller import Controller
from simkit_control.plugins.ros2_control.hardware import Hardware
from simkit_control.plugins.ros2_control.hardware_interfaces import InterfaceTable
from simkit_control.plugins.ros2_control.hardware_joint import HardwareJoint

PERIOD = 0.01  # [s]
PHYSICS = f"<physics type='ode'><max_step_size>{PERIOD}</max_step_size></physics>"
EMPTY = f"<sdf version='1.9'><world name='lab'>{PHYSICS}</world></sdf>"
KINDS = ("position", "velocity", "effort")


class PerfectJoints(simkit.WorldPlugin):
    """Hosts one controller at 100 Hz: after each update a joint has the commanded position, or moves at the velocity.

    Args:
        cls: the controller's class.
        values: its parameters.
        start: first positions by joint [rad or m].
        limits: lower and upper, by joint.
        continuous: joints that turn without end.
        most: the furthest that each joint gets in a period [rad or m]; no bound for those left out.
    """

    def __init__(
        self,
        cls: Callable[..., Controller],
        values: dict[str, Any],
        start: dict[str, float],
        limits: dict[str, tuple[float, float]] | None = None,
        continuous: tuple[str, ...] = (),
        most: dict[str, float] | None = None,
    ) -> None:
        super().__init__()
        self.cls, self.given, self.start, self.limits = cls, values, start, limits or {}
        self.continuous, self.most = continuous, most or {}
        self.diagnostics = Diagnostics()
        self.commanded: list[list[float]] = []

    def load(self, parent: Any, params: Params) -> None:
        given = Params.from_dict(self.given, "arm_controller", self.diagnostics)
        joints = {}
        for name in self.start:
            low, high = self.limits.get(name, (-np.inf, np.inf))
            joints[name] = HardwareJoint(name, None, KINDS, low, high, is_continuous=name in self.continuous)
        names = [f"{joint}/{kind}" for joint in joints for kind in KINDS]
        self.hardware = Hardware(joints=joints, states=InterfaceTable(names), commands=InterfaceTable(names))
        self.hardware.states.values[:] = 0.0
        for name, position in self.start.items():
            self.hardware.states.values[self.hardware.states.index(f"{name}/position")] = position
        self.controller: Any = self.cls("arm_controller", self, given, self.hardware)
        self.controller.configure()
        given.report_unread("SK-CONTROL-011", "the controller")
        if self.diagnostics.has_errors:
            return
        self.controller.states = self.hardware.states.select(self.controller.state_interfaces())
        self.controller.commands = self.hardware.commands.select(self.controller.command_interfaces())
        self.controller.activate()

    def before_step(self) -> None:
        if self.diagnostics.has_errors:
            return
        self.controller.update(self.sim.time_ns, PERIOD)
        states, commands = self.hardware.states, self.hardware.commands
        self.commanded.append(self.controller.commands.values.tolist())
        for name in self.start:
            place, rate = states.index(f"{name}/position"), states.index(f"{name}/velocity")
            before, wanted = states.values[place], commands.values[place]
            if np.isnan(wanted):
                moved = np.nan_to_num(commands.values[rate]) * PERIOD
            else:
                low, high = self.limits.get(name, (-np.inf, np.inf))
                moved = np.clip(wanted, low, high) - before
            most = self.most.get(name, np.inf)
            moved = float(np.clip(moved, -most, most))
            states.values[place], states.values[rate] = before + moved, moved / PERIOD

    def get_state(self) -> dict[str, Any]:
        tables = self.hardware.states.values.copy(), self.hardware.commands.values.copy()
        return {**super().get_state(), "_controller": self.controller.get_state(), "_tables": tables}

    def set_state(self, state: Mapping[str, Any]) -> None:
        super().set_state({k: v for k, v in state.items() if k not in ("_controller", "_tables")})
        self.controller.set_state(state["_controller"])
        self.hardware.states.values[:], self.hardware.commands.values[:] = state["_tables"]

    def position(self, joint: str) -> float:
        """Where a joint is [rad or m]."""
        return float(self.hardware.states.values[self.hardware.states.index(f"{joint}/position")])


def host(cls: Any, values: dict[str, Any], start: dict[str, float], **options: Any) -> tuple[Any, PerfectJoints]:
    """The controller in an empty world."""
    plugin = PerfectJoints(cls, values, start, **options)
    return simkit.load(EMPTY, plugins=[plugin]), plugin


def trajectory(joints: list[str], *points: Any, stamp: float = 0.0) -> dict[str, Any]:
    """A trajectory of (time, positions[, velocities[, accelerations]])."""
    return {
        "header": {"stamp": _time(stamp)},
        "joint_names": joints,
        "points": [
            {
                "time_from_start": _time(time),
                **dict(zip(("positions", "velocities", "accelerations"), rest, strict=False)),
            }
            for time, *rest in points
        ],
    }


def _time(seconds: float) -> dict[str, int]:
    sec, nanosec = divmod(round(seconds * 1e9), 1_000_000_000)
    return {"sec": sec, "nanosec": nanosec}
