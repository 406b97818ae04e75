"""Reading of a contact sensor: MuJoCo's contacts by pairs of collisions, and the messages of gz and Gazebo Classic."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

import numpy as np

from simkit import msgs
from simkit.linear_algebra import matmul
from simkit.pose import Vector
from simkit.runtime.contact.collision_contacts import CollisionContacts, CollisionTable

_ORIGIN, _AXES = np.zeros(3), np.eye(3)


@dataclass(frozen=True, slots=True, eq=False)
class ContactPair:
    """Contacts between a collision of the sensor and another collision, at k points; world frame.

    Attributes:
        collision1, collision2: scoped names, the sensor's own first.
        ids: numbers of the two collisions in the current world, from 1.
        positions: contact points [m], shape (k, 3).
        normals: unit vectors towards collision1, shape (k, 3).
        depths: penetration depths [m], shape (k,).
        forces: forces on collision1 [N], shape (k, 3).
        torques: torsional and rolling friction torques on collision1 about the point [N·m], shape (k, 3).
        centre: centre of mass of the link of collision1 [m], shape (3,).
    """

    collision1: str
    collision2: str
    ids: tuple[int, int]
    positions: Vector
    normals: Vector
    depths: Vector
    forces: Vector
    torques: Vector
    centre: Vector


@dataclass(frozen=True, slots=True, eq=False)
class ContactReading:
    """All contacts of the sensor's collisions.

    Attributes:
        pairs: contacts in the order of the sensor's collisions in the file, then of the other collisions in the world.
        origin, axes: position [m] and rotation matrix of the frame of `ContactsState`.
        frame_id: name of that frame.
    """

    pairs: tuple[ContactPair, ...]
    origin: Vector
    axes: Vector
    frame_id: str


@dataclass(frozen=True, slots=True, eq=False)
class RawContacts:
    """Values captured from the engine at a sample.

    Attributes:
        touches: contacts; None if there are none.
        collisions: collisions of the model at that time.
        order: positions of the sensor's collisions in the file, by collision number.
        centres: centres of mass of the links, by collision number; present if states are published.
        frame_id, origin, axes: frame of the states; None for the world's.
    """

    touches: CollisionContacts | None
    collisions: CollisionTable
    order: Mapping[int, int]
    centres: Mapping[int, Vector] | None = None
    frame_id: str = "world"
    origin: Vector | None = None
    axes: Vector | None = None

    def reading(self) -> ContactReading:
        """Return the reading made from these values."""
        pairs = () if self.touches is None else _group_by_pair(self, self.touches)
        origin = _ORIGIN if self.origin is None else self.origin
        return ContactReading(pairs, origin, _AXES if self.axes is None else self.axes, self.frame_id)


def _group_by_pair(raw: RawContacts, contacts: CollisionContacts) -> tuple[ContactPair, ...]:
    """Group the contacts by pairs of collisions; a contact between two of the sensor's collisions counts for each."""
    order, names = raw.order, raw.collisions.names
    sides: list[tuple[int, int, int, int, float]] = []
    for row, (first, second) in enumerate(raw.collisions.of_geom.take(contacts.geoms).tolist()):
        # the engine's frame and wrench belong to its second geom
        if second in order:
            sides.append((order[second], first, second, row, 1.0))
        if first in order:
            sides.append((order[first], second, first, row, -1.0))
    sides.sort()
    rows, sign = [s[3] for s in sides], np.array([s[4] for s in sides])[:, None]
    positions, depths, frames = contacts.positions[rows], contacts.depths[rows], contacts.frames[rows]
    normals = frames[:, 0] * sign
    # the rows of each frame are its axes, so this product rotates into the world
    wrenches = matmul((contacts.wrenches[rows] * sign).reshape(-1, 2, 3), frames)
    pairs, start = [], 0
    while start < len(sides):
        _, other, sensed, *_ = sides[start]
        end = next((i for i in range(start, len(sides)) if sides[i][1:3] != (other, sensed)), len(sides))
        k = slice(start, end)
        pairs.append(
            ContactPair(
                collision1=names[sensed],
                collision2=names[other] if other >= 0 else "",
                ids=(sensed + 1, other + 1),
                positions=positions[k],
                normals=normals[k],
                depths=depths[k],
                forces=wrenches[k, 0],
                torques=wrenches[k, 1],
                centre=_ORIGIN if raw.centres is None else raw.centres[sensed],
            )
        )
        start = end
    return tuple(pairs)


