"""Numbers of a joint that a program may set during a run: damping, dry friction, armature and gains of its servos."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from simkit.argument_checks import checked_number, wrong_value
from simkit.errors import InputError
from simkit.number_text import counted
from simkit.pose import Vector
from simkit.runtime.handles.handle import Handle

JointValue = float | Any
"""Number of a joint: a float for one degree of freedom, else an array, which type checkers do not check."""

_GAIN_KINDS = {"kp": ("position",), "kv": ("position", "velocity")}


class TunableJoint(Handle):
    """Joint with settable numbers. One degree of freedom has a float, more have an array."""

    _dofs: Vector

    @property
    def damping(self) -> JointValue:
        """Damping [N·m·s/rad or N·s/m]; settable."""
        return self._numbers("dof_damping")

    @damping.setter
    def damping(self, value: float | Sequence[float]) -> None:
        self._set_numbers("damping", "dof_damping", value)

    @property
    def stiction(self) -> JointValue:
        """Dry friction [N·m or N]; settable."""
        return self._numbers("dof_frictionloss")

    @stiction.setter
    def stiction(self, value: float | Sequence[float]) -> None:
        self._set_numbers("stiction", "dof_frictionloss", value)

    @property
    def armature(self) -> JointValue:
        """Inertia of the rotor of the joint's motor [kg·m² or kg]; settable."""
        return self._numbers("dof_armature")

    @armature.setter
    def armature(self, value: float | Sequence[float]) -> None:
        self._set_numbers("armature", "dof_armature", value)
        self._engine.numbers.derive()

    @property
    def kp(self) -> float:
        """Position gain of the joint's servo [N·m/rad or N/m]; settable. 0 for a velocity servo."""
        index, kind = self._servo("kp", _GAIN_KINDS["kv"])
        return -float(self._physics.model.actuator_biasprm[index, 1]) if kind == "position" else 0.0

    @kp.setter
    def kp(self, value: float) -> None:
        gain, (index, _) = checked_number(value, "kp", 0.0), self._servo("kp", _GAIN_KINDS["kp"])
        self._engine.numbers.write("actuator_gainprm", (index, 0), gain)
        self._engine.numbers.write("actuator_biasprm", (index, 1), -gain)
        self._engine.numbers.keep("joint", self.scoped, "kp", gain)

    @property
    def kv(self) -> float:
        """Velocity gain of the joint's servo [N·m·s/rad or N·s/m]; settable."""
        return -float(self._physics.model.actuator_biasprm[self._servo("kv", _GAIN_KINDS["kv"])[0], 2])

    @kv.setter
    def kv(self, value: float) -> None:
        gain, (index, kind) = checked_number(value, "kv", 0.0), self._servo("kv", _GAIN_KINDS["kv"])
        if kind == "velocity":
            self._engine.numbers.write("actuator_gainprm", (index, 0), gain)
        self._engine.numbers.write("actuator_biasprm", (index, 2), -gain)
        self._engine.numbers.keep("joint", self.scoped, "kv", gain)

    def _numbers(self, field: str) -> JointValue:
        self.check_present()
        values = getattr(self._physics.model, field)[self._dofs]
        return float(values[0]) if len(values) == 1 else np.array(values)

    def _set_numbers(self, name: str, field: str, value: float | Sequence[float]) -> None:
        self.check_present()
        count = len(self._dofs)
        entries = [value] * count if np.ndim(value) == 0 else list(value)  # type: ignore[arg-type]  # a number or numbers
        if len(entries) != count:
            raise wrong_value(name, f"one number or {counted(count, 'number')}", value)
        numbers = [checked_number(number, name, 0.0) for number in entries]
        if count:
            self._engine.numbers.write(field, self._dofs, numbers)
        self._engine.numbers.keep("joint", self.scoped, name, numbers)

    def _servo(self, name: str, kinds: Sequence[str]) -> tuple[int, str]:
        """Return id and kind of the servo that a plugin added to the joint."""
        self.check_present()
        records = self._engine.structure.builder.records.values()
        for ref in (ref for record in records for ref in record.actuators):
            if ref.joint == self.scoped and ref.kind in kinds:
                return self._engine.names.actuator(ref), ref.kind
        message = f"joint {self.scoped!r} has no {' or '.join(kinds)} servo, so it has no {name}"
        raise InputError("SK-CORE-006", message)
