"""Contacts between models, links and collisions by name."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import mujoco
import numpy as np

from simkit.float_sum import float_sum
from simkit.runtime import Simulation
from simkit.runtime.contact.collision_contacts import Bools, collision_table

if TYPE_CHECKING:
    from simkit.compiler import Compiled

_MAX_SLOPE: Final = math.cos(math.radians(45.0))
_MANY_CONTACTS: Final = 32  # arrays are faster than Python numbers if there are more contacts
_HEIGHT_MAP: Final = int(mujoco.mjtGeom.mjGEOM_HFIELD)


class ContactQuery:
    """Contacts of one model, link or collision, or contacts between two of them.

    Two surfaces are in contact if they touch or overlap. Without a second name, contacts with the ground are ignored.
    The ground consists of height maps and of static surfaces that push the first entity upwards, within 45° of the
    vertical (floors, ramps, top faces of steps). Contacts between collisions of the first entity are ignored too.

    Args:
        sim: Simulation.
        first: Scoped name.
        second: Scoped name of the second entity; None for all other entities.
    """

    def __init__(self, sim: Simulation, first: str, second: str | None = None) -> None:
        self._sim, self._first, self._second = sim, first, second
        self._compiled: Compiled | None = None
        self._asleep_at = -1
        self._asleep: tuple[tuple[int, int, int], ...] = ()

    def now(self) -> tuple[tuple[int, int, int], ...]:
        """Return (contact number, geom of the first entity, geom of the second entity) of each present contact."""
        self._bind()
        data = self._sim.engine.physics.fresh()
        sleepers = self._sleepers(data)
        return self._at_rest(len(sleepers)) if sleepers else self.among(data)

    def force(self) -> float:
        """Return the sum of the normal forces [N]."""
        contacts = self.now()
        if not contacts:
            return 0.0
        physics = self._sim.engine.physics
        data = physics.data_of(physics.hold()) if self._sleepers(physics.fresh()) else physics.fresh()
        wrench, total = np.empty(6), 0.0
        for number, _, _ in self.among(data):
            mujoco.mj_contactForce(physics.model, data, number, wrench)
            total += float(wrench[0])
        return total

    def describe(self) -> str:
        """Return the links that touch, such as `tb3::base_link touches wall::link`; empty without contacts."""
        names = self._sim.engine.names
        pairs: dict[str, None] = {}
        for _, mine, other in self.now():
            first, second = (names.geom_owner(geom)[0] or f"geom {geom}" for geom in (mine, other))
            pairs[f"{first} touches {second}"] = None
        listed = list(pairs)
        return ", ".join(listed[:3]) + (f" and {len(listed) - 3} more" if len(listed) > 3 else "")

    def masks(self) -> tuple[list[bool], list[bool]]:
        """Return which geoms belong to the first and to the second entity; the last item is for no geom."""
        self._bind()
        return self._mine, self._others

    # ------------------------------------------------------------------ selection

    def _bind(self) -> None:
        """Find the geoms of both entities; repeat the search after a model is spawned or removed."""
        compiled = self._sim.engine.structure.compiled
        if compiled is self._compiled:
            return
        self._compiled, self._asleep_at = compiled, -1
        collisions, model = collision_table(compiled), self._sim.mj_model
        mine = collisions.mask(_collisions_below(self._first, collisions.names))
        others = ~mine if self._second is None else collisions.mask(_collisions_below(self._second, collisions.names))
        others[-1] = False
        self._concerned: Bools = mine if self._second is None else mine | others
        self._mine, self._others = mine.tolist(), others.tolist()
        bodies = model.geom_bodyid
        self._is_fixed = (model.body_weldid[bodies] == 0).tolist()
        self._is_height_map = (model.geom_type == _HEIGHT_MAP).tolist()
        trees = self._moving(mine)
        if not trees and self._second is not None:
            trees = self._moving(others)
        self._trees = trees or list(range(model.ntree))

    def _moving(self, geoms: Bools) -> list[int]:
        """Return the kinematic trees to which the given geoms belong; static geoms have none."""
        model = self._sim.mj_model
        trees = np.unique(model.body_treeid[model.geom_bodyid[np.flatnonzero(geoms)]])
        return [int(tree) for tree in trees if tree >= 0]

    def among(self, data: mujoco.MjData) -> tuple[tuple[int, int, int], ...]:
        """Return the contacts of data of the present model, as `now` does."""
        if not data.ncon:
            return ()
        contact = data.contact
        pairs = contact.geom
        mine, others, contacts, up = self._mine, self._others, [], None
        # for few contacts, Python numbers are faster than arrays
        is_few = len(pairs) <= _MANY_CONTACTS
        rows = range(len(pairs)) if is_few else np.flatnonzero(self._concerned[pairs].any(axis=1)).tolist()
        geoms = pairs.tolist() if is_few else None
        for row in rows:
            first, second = geoms[row] if geoms is not None else pairs[row].tolist()
            if mine[first] and others[second]:
                touch, sign = (row, first, second), -1.0
            elif mine[second] and others[first]:
                touch, sign = (row, second, first), 1.0
            else:
                continue
            if contact.dist[row] > 0.0:
                continue
            if self._second is None and self._is_fixed[touch[2]]:
                up = up or self._up()
                # the contact normal points from the first geom of the engine's pair to the second
                rise = sign * float_sum(n * u for n, u in zip(contact.frame[row].tolist(), up, strict=False))
                if rise >= _MAX_SLOPE or self._is_height_map[touch[2]]:
                    continue
            contacts.append(touch)
        return tuple(contacts)

    def _up(self) -> tuple[float, float, float]:
        """Return the unit vector opposite to gravity; the z axis in a world without gravity."""
        x, y, z = self._sim.mj_model.opt.gravity.tolist()
        size = math.sqrt(x * x + y * y + z * z)
        return (-x / size, -y / size, -z / size) if size else (0.0, 0.0, 1.0)

    # ------------------------------------------------------------------ sleep

    def _sleepers(self, data: mujoco.MjData) -> list[int]:
        """Return the sleeping trees of both entities; the engine lists no contacts for sleeping trees."""
        if not self._sim.engine.physics.sleep.counts:
            return []
        asleep = data.tree_asleep
        return [tree for tree in self._trees if asleep[tree] >= 0]

    def _at_rest(self, sleepers: int) -> tuple[tuple[int, int, int], ...]:
        """Return all contacts, including those of sleeping entities, which do not change until an entity wakes up."""
        sim = self._sim
        is_all = sleepers == len(self._trees)
        if not (is_all and sim.tick - 1 <= self._asleep_at <= sim.tick):
            self._asleep = self.among(sim.engine.physics.data_of(sim.engine.physics.hold()))
        self._asleep_at = sim.tick if is_all else -1
        return self._asleep


def _collisions_below(name: str, collisions: tuple[str, ...]) -> set[str]:
    """Return the collision with the given name, or all collisions of the model or link with this name."""
    return {scoped for scoped in collisions if scoped == name or scoped.startswith(name + "::")}
