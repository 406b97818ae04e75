"""State from one compiled model to the next: everything that exists in both keeps its bits."""

from __future__ import annotations

import mujoco
import numpy as np


def transfer_state(old: mujoco.MjModel, source: mujoco.MjData, new: mujoco.MjModel, target: mujoco.MjData) -> None:
    """Copies what both models have, by name: joints, mocap bodies, actuators, equalities, applied forces, time.

    The solver's warm start is carried as well, so a trajectory goes on as if nothing had happened around it.
    """
    obj = mujoco.mjtObj
    target.time = source.time
    for _, i, j in _shared_elements(old, new, obj.mjOBJ_JOINT):
        width_q = {0: 7, 1: 4}.get(int(old.jnt_type[i]), 1)
        width_v = {0: 6, 1: 3}.get(int(old.jnt_type[i]), 1)
        if old.jnt_type[i] != new.jnt_type[j]:
            continue
        a, b = int(old.jnt_qposadr[i]), int(new.jnt_qposadr[j])
        target.qpos[b : b + width_q] = source.qpos[a : a + width_q]
        a, b = int(old.jnt_dofadr[i]), int(new.jnt_dofadr[j])
        for field in ("qvel", "qacc", "qacc_warmstart", "qfrc_applied"):
            getattr(target, field)[b : b + width_v] = getattr(source, field)[a : a + width_v]
    for _, i, j in _shared_elements(old, new, obj.mjOBJ_BODY):
        target.xfrc_applied[j] = source.xfrc_applied[i]
        a, b = int(old.body_mocapid[i]), int(new.body_mocapid[j])
        if a >= 0 and b >= 0:
            target.mocap_pos[b], target.mocap_quat[b] = source.mocap_pos[a], source.mocap_quat[a]
    for _, i, j in _shared_elements(old, new, obj.mjOBJ_ACTUATOR):
        target.ctrl[j] = source.ctrl[i]
        n = int(old.actuator_actnum[i])
        if n > 0 and n == int(new.actuator_actnum[j]):
            a, b = int(old.actuator_actadr[i]), int(new.actuator_actadr[j])
            target.act[b : b + n] = source.act[a : a + n]
    for _, i, j in _shared_elements(old, new, obj.mjOBJ_EQUALITY):
        target.eq_active[j] = source.eq_active[i]
        new.eq_data[j] = np.array(old.eq_data[i])
    mujoco.mj_forward(new, target)


def _shared_elements(old: mujoco.MjModel, new: mujoco.MjModel, kind: mujoco.mjtObj) -> list[tuple[str, int, int]]:
    """(name, old id, new id) of named elements of both models."""
    count = {
        mujoco.mjtObj.mjOBJ_JOINT: old.njnt,
        mujoco.mjtObj.mjOBJ_BODY: old.nbody,
        mujoco.mjtObj.mjOBJ_ACTUATOR: old.nu,
        mujoco.mjtObj.mjOBJ_EQUALITY: old.neq,
    }[kind]
    pairs = []
    for i in range(count):
        name = mujoco.mj_id2name(old, kind, i)
        j = mujoco.mj_name2id(new, kind, name) if name else -1
        if j >= 0:
            pairs.append((name, i, int(j)))
    return pairs
