"""Contacts with friction of selected geoms: their indices and frames, as plain numbers or as arrays."""

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
    """Few contacts with friction, k of them, as plain numbers, because arrays of three are slow.

    `FrictionContactArrays` holds many.

    Attributes:
        numbers: indices among the engine's contacts.
        geoms: two geoms of each contact; -1 for none.
        frames: normal (from the first geom to the second) and two tangents of each contact, 9 numbers.
    """

    numbers: list[int]
    geoms: list[list[int]]
    frames: list[Numbers]


class FrictionContactArrays(NamedTuple):
    """Many contacts with friction, as arrays; see `FrictionContacts`."""

    numbers: Ints
    geoms: Ints
    frames: Floats


AnyFrictionContacts = FrictionContacts | FrictionContactArrays


def find_friction_contacts(data: mujoco.MjData, concerns: Sequence[bool]) -> AnyFrictionContacts | None:
    """Return the contacts with friction of selected geoms; None if there are none.

    Args:
        data: MuJoCo's data with positions.
        concerns: True for each selected geom; the last item is for index -1.
    """
    contact = data.contact
    if data.ncon > ARRAY_THRESHOLD:
        one_side, other_side = np.array(concerns)[contact.geom].T
        rubs = (contact.efc_address >= 0) & (contact.dim > 1) & (one_side | other_side)
        many: Ints = rubs.nonzero()[0]
        if many.size > ARRAY_THRESHOLD:
            which: slice | Ints = slice(None) if many.size == data.ncon else many  # a slice is faster
            return FrictionContactArrays(many, contact.geom[which], contact.frame[which].copy())
        numbers = many.tolist()
        return FrictionContacts(numbers, contact.geom[rubs].tolist(), contact.frame[rubs].tolist()) if numbers else None
    pairs = contact.geom.tolist()
    numbers = [number for number, (first, other) in enumerate(pairs) if concerns[first] or concerns[other]]
    if not numbers:
        return None
    rows, dims = contact.efc_address.tolist(), contact.dim.tolist()
    numbers = [number for number in numbers if rows[number] >= 0 and dims[number] > 1]
    if not numbers:
        return None
    if len(numbers) == len(pairs):
        return FrictionContacts(numbers, pairs, contact.frame.tolist())
    return FrictionContacts(numbers, [pairs[number] for number in numbers], contact.frame[numbers].tolist())