_COLLISION = 5  # value for collisions in ros_gz_interfaces/msg/Entity


class _Types(NamedTuple):
    vector: type[msgs.Vector3]
    wrench: type[msgs.Wrench]
    joint_wrench: type[msgs.JointWrench]
    entity: type[msgs.Entity]
    contact: type[msgs.Contact]
    contacts: type[msgs.Contacts]
    state: type[msgs.ContactState]
    states: type[msgs.ContactsState]
    string: type[msgs.String]
    number: type[msgs.UInt32]


@cache
def _types() -> _Types:
    return _Types(
        msgs.Vector3, msgs.Wrench, msgs.JointWrench, msgs.Entity, msgs.Contact, msgs.Contacts, msgs.ContactState,
        msgs.ContactsState, msgs.String, msgs.UInt32,
    )  # fmt: skip


def contacts_message(reading: ContactReading, header: msgs.Header, is_named: bool = True) -> msgs.Contacts:
    """Make a `ros_gz_interfaces/msg/Contacts`, in the world frame, with wrenches about the contact points.

    Args:
        reading: contacts of the sensor.
        header: header of the message.
        is_named: True includes the names of the collisions, False only their ids.
    """
    types = _types()
    return types.contacts(header, [_contact(types, pair, header, is_named) for pair in reading.pairs])


def _contact(types: _Types, pair: ContactPair, header: msgs.Header, is_named: bool) -> msgs.Contact:
    vector, wrench = types.vector, types.wrench
    name1, name2 = (pair.collision1, pair.collision2) if is_named else ("", "")
    names = types.string(name1), types.string(name2)
    ids = types.number(pair.ids[0]), types.number(pair.ids[1])
    wrenches = []
    for (fx, fy, fz), (tx, ty, tz) in zip(pair.forces.tolist(), pair.torques.tolist(), strict=True):
        on_first = wrench(vector(fx, fy, fz), vector(tx, ty, tz))
        on_second = wrench(vector(-fx, -fy, -fz), vector(-tx, -ty, -tz))
        wrenches.append(types.joint_wrench(header, names[0], ids[0], names[1], ids[1], on_first, on_second))
    return types.contact(
        types.entity(pair.ids[0], name1, _COLLISION),
        types.entity(pair.ids[1], name2, _COLLISION),
        [vector(*p) for p in pair.positions.tolist()],
        [vector(*n) for n in pair.normals.tolist()],
        pair.depths,
        wrenches,
    )


def states_message(reading: ContactReading, header: msgs.Header) -> msgs.ContactsState:
    """Make a `gazebo_msgs/msg/ContactsState` in the reading's frame, with torques about the link's centre of mass.

    Gazebo Classic's ODE uses the same reference point (the feedback of a contact joint).
    """
    types, count = _types(), len(reading.pairs)
    states = [_state(types, pair, reading, header, f"{i + 1}/{count}") for i, pair in enumerate(reading.pairs)]
    return types.states(header, states)


def _state(
    types: _Types, pair: ContactPair, reading: ContactReading, header: msgs.Header, which: str
) -> msgs.ContactState:
    vector, wrench, axes = types.vector, types.wrench, reading.axes

    def vectors(rows: Vector) -> list[msgs.Vector3]:
        return [vector(*row) for row in rows.tolist()]

    forces = matmul(pair.forces, axes)
    torques = matmul(pair.torques + np.cross(pair.positions - pair.centre, pair.forces), axes)
    total_force, total_torque = vectors(np.stack([forces.sum(axis=0), torques.sum(axis=0)]))
    sensed, other, stamp = pair.collision1, pair.collision2, header.stamp
    info = f"Debug:  i: ({which})     my geom: [{sensed}]  other geom: [{other}]"
    return types.state(
        f"{info}        time: [{stamp.sec}.{stamp.nanosec}]\n",
        sensed,
        other,
        [wrench(f, t) for f, t in zip(vectors(forces), vectors(torques), strict=True)],
        wrench(total_force, total_torque),
        vectors(matmul(pair.positions - reading.origin, axes)),
        vectors(matmul(pair.normals, axes)),
        pair.depths,
    )
