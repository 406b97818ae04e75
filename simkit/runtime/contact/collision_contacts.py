"""The engine's contacts, assigned to the collisions of the loaded files."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.linear_algebra import matmul
from simkit.pose import Vector

if TYPE_CHECKING:
    from simkit.compiler import Compiled
    from simkit.compiler.name_map import NameMap

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.integer[Any]]
Bools = npt.NDArray[np.bool_]

mj_contact_force, any_of = mujoco.mj_contactForce, np.logical_or.reduce  # looked up once for speed


@dataclass(frozen=True, eq=False)
class CollisionTable:
    """Collisions of a compiled model, numbered in the order of their first geoms.

    Attributes:
        names: scoped names of the collisions by number. A geom that belongs to no collision of a file is listed under
            its own name.
        of_geom: collision number by geom id, shape (ngeom + 1,); the last item is for index -1, no geom.
    """

    names: tuple[str, ...]
    of_geom: Ints

    def mask(self, scoped: Collection[str]) -> Bools:
        """Return a mask of the geoms of these collisions, shape (ngeom + 1,); the last item is False."""
        numbers = [i for i, name in enumerate(self.names) if name in scoped]
        return np.isin(self.of_geom, numbers)

    def mask_of_model(self, model: str | None) -> Bools:
        """Return a mask of the geoms of a model by its scoped name; None for all geoms."""
        if model is None:
            return np.append(np.ones(len(self.of_geom) - 1, bool), False)
        return self.mask([name for name in self.names if name.startswith(f"{model}::")])


def collision_table(compiled: Compiled) -> CollisionTable:
    """Return the collisions of a compiled model; computed once for all callers."""
    names = compiled.names
    return names.shared("collisions", lambda: _build_collision_table(names, compiled.model))


def _build_collision_table(names: NameMap, model: mujoco.MjModel) -> CollisionTable:
    number: dict[str, int] = {}
    of_geom = np.full(model.ngeom + 1, -1, dtype=np.intp)
    for geom in range(model.ngeom):
        _, scoped, is_visual = names.geom_owner(geom)
        if not is_visual:
            name = scoped or mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_GEOM, geom) or f"geom{geom}"
            of_geom[geom] = number.setdefault(name, len(number))
    return CollisionTable(tuple(number), of_geom)


@dataclass(frozen=True, slots=True, eq=False)
class CollisionContacts:
    """Contacts of some collisions, k of them, in the engine's order.

    Attributes:
        numbers: indices among the engine's contacts, shape (k,).
        geoms: two geoms of each contact, shape (k, 2).
        positions: position half way between the two surfaces [m], world frame, shape (k, 3).
        frames: axes of each contact as rows, world frame, shape (k, 3, 3); the first points from geom 0 to geom 1.
        depths: penetration depth [m], shape (k,).
        wrenches: force [N] and torque [N·m] on geom 1 at the position, in the contact's axes, shape (k, 6).
    """

    numbers: Ints
    geoms: Ints
    positions: Floats
    frames: Floats
    depths: Floats
    wrenches: Floats


def find_contacts(model: mujoco.MjModel, data: mujoco.MjData, selected: Bools) -> CollisionContacts | None:
    """Return the contacts of selected geoms; None if there are none.

    Two surfaces have a contact if they touch or overlap, or if a force between them acts already before they touch.
    Geoms that are only within the engine's margin do not count.

    Args:
        model: MuJoCo's model.
        data: MuJoCo's data with a complete forward pass.
        selected: mask of the selected geoms, shape (ngeom + 1,).
    """
    if not data.ncon:
        return None
    contact = data.contact
    pairs = contact.geom
    # for a few contacts, Python numbers are faster than arrays
    rows = any_of(selected.take(pairs), axis=1).nonzero()[0]
    if not rows.size:
        return None
    acts = contact.efc_address[rows]
    if min(acts.tolist()) < 0:
        rows = rows[acts >= 0]
    wrenches = np.empty((rows.size, 6))
    for row, wrench in zip(rows.tolist(), wrenches, strict=True):
        mj_contact_force(model, data, row, wrench)
    depths = -contact.dist[rows]
    if min(depths.tolist(), default=0.0) < 0.0:
        real = (depths >= 0.0) | (wrenches[:, 0] != 0.0)
        rows, wrenches, depths = rows[real], wrenches[real], depths[real]
    if not rows.size:
        return None
    frames = contact.frame[rows].reshape(-1, 3, 3)
    return CollisionContacts(rows, pairs[rows], contact.pos[rows], frames, depths, wrenches)


def slip_velocities(model: mujoco.MjModel, data: mujoco.MjData, contacts: CollisionContacts) -> Floats:
    """Return the velocity of the second surface of each contact against the first one [m/s], along the contact's axes.

    Belts and tracks count with the speed of their surface.

    Returns:
        Velocities, shape (k, 3): along the normal, where a positive number is a contact that opens, and along the two
        tangents.
    """
    found = np.empty((len(contacts.numbers), 3))
    surface = data.contact.surfacevel
    for place, (number, geoms) in enumerate(zip(contacts.numbers.tolist(), contacts.geoms.tolist(), strict=True)):
        first, second = (point_velocity(model, data, geom, contacts.positions[place]) for geom in geoms)
        found[place] = matmul(contacts.frames[place], second - first)
        found[place, 1:] += surface[number, :2]
    return found


def point_velocity(model: mujoco.MjModel, data: mujoco.MjData, geom: int, point: Vector) -> Vector:
    """Return the velocity of the point of a geom's body at a position in the world [m/s], world frame, shape (3,)."""
    body, motion = int(model.geom_bodyid[geom]), np.empty(6)
    mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_XBODY, body, motion, 0)
    velocity: Vector = motion[3:] + np.cross(motion[:3], point - data.xpos[body])
    return velocity


class Contact(NamedTuple):
    """Contact point of two collisions.

    Attributes:
        first, second: scoped names of the collisions.
        position: position half way between the two surfaces [m], world frame, shape (3,).
        normal: unit vector from the first to the second collision, world frame, shape (3,).
        force: force on the second collision [N], world frame, shape (3,).
    """

    first: str
    second: str
    position: Vector
    normal: Vector
    force: Vector


def list_contacts(compiled: Compiled, data: mujoco.MjData, model: str | None) -> list[Contact]:
    """Return the contacts in the engine's order.

    Args:
        compiled: compiled model.
        data: MuJoCo's data with a complete forward pass.
        model: scoped name of a model; only contacts of its collisions are listed. None for all contacts.
    """
    table = collision_table(compiled)
    contacts = find_contacts(compiled.model, data, table.mask_of_model(model))
    if contacts is None:
        return []
    return [
        Contact(table.names[first], table.names[second], position, axes[0], matmul(wrench[:3], axes))
        for (first, second), position, axes, wrench in zip(
            table.of_geom[contacts.geoms].tolist(), contacts.positions, contacts.frames, contacts.wrenches, strict=True
        )
    ]
