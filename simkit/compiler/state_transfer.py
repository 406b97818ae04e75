"""Transfer of state and changed fields between compiled models; common elements keep exactly the same bits."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Final

import mujoco
import numpy as np
import numpy.typing as npt

JOINT_WIDTHS: Final = {int(mujoco.mjtJoint.mjJNT_FREE): (7, 6), int(mujoco.mjtJoint.mjJNT_BALL): (4, 3)}
"""Numbers of position and velocity coordinates of a joint by MuJoCo's type; other types have one of each."""
_KINDS: Final = {
    "geom": mujoco.mjtObj.mjOBJ_GEOM,
    "body": mujoco.mjtObj.mjOBJ_BODY,
    "jnt": mujoco.mjtObj.mjOBJ_JOINT,
    "light": mujoco.mjtObj.mjOBJ_LIGHT,
    "eq": mujoco.mjtObj.mjOBJ_EQUALITY,
    "actuator": mujoco.mjtObj.mjOBJ_ACTUATOR,
    "tendon": mujoco.mjtObj.mjOBJ_TENDON,
    "cam": mujoco.mjtObj.mjOBJ_CAMERA,
    "mat": mujoco.mjtObj.mjOBJ_MATERIAL,
}
"""Kinds of elements by the prefixes of MuJoCo's model fields."""


def transfer_state(old: mujoco.MjModel, source: mujoco.MjData, new: mujoco.MjModel, target: mujoco.MjData) -> None:
    """Copy common elements by name: joints, mocap bodies, actuators, equalities, applied forces, time.

    The solver's warm start is copied as well, so that the trajectory continues without a change.
    """
    target.time = source.time
    copy_state(old, source, new, target, ("qvel", "qacc", "qacc_warmstart", "qfrc_applied"))
    for i, j in _pair_by_name("body", old.nbody, old, new):
        target.xfrc_applied[j] = source.xfrc_applied[i]
    for i, j in _pair_by_name("eq", old.neq, old, new):
        new.eq_data[j] = np.array(old.eq_data[i])
    mujoco.mj_forward(new, target)


def copy_state(
    old: mujoco.MjModel, source: mujoco.MjData, new: mujoco.MjModel, target: mujoco.MjData, dof_fields: Sequence[str]
) -> None:
    """Copy joints, poses of mocap bodies, controls, activations and active equalities that both models have."""
    for i, j in _pair_by_name("jnt", old.njnt, old, new):
        if old.jnt_type[i] == new.jnt_type[j]:
            positions, velocities = JOINT_WIDTHS.get(int(old.jnt_type[i]), (1, 1))
            a, b = int(old.jnt_qposadr[i]), int(new.jnt_qposadr[j])
            target.qpos[b : b + positions] = source.qpos[a : a + positions]
            a, b = int(old.jnt_dofadr[i]), int(new.jnt_dofadr[j])
            for field in dof_fields:
                getattr(target, field)[b : b + velocities] = getattr(source, field)[a : a + velocities]
    for i, j in _pair_by_name("body", old.nbody, old, new):
        a, b = int(old.body_mocapid[i]), int(new.body_mocapid[j])
        if a >= 0 and b >= 0:
            target.mocap_pos[b], target.mocap_quat[b] = source.mocap_pos[a], source.mocap_quat[a]
    for i, j in _pair_by_name("actuator", old.nu, old, new):
        target.ctrl[j] = source.ctrl[i]
        count = int(old.actuator_actnum[i])
        if count > 0 and count == int(new.actuator_actnum[j]):
            a, b = int(old.actuator_actadr[i]), int(new.actuator_actadr[j])
            target.act[b : b + count] = source.act[a : a + count]
    for i, j in _pair_by_name("eq", old.neq, old, new):
        target.eq_active[j] = source.eq_active[i]


def copy_fields_by_name(old: mujoco.MjModel, new: mujoco.MjModel, fields: Iterable[str]) -> None:
    """Copy changed model fields to a recompiled model, element by element by name."""
    for field in fields:
        copy_rows_by_name(field, getattr(old, field), getattr(new, field), old, new)


def copy_rows_by_name(
    field: str,
    source: npt.NDArray[np.float64],
    target: npt.NDArray[np.float64],
    old: mujoco.MjModel,
    new: mujoco.MjModel,
) -> None:
    """Copy the rows of one model field from one model to another by the names of their elements."""
    if field.startswith("dof_"):  # degrees of freedom are matched by the names of their joints
        for i, j in _pair_by_name("jnt", old.njnt, old, new):
            _, width = JOINT_WIDTHS.get(int(old.jnt_type[i]), (1, 1))
            a, b = int(old.jnt_dofadr[i]), int(new.jnt_dofadr[j])
            target[b : b + width] = source[a : a + width]
        return
    if field == "geom_matid":  # the rows are ids of materials, which have names, too
        materials = {-1: -1, **dict(_pair_by_name("mat", old.nmat, old, new))}
        for i, j in _pair_by_name("geom", len(source), old, new):
            target[j] = materials.get(int(source[i]), target[j])
        return
    for i, j in _pair_by_name(field.split("_")[0], len(source), old, new):
        target[j] = source[i]


def restore_compiled_fields(model: mujoco.MjModel, originals: Mapping[str, npt.NDArray[np.float64]]) -> None:
    """Restore the compiled values of a model that is not used at present.

    If a snapshot makes the model the present one again, the snapshot writes its changed values again.
    """
    for field, original in originals.items():
        getattr(model, field)[:] = original


def fields_on_changed_model(
    values: Mapping[str, npt.NDArray[np.float64]], before: Mapping[str, npt.NDArray[np.float64]], model: mujoco.MjModel
) -> dict[str, npt.NDArray[np.float64]]:
    """Return the values of model fields on a model with changed numbers.

    An element that differs from its compiled value keeps its value; all others get the numbers of the model.

    Args:
        values: values by field; fields without a compiled value are left out.
        before: compiled values before the change.
        model: model with the changed numbers.
    """
    return {
        field: np.where(value != before[field], value, getattr(model, field))
        for field, value in values.items()
        if field in before
    }


def _pair_by_name(prefix: str, count: int, old: mujoco.MjModel, new: mujoco.MjModel) -> list[tuple[int, int]]:
    """Return (id in the old model, id in the new model) of each named element of a kind that is in both models."""
    kind, pairs = _KINDS[prefix], []
    for i in range(count):
        name = mujoco.mj_id2name(old, kind, i)
        j = mujoco.mj_name2id(new, kind, name) if name else -1
        if j >= 0:
            pairs.append((i, j))
    return pairs
