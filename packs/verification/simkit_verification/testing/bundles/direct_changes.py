"""Detector for direct changes to the physics (`set_pose`, `apply_wrench`, `sim.mj_data`).

The detector compares the state with the state after the last step. Therefore it finds a change independently of the
function that made it.
"""

from __future__ import annotations

from typing import Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit import Simulation
from simkit.errors import MessageError
from simkit.extend import counted
from simkit.runtime.engine.physics_step import STALE
from simkit.testing.run_record.record import Array
from simkit_verification.testing.bundles.journal_values import decode_array, encode_value

_STATE_PARTS: Final = (
    *("QPOS", "QVEL", "ACT", "CTRL", "QFRC_APPLIED", "XFRC_APPLIED"),
    *("EQ_ACTIVE", "MOCAP_POS", "MOCAP_QUAT"),
)
_SIGNATURE: Final = sum(int(getattr(mujoco.mjtState, f"mjSTATE_{part}")) for part in _STATE_PARTS)

Numbers = npt.NDArray[np.float64]


class DirectChanges:
    """Comparison of a simulation's physics with a state that was stored earlier.

    Args:
        sim: Simulation.
    """

    def __init__(self, sim: Simulation) -> None:
        self._sim = sim
        self._model: mujoco.MjModel | None = None
        self._state = np.empty(0)
        self._fields: dict[str, Array] = {}
        self._edition = -1
        self.store_state()

    def store_state(self) -> None:
        """Store the present state for the next comparison."""
        sim = self._sim
        self._state, self._model = state_vector(sim), sim.mj_model
        if self._edition != sim.engine.physics.edition:
            self._fields = _changeable_fields(sim)
            self._edition = sim.engine.physics.edition

    def changes(self) -> dict[str, object] | None:
        """Return the changes since the stored state; None if nothing changed or the model was recompiled."""
        sim = self._sim
        if sim.mj_model is not self._model:
            return None
        changes: dict[str, object] = {}
        now = state_vector(sim)
        if now.tobytes() != self._state.tobytes():
            changes["state"] = _encode_at_indices(now, np.flatnonzero(now.view(np.int64) != self._state.view(np.int64)))
        if self._edition != sim.engine.physics.edition:
            fields = _changed_fields(self._fields, _changeable_fields(sim))
            if fields:
                changes["fields"] = fields
        return changes | {"one_shot": bool(sim.engine.physics.one_shot)} if changes else None


def _encode_at_indices(values: Array, indices: Array) -> dict[str, object]:
    """Encode the values of an array at the given indices."""
    return {"size": values.size, "at": encode_value(indices), "values": encode_value(values[indices])}


def state_vector(sim: Simulation) -> Numbers:
    """Return positions, velocities, controls and forces as one vector."""
    values = np.empty(mujoco.mj_stateSize(sim.mj_model, _SIGNATURE))
    mujoco.mj_getState(sim.mj_model, sim.mj_data, values, _SIGNATURE)
    return values


def apply_changes(sim: Simulation, changes: dict[str, object]) -> None:
    """Apply recorded direct changes to the physics.

    Raises:
        MessageError: The changes do not fit this world.
    """
    if "fields" in changes:
        _apply_fields(sim, changes["fields"])
    if "state" in changes:
        _apply_state(sim, changes["state"])
    sim.engine.physics.push_once(bool(changes.get("one_shot")))


def _apply_state(sim: Simulation, changes: object) -> None:
    physics, values = sim.engine.physics, state_vector(sim)
    indices, numbers = _indices_and_values(changes, values.size)
    values[indices] = numbers
    before = sim.mj_data.qpos.copy(), sim.mj_data.qvel.copy(), sim.mj_data.xfrc_applied.copy()
    mujoco.mj_setState(sim.mj_model, sim.mj_data, values, _SIGNATURE)
    data, model = sim.mj_data, sim.mj_model
    joints = {int(j) for j, at in enumerate(model.jnt_qposadr) if _differs(before[0], data.qpos, model, j, int(at))}
    bodies = {int(model.jnt_bodyid[j]) for j in joints}
    bodies |= {int(model.dof_bodyid[d]) for d in np.flatnonzero(before[1] != data.qvel)}
    bodies |= {int(b) for b in np.flatnonzero((before[2] != data.xfrc_applied).any(axis=1))}
    bodies |= {int(model.dof_bodyid[d]) for d in np.flatnonzero(data.qfrc_applied)}
    physics.changed(STALE)
    for body in sorted(bodies):
        physics.changed_body(STALE, body)


_WIDTHS: Final = {int(mujoco.mjtJoint.mjJNT_FREE): 7, int(mujoco.mjtJoint.mjJNT_BALL): 4}


def _differs(before: Numbers, now: Numbers, model: mujoco.MjModel, joint: int, at: int) -> bool:
    width = _WIDTHS.get(int(model.jnt_type[joint]), 1)
    return bool((before[at : at + width] != now[at : at + width]).any())


def _changeable_fields(sim: Simulation) -> dict[str, Array]:
    """Copy the model fields that a user may have changed."""
    values = {name: getattr(sim.mj_model, name).copy() for name in sim.engine.originals}
    values["gravity"] = sim.mj_model.opt.gravity.copy()
    return values


def _changed_fields(before: dict[str, Array], now: dict[str, Array]) -> dict[str, object]:
    changes: dict[str, object] = {}
    for name, values in now.items():
        old = before.get(name)
        flat = values.reshape(-1)
        indices = np.arange(flat.size) if old is None else np.flatnonzero(old.reshape(-1) != flat)
        if indices.size:
            changes[name] = _encode_at_indices(flat, indices)
    return changes


def _apply_fields(sim: Simulation, changes: object) -> None:
    if not isinstance(changes, dict):
        raise MessageError("expected a mapping of model fields")
    for name, change in changes.items():
        if name == "gravity":
            old = sim.gravity
            indices, numbers = _indices_and_values(change, 3)
            old[indices] = numbers
            sim.gravity = old
            continue
        there = getattr(sim.mj_model, name, None) if name.isidentifier() and not name.startswith("_") else None
        if not isinstance(there, np.ndarray):
            raise MessageError(f"the model has no field {name!r:.60}")
        indices, numbers = _indices_and_values(change, there.size)
        sim.engine.physics.changed_model()
        values = sim.engine.touch(name).copy()
        values.reshape(-1)[indices] = numbers
        sim.engine.numbers.write(name, slice(None), values)


def _indices_and_values(changes: object, size: int) -> tuple[npt.NDArray[np.int64], Numbers]:
    """Decode the indices and values of changes to an array of a given size."""
    if not isinstance(changes, dict) or changes.get("size") != size:
        raise MessageError(f"the recorded change does not fit this world, whose array has {counted(size, 'number')}")
    indices, numbers = decode_array(changes.get("at")).astype(np.int64), decode_array(changes.get("values"))
    if indices.shape != numbers.shape or (indices < 0).any() or (indices >= size).any():
        raise MessageError("the recorded change has an index outside the array")
    return indices, numbers
