"""A contact reading as gz's and as Gazebo Classic's message."""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np

from simkit import msgs
from simkit.pose import Vector
from simkit.sensors.devices.contact_reading import ContactPair, ContactReading

_COLLISION = 5  # of ros_gz_interfaces/msg/Entity


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
        *(
            msgs.type_of(name)
            for name in (
                "geometry_msgs/msg/Vector3",
                "geometry_msgs/msg/Wrench",
                "ros_gz_interfaces/msg/JointWrench",
                "ros_gz_interfaces/msg/Entity",
                "ros_gz_interfaces/msg/Contact",
                "ros_gz_interfaces/msg/Contacts",
                "gazebo_msgs/msg/ContactState",
                "gazebo_msgs/msg/ContactsState",
                "std_msgs/msg/String",
                "std_msgs/msg/UInt32",
            )
        )
    )


def contacts_message(reading: ContactReading, header: msgs.Header, is_named: bool = True) -> msgs.Contacts:
    """`ros_gz_interfaces/msg/Contacts`: world frame; wrenches about the contact's point.

    Args:
        is_named: whether the collisions' names are said, and not only their ids.
    """
    types = _types()
    message: msgs.Contacts = types.contacts(header, [_contact(types, pair, header, is_named) for pair in reading.pairs])
    return message


def _contact(types: _Types, pair: ContactPair, header: msgs.Header, is_named: bool) -> msgs.Contact:
    vector, wrench = types.vector, types.wrench
    one, other = (pair.collision1, pair.collision2) if is_named else ("", "")
    names = types.string(one), types.string(other)
    ids = types.number(pair.ids[0]), types.number(pair.ids[1])
    wrenches = []
    for (fx, fy, fz), (tx, ty, tz) in zip(pair.forces.tolist(), pair.torques.tolist(), strict=True):
        on_first = wrench(vector(fx, fy, fz), vector(tx, ty, tz))
        on_second = wrench(vector(-fx, -fy, -fz), vector(-tx, -ty, -tz))
        wrenches.append(types.joint_wrench(header, names[0], ids[0], names[1], ids[1], on_first, on_second))
    message: msgs.Contact = types.contact(
        types.entity(pair.ids[0], one, _COLLISION),
        types.entity(pair.ids[1], other, _COLLISION),
        [vector(*p) for p in pair.positions.tolist()],
        [vector(*n) for n in pair.normals.tolist()],
        pair.depths,
        wrenches,
    )
    return message


def states_message(reading: ContactReading, header: msgs.Header) -> msgs.ContactsState:
    """`gazebo_msgs/msg/ContactsState`: in the frame of the reading; torques about the link's centre of mass.

    That is where Classic's ODE gives them (the feedback of a contact joint).
    """
    types, count = _types(), len(reading.pairs)
    states = [_state(types, pair, reading, header, f"{i + 1}/{count}") for i, pair in enumerate(reading.pairs)]
    message: msgs.ContactsState = types.states(header, states)
    return message


def _state(
    types: _Types, pair: ContactPair, reading: ContactReading, header: msgs.Header, which: str
) -> msgs.ContactState:
    vector, wrench, axes = types.vector, types.wrench, reading.axes

    def vectors(rows: Vector) -> list[msgs.Vector3]:
        return [vector(*row) for row in rows.tolist()]

    forces = pair.forces @ axes
    torques = (pair.torques + np.cross(pair.positions - pair.centre, pair.forces)) @ axes
    total_force, total_torque = vectors(np.stack([forces.sum(axis=0), torques.sum(axis=0)]))
    own, other, stamp = pair.collision1, pair.collision2, header.stamp
    info = f"Debug:  i: ({which})     my geom: [{own}]  other geom: [{other}]"
    message: msgs.ContactState = types.state(
        f"{info}        time: [{stamp.sec}.{stamp.nanosec}]\n",
        own,
        other,
        [wrench(f, t) for f, t in zip(vectors(forces), vectors(torques), strict=True)],
        wrench(total_force, total_torque),
        vectors((pair.positions - reading.origin) @ axes),
        vectors(pair.normals @ axes),
        pair.depths,
    )
    return message
