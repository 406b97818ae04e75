"""Warning about robots that folded during a run, because nothing drives their joints."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import mujoco
import numpy as np

from simkit.diagnostics import Diagnostics
from simkit.number_text import counted

if TYPE_CHECKING:
    from simkit.runtime.simulation import Simulation

_SHARE: Final = 0.25
"""Share of the height of a robot's base over its lowest link; the base of a robot that folded sank by more."""

_MOST: Final = 4.0
"""Largest share; a model that fell off something sank by more, and `find_fallen_models` reports it."""

_FEWEST: Final = 4
"""Fewest joints of a robot with legs; a cart without a drive has wheels, which do not fold."""

_HINT: Final = "pass --hold-joints to hold them at their initial positions, or give the robot controllers"


def find_folded_models(sim: Simulation) -> Diagnostics:
    """Return a warning for each free model whose base sank, and whose joints no plugin drives."""
    diagnostics, model, data = Diagnostics(), sim.mj_model, sim.mj_data
    first = mujoco.MjData(model)
    mujoco.mj_kinematics(model, first)
    for root in np.flatnonzero(model.jnt_type == mujoco.mjtJoint.mjJNT_FREE).tolist():
        body = int(model.jnt_bodyid[root])
        below = model.body_rootid == body
        joints = np.flatnonzero(below[model.jnt_bodyid])[1:]
        name = model.body(body).name.partition("::")[0]
        found = sim.models.get(name)
        if found is None or len(joints) < _FEWEST or np.isin(model.actuator_trnid[:, 0], joints).any():
            continue
        parts = sim.engine.structure.parts.get(name)
        if parts is not None and any(entry.plugin.drives for entry in parts.plugins):
            continue
        height = float(first.xpos[body, 2] - first.xpos[below, 2].min())
        sunk = float(first.xpos[body, 2] - data.xpos[body, 2])
        if _SHARE * height < sunk < _MOST * height:
            text = f"{name}: nothing drives its {counted(len(joints), 'joint')}, so it folded, as in Gazebo"
            diagnostics.warning("SK-JOINT-020", f"{text}: its base sank by {sunk:.2g} m", found.scene.where, _HINT)
    return diagnostics
