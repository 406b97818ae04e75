"""Whether the numbers that the engine derives from a model are numbers."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import mujoco
import numpy as np

from simkit.diagnostics import Diagnostics, Where

_DERIVED: Final[tuple[tuple[str, Callable[[mujoco.MjModel, int], str]], ...]] = (
    ("body_mass", lambda m, i: f"body {m.body(i).name}"),
    ("body_inertia", lambda m, i: f"body {m.body(i).name}"),
    ("body_invweight0", lambda m, i: f"body {m.body(i).name}"),
    ("dof_invweight0", lambda m, i: f"joint {m.jnt(int(m.dof_jntid[i])).name}"),
    ("dof_M0", lambda m, i: f"joint {m.jnt(int(m.dof_jntid[i])).name}"),
    ("geom_rbound", lambda m, i: f"a shape of body {m.body(int(m.geom_bodyid[i])).name}"),
    ("qpos0", lambda _model, _at: "the first positions"),
)


def check_numbers(model: mujoco.MjModel, diagnostics: Diagnostics, where: Where) -> None:
    """Raises LoadError (SK-PHYS-028) where masses, inertias or distances are so far apart that sums leave the numbers.

    Each number of the file is sound by itself by now; but a mass matrix of 1e-9 kg on a lever of 1e8 m has no inverse
    in double precision, and everything that the engine computes with it would be NaN.
    """
    for name, owner in _DERIVED:
        values = np.asarray(getattr(model, name), float)
        rows = values.reshape(max(1, len(values)), -1)
        bad = np.flatnonzero(~np.isfinite(rows).all(axis=1))
        if bad.size:
            diagnostics.error(
                "SK-PHYS-028",
                f"{owner(model, int(bad[0]))}: its masses, inertias and distances are too far apart to compute with",
                where,
                "check the units: metres, kilograms and kg·m²",
            )
            diagnostics.raise_if_errors()
