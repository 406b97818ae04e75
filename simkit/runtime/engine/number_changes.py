"""Numbers of the compiled model that a program sets during a run: masses, friction, joint dynamics, gains.

A change has the same effect as the same value in the file. Spawned and removed models keep it, snapshots restore it,
and a reset returns to the loaded values.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.compiler.model_compilation import apply_velocity_decay
from simkit.compiler.number_edits import DERIVED_FIELDS, body_numbers, set_mean_values
from simkit.compiler.servo_gains import tuned_gains
from simkit.compiler.state_transfer import copy_rows_by_name, fields_on_changed_model
from simkit.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from simkit.runtime.engine.engine_state import EngineState
    from simkit.scene import Inertial, SceneLink

Numbers = npt.NDArray[np.float64]
ChangeKey = tuple[str, str, str]
"""Kind and scoped name of an entity, and the name of the changed attribute."""

NumberState = tuple[dict[str, "Inertial"], dict[ChangeKey, object], dict[str, Numbers]]
"""Changed masses and inertias by link, changed attributes, and given values by field of the model."""

_GAINS: Final = ("actuator_gainprm", "actuator_biasprm")


class NumberChanges:
    """Changes of numbers by a program.

    Args:
        engine: engine of the simulation.
        renew_servos: function that lets the velocity servos derive their constants again.

    Attributes:
        inertials: changed masses and inertias by the scoped name of the link.
        values: changed attributes, so that a reset can keep them.
    """

    def __init__(self, engine: EngineState, renew_servos: Callable[[], None]) -> None:
        self._engine, self._renew_servos = engine, renew_servos
        self.inertials: dict[str, Inertial] = {}
        self.values: dict[ChangeKey, object] = {}
        self._given: dict[str, Numbers] = {}

    def compiled_values(self) -> Mapping[str, Numbers]:
        """Return the values that the file and the program gave, of all fields that were written to since the compile.

        Values that plugins wrote are not included, for example those of an empty battery to the gains of a servo.
        """
        return {**self._engine.originals, **self._given}

    def write(self, field: str, rows: Any, values: Any) -> None:
        """Write rows of a model field."""
        self._engine.touch(field)[rows] = values
        numbers = self._given.setdefault(field, self._engine.original(field).copy())
        numbers[rows] = values
        self.renew()

    def keep(self, kind: str, scoped: str, attribute: str, value: object) -> None:
        """Record a changed attribute of a handle, so that a reset can keep it."""
        self.values = {**self.values, (kind, scoped, attribute): value}

    def inertial(self, link: SceneLink) -> Inertial:
        """Return the present mass and inertia of a link."""
        return self.inertials.get(link.scoped, link.inertial)

    def set_inertial(self, link: SceneLink, inertial: Inertial) -> None:
        """Set the mass and the inertia of a link.

        Raises:
            InputError: SK-CORE-006 the link does not move, or the engine has its inertia in another form.
        """
        engine = self._engine
        body_and_numbers = body_numbers(engine.compiled, engine.world, link, inertial)
        if body_and_numbers is None:
            message = f"the mass or inertia of link {link.scoped!r} cannot change in this way during a run"
            reason = "it does not move, it closes a loop, or its inertia gets other principal axes"
            help_ = f"scale the inertia, or set it before the load: overrides=['{link.scoped}.inertial.inertia=…']"
            raise InputError("SK-CORE-006", f"{message}: {reason}", help=help_)
        body, numbers = body_and_numbers
        for field, value in numbers.items():
            self.write(field, body, value)
        self.inertials = {**self.inertials, link.scoped: inertial}
        self.derive()

    def derive(self) -> None:
        """Compute the numbers that follow from masses, inertias and armatures."""
        engine = self._engine
        model, records = engine.mj_model, list(engine.structure.builder.records.values())
        for field in DERIVED_FIELDS:
            engine.touch(field)
        mujoco.mj_setConst(model, mujoco.MjData(model))
        set_mean_values(engine.compiled)
        if any(record.damped for record in records):
            engine.touch("dof_damping")
            apply_velocity_decay(model, records)
        reference = self.compiled_values()
        for index, gain, bias in tuned_gains(model, [ref for record in records for ref in record.actuators]):
            gains = [reference.get(field, getattr(model, field))[index] for field in _GAINS]
            if all(np.array_equal(v, getattr(model, f)[index]) for f, v in zip(_GAINS, gains, strict=True)):
                self.write("actuator_gainprm", (index, 0), gain)
                self.write("actuator_biasprm", (index, slice(0, 3)), bias)
        self.renew()

    def renew(self) -> None:
        """Compute again what the servos and the physics derive from masses, inertias and gains."""
        self._renew_servos()
        self._engine.physics.renew_pushes()

    def carry(self, old: mujoco.MjModel, new: mujoco.MjModel) -> None:
        """Move the values that were given to a recompiled model, element by element by name."""
        carried = {}
        for field, numbers in self._given.items():
            carried[field] = self._engine.originals.get(field, getattr(new, field)).copy()
            copy_rows_by_name(field, numbers, carried[field], old, new)
        self._given = carried

    @staticmethod
    def on_changed_model(state: NumberState, before: Mapping[str, Numbers], model: mujoco.MjModel) -> NumberState:
        """Return a state for a model whose compiled values have changed, as in `fields_on_changed_model`."""
        return state[0], state[1], fields_on_changed_model(state[2], before, model)

    def get_state(self) -> NumberState:
        """Return the changes for a snapshot."""
        return (
            dict(self.inertials),
            dict(self.values),
            {field: numbers.copy() for field, numbers in self._given.items()},
        )

    def set_state(self, state: NumberState) -> None:
        """Restore changes from `get_state`; the snapshot has restored the model's fields."""
        if self._given or state[2]:
            self.renew()
            set_mean_values(self._engine.compiled)
        self.inertials, self.values = dict(state[0]), dict(state[1])
        self._given = {field: numbers.copy() for field, numbers in state[2].items()}
