"""Contacts with friction that certain geoms take part in: numbers and frames, as plain numbers or as arrays."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from simkit.runtime.contact.contact_conditions import ARRAY_THRESHOLD

if TYPE_CHECKING:
    import mujoco

Numbers = list[float]
Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.integer[Any]]


class FrictionContacts(NamedTuple):
    """Contacts that rub, k of them; plain numbers where there are few, as arrays of three are slow.

    `FrictionContactArrays` holds many.

    Attributes:
        numbers: among the contacts.
        geoms: the two geoms of each; -1 for none.
        frames: normal (from the first geom to the second) and two tangents of each, 9 numbers.
    """

    numbers: list[int]
    geoms: list[list[int]]
    frames: list[Numbers]


class FrictionContactArrays(NamedTuple):
    """The same of many contacts, on arrays."""

    numbers: Ints
    geoms: Ints
    frames: Floats


AnyFrictionContacts = FrictionContacts | FrictionContactArrays


def find_friction_contacts(data: mujoco.MjData, concerns: Sequence[bool]) -> AnyFrictionContacts | None:
    """The contacts that rub among those that are about certain geoms; None where there is none.

    Args:
        data: of the engine, with positions.
        concerns: for each geom whether it is about it; the last is for -1.
    """
    contact = data.contact
    if data.ncon > ARRAY_THRESHOLD:
        one_side, other_side = np.array(concerns)[contact.geom].T
        rubs = (contact.efc_address >= 0) & (contact.dim > 1) & (one_side | other_side)
        many: Ints = rubs.nonzero()[0]
        if many.size > ARRAY_THRESHOLD:
            which: slice | Ints = slice(None) if many.size == data.ncon else many  # a slice is quicker
            return FrictionContactArrays(many, contact.geom[which], contact.frame[which].copy())
        numbers = many.tolist()
        return FrictionContacts(numbers, contact.geom[rubs].tolist(), contact.frame[rubs].tolist()) if numbers else None
    pairs = contact.geom.tolist()
    numbers = [number for number, (one, other) in enumerate(pairs) if concerns[one] or concerns[other]]
    if not numbers:
        return None
    rows, dims = contact.efc_address.tolist(), contact.dim.tolist()
    numbers = [number for number in numbers if rows[number] >= 0 and dims[number] > 1]
    if not numbers:
        return None
    if len(numbers) == len(pairs):
        return FrictionContacts(numbers, pairs, contact.frame.tolist())
    return FrictionContacts(numbers, [pairs[number] for number in numbers], contact.frame[numbers].tolist())
