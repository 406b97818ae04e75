"""Welds that close and let go while time goes on."""

from __future__ import annotations

from typing import TYPE_CHECKING

from simkit.pose import Pose, quat_conjugate, quat_multiply
from simkit.runtime.physics import STALE

if TYPE_CHECKING:
    from simkit.runtime.simulation import Simulation


def set_weld(sim: Simulation, name: str, closed: bool) -> None:
    """Closes a weld with its bodies as they stand, or lets it go. Raises KeyError.

    The constraint keeps the anchor, a point of the second body, where it is in the first, and their orientations:
    seven numbers of `eq_data` behind the anchor's three.
    """
    number = sim.names.equality(name)
    model, data = sim.mj_model, sim.physics.fresh()
    first, second = int(model.eq_obj1id[number]), int(model.eq_obj2id[number])
    if closed:
        one, two = (Pose(data.xpos[b], data.xquat[b]) for b in (first, second))
        row = sim.touch("eq_data")[number]
        row[3:6] = one.inverse().transform(two.transform(row[:3]))
        row[6:10] = quat_multiply(quat_conjugate(one.quaternion), two.quaternion)
    sim.mj_data.eq_active[number] = closed
    for body in (first, second):
        sim.physics.changed_body(STALE, body)
