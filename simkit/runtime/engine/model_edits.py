"""Fields of MuJoCo's model that were changed while a simulation runs, carried from one compiled model to another."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import mujoco
import numpy as np
import numpy.typing as npt

_OBJECT_BY_PREFIX = {
    "geom": mujoco.mjtObj.mjOBJ_GEOM,
    "body": mujoco.mjtObj.mjOBJ_BODY,
    "jnt": mujoco.mjtObj.mjOBJ_JOINT,
    "light": mujoco.mjtObj.mjOBJ_LIGHT,
    "eq": mujoco.mjtObj.mjOBJ_EQUALITY,
    "actuator": mujoco.mjtObj.mjOBJ_ACTUATOR,
}
_DOFS = {int(mujoco.mjtJoint.mjJNT_FREE): 6, int(mujoco.mjtJoint.mjJNT_BALL): 3}


def copy_fields_by_name(old: mujoco.MjModel, new: mujoco.MjModel, fields: Iterable[str]) -> None:
    """Copies changed model fields to a recompiled model, element by element by name."""
    for field in fields:
        source, target = getattr(old, field), getattr(new, field)
        if field.startswith("dof_"):  # without names of their own
            _copy_dof_field(old, new, source, target)
            continue
        for i, j in pair_by_name(_OBJECT_BY_PREFIX[field.split("_")[0]], len(source), old, new):
            target[j] = source[i]


def restore_compiled_fields(model: mujoco.MjModel, originals: Mapping[str, npt.NDArray[np.float64]]) -> None:
    """Writes the compiled values back to a model that is left: who returns to it brings the changes of then."""
    for field, original in originals.items():
        getattr(model, field)[:] = original


def pair_by_name(kind: mujoco.mjtObj, count: int, old: mujoco.MjModel, new: mujoco.MjModel) -> list[tuple[int, int]]:
    """Return (id in the old model, id in the new one) of everything of a kind that both have under one name."""
    found = []
    for i in range(count):
        name = mujoco.mj_id2name(old, kind, i)
        j = mujoco.mj_name2id(new, kind, name) if name else -1
        if j >= 0:
            found.append((i, j))
    return found


def _copy_dof_field(
    old: mujoco.MjModel, new: mujoco.MjModel, source: npt.NDArray[np.float64], target: npt.NDArray[np.float64]
) -> None:
    """Copies a field by degrees of freedom, which have the names of their joints."""
    for i, j in pair_by_name(mujoco.mjtObj.mjOBJ_JOINT, old.njnt, old, new):
        width = _DOFS.get(int(old.jnt_type[i]), 1)
        a, b = int(old.jnt_dofadr[i]), int(new.jnt_dofadr[j])
        target[b : b + width] = source[a : a + width]
