"""Models back to where they started, while time goes on: what Gazebo Classic's `/reset_world` does."""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING, Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.runtime.engine.model_edits import pair_by_name
from simkit.runtime.engine.physics_state import STALE

if TYPE_CHECKING:
    from simkit.runtime.engine.engine import Engine
    from simkit.runtime.engine.snapshot import Snapshot, Stateful

_JOINT_WIDTHS: Final = {int(mujoco.mjtJoint.mjJNT_FREE): (7, 6), int(mujoco.mjtJoint.mjJNT_BALL): (4, 3)}
_PLACE_FIELDS: Final = ("body_pos", "body_quat")  # of what is fixed or hinged to the world and was moved

Values = npt.NDArray[np.float64] | npt.NDArray[np.bool_]


def reset_models(engine: Engine, models: Collection[Stateful], loaded: Snapshot) -> None:
    """Puts every model back: one that was loaded to its first state, one that was spawned since to where it came.

    What was removed stays away. Positions, velocities, controls, welds and the places of static models are set;
    forces that wait for the next step are dropped.

    Args:
        engine: of the simulation.
        models: handles of the models that are there.
        loaded: the state at the start.
    """
    for sensor in engine.structure.all_sensors():
        sensor.take_held()
    model, data = engine.mj_model, engine.mj_data
    first, first_data = loaded.structure.compiled.model, loaded.data
    for field in _PLACE_FIELDS:
        if field in engine.originals:
            engine.touch(field)[:] = engine.original(field)
    fresh = mujoco.MjData(model)
    data.qpos[:], data.qvel[:] = fresh.qpos, 0.0
    data.mocap_pos[:], data.mocap_quat[:] = fresh.mocap_pos, fresh.mocap_quat
    data.ctrl[:], data.eq_active[:] = fresh.ctrl, fresh.eq_active
    data.qacc_warmstart[:] = data.qfrc_applied[:] = 0.0
    data.xfrc_applied[:] = engine.physics.persistent_wrenches
    _copy_joints(first, first_data, model, data)
    _copy_rows(mujoco.mjtObj.mjOBJ_ACTUATOR, first, first_data.ctrl, model, data.ctrl)
    _copy_activations(first, first_data, model, data)
    _copy_rows(mujoco.mjtObj.mjOBJ_EQUALITY, first, first_data.eq_active, model, data.eq_active)
    _copy_mocap(first, first_data, model, data)
    engine.velocity_servos.set_state(next(state for part, state in loaded.handles if part is engine.velocity_servos))
    engine.physics.one_shot = False
    engine.physics.changed_model()
    engine.physics.changed(STALE)
    for handle, state in loaded.handles:
        if handle in models:
            handle.set_state(state)
    for plugin, state in loaded.plugins:
        if plugin in engine.structure.all_plugins():
            engine.faults.take_back(plugin, state)


def _copy_activations(old: mujoco.MjModel, old_data: mujoco.MjData, new: mujoco.MjModel, data: mujoco.MjData) -> None:
    """Of actuators that were there; that of others belongs to plugins that go on."""
    for i, j in pair_by_name(mujoco.mjtObj.mjOBJ_ACTUATOR, old.nu, old, new):
        a, b, count = int(old.actuator_actadr[i]), int(new.actuator_actadr[j]), int(old.actuator_actnum[i])
        if count > 0 and count == int(new.actuator_actnum[j]):
            data.act[b : b + count] = old_data.act[a : a + count]


def _copy_joints(old: mujoco.MjModel, old_data: mujoco.MjData, new: mujoco.MjModel, data: mujoco.MjData) -> None:
    for i, j in pair_by_name(mujoco.mjtObj.mjOBJ_JOINT, old.njnt, old, new):
        wide, free = _JOINT_WIDTHS.get(int(old.jnt_type[i]), (1, 1))
        a, b = int(old.jnt_qposadr[i]), int(new.jnt_qposadr[j])
        data.qpos[b : b + wide] = old_data.qpos[a : a + wide]
        a, b = int(old.jnt_dofadr[i]), int(new.jnt_dofadr[j])
        data.qvel[b : b + free] = old_data.qvel[a : a + free]


def _copy_rows(
    kind: mujoco.mjtObj, old: mujoco.MjModel, old_values: Values, new: mujoco.MjModel, values: Values
) -> None:
    for i, j in pair_by_name(kind, len(old_values), old, new):
        values[j] = old_values[i]


def _copy_mocap(old: mujoco.MjModel, old_data: mujoco.MjData, new: mujoco.MjModel, data: mujoco.MjData) -> None:
    for i, j in pair_by_name(mujoco.mjtObj.mjOBJ_BODY, old.nbody, old, new):
        a, b = int(old.body_mocapid[i]), int(new.body_mocapid[j])
        if a >= 0 and b >= 0:
            data.mocap_pos[b], data.mocap_quat[b] = old_data.mocap_pos[a], old_data.mocap_quat[a]
