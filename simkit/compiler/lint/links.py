"""Checks of masses and inertias of links against the size of their collisions and visuals."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.compiler.first_state import first_state
from simkit.compiler.name_map import LinkBinding
from simkit.compiler.refused_inertias import LEAST_MASS
from simkit.compiler.spec_builder import Compiled
from simkit.diagnostics import Diagnostics
from simkit.float_sum import float_sum
from simkit.linear_algebra import matmul
from simkit.matrix_decompositions import eigvalsh
from simkit.scene import SceneModel, SceneWorld

Floats = npt.NDArray[np.float64]

LARGEST_GYRATION_RATIO: Final = 2.0
"""Largest ratio of a link's radius of gyration to the distance from its centre of mass to its farthest corner."""

LARGEST_DENSITY: Final = 25_000.0
"""Largest density of the box around a link's collisions [kg/m³]; osmium has 22 600."""

SMALLEST_DENSITY: Final = 0.1
"""Smallest density of the box around a link's collisions [kg/m³]; air has 1.2, and cubes of 1 m and 1 kg are common."""

LARGEST_COLLISION_RATIO: Final = 5.0
"""Largest ratio of the longest edge of the box around a link's collisions to that around its visuals."""

LEAST_VOLUME: Final = 1e-9
LEAST_EXTENT: Final = 1e-9
"""Least distance [m] that a ratio is computed with; a ratio to a smaller one would show rounding errors only.

`LEAST_VOLUME` [m³] is the corresponding limit for densities.
"""


def check_links(world: SceneWorld, compiled: Compiled, diagnostics: Diagnostics) -> None:
    """Report masses and inertias that do not fit the size of their links."""
    for model in world.models:
        _check_default_masses(model, diagnostics)
    groups: dict[int, list[LinkBinding]] = {}
    for link in compiled.names.links.values():
        if not link.static and int(compiled.model.body_weldid[link.body]) != 0:
            groups.setdefault(int(compiled.model.body_weldid[link.body]), []).append(link)
    state = first_state(compiled.model)
    for links in groups.values():
        if all(link.scene.inertial.given for link in links):
            _check_inertia(compiled.model, state, links, diagnostics)
    for link in compiled.names.links.values():
        _check_collision_size(compiled.model, state, link, diagnostics)


def _check_default_masses(top: SceneModel, diagnostics: Diagnostics) -> None:
    """Report masses that are missing in the file: SDF gives 1 kg to a link without `<inertial>`."""
    links = [] if top.static else [link for m in top.all_models() if not m.static for link in m.links]
    default = [link for link in links if not link.inertial.given and link.inertial.mass > 0]
    if not default or len(default) == len(links):
        return
    kilograms = float_sum(link.inertial.mass for link in default)
    total = float_sum(link.inertial.mass for link in links)
    names = ", ".join(link.name for link in default[:6]) + (f" and {len(default) - 6} more" if len(default) > 6 else "")
    message = f"model {top.name!r}: {kilograms:g} kg of its {total:.4g} kg come from links without <inertial> ({names})"
    diagnostics.warning("SK-LINT-007", message, default[0].where, "give them an <inertial>, or make them a <frame>")


def _check_inertia(
    model: mujoco.MjModel, state: mujoco.MjData, links: list[LinkBinding], diagnostics: Diagnostics
) -> None:
    """Compare mass and inertia of a rigid group of links with its bounding box."""
    foot = min(links, key=lambda link: link.body)
    mass, centre, tensor = _total_inertia(model, state, [link.body for link in links])
    corners = _corners(model, state, (g for link in links for g in (*link.geoms, *link.visuals)))
    if corners is None or mass <= LEAST_MASS:  # a missing mass is reported as such
        return
    farthest = max(float(np.linalg.norm(corners - centre, axis=1).max()), LEAST_EXTENT)
    gyration = float(np.sqrt(max(eigvalsh(tensor)[2], 0.0) / mass))
    if gyration > LARGEST_GYRATION_RATIO * farthest:
        diagnostics.warning(
            "SK-LINT-008",
            f"link {foot.scoped!r}: the inertia is {(gyration / farthest) ** 2:.0f} times too large; "
            f"it is that of {mass:.4g} kg at a radius of {gyration:.3g} m, but the link reaches only {farthest:.3g} m "
            "from its centre of mass",
            foot.scene.where,
            "check the units: a part in mm and g gives an inertia in g·mm², 1e-9 kg·m²",
        )
    solid = _corners(model, state, (g for link in links for g in link.geoms))
    if solid is None:
        return
    volume = float(np.prod(np.ptp(solid, axis=0)))
    if volume > LEAST_VOLUME and not SMALLEST_DENSITY < mass / volume < LARGEST_DENSITY:
        diagnostics.warning(
            "SK-LINT-009",
            f"link {foot.scoped!r}: {mass:.4g} kg in a box of {_box_in_words(solid)} m are {mass / volume:.4g} kg/m3; "
            f"{'no material is so dense' if mass / volume >= LARGEST_DENSITY else 'that is lighter than air'}",
            foot.scene.where,
            "check the units of the mass and of the collision's size",
        )


def _check_collision_size(
    model: mujoco.MjModel, state: mujoco.MjData, link: LinkBinding, diagnostics: Diagnostics
) -> None:
    """Report a collision that is much larger than the visuals."""
    solid, drawn = (_corners(model, state, ids) for ids in (link.geoms, link.visuals))
    if solid is None or drawn is None or any(_is_unbounded(model, g) for g in (*link.geoms, *link.visuals)):
        return
    a, b = float(np.ptp(solid, axis=0).max()), float(np.ptp(drawn, axis=0).max())
    if a > LARGEST_COLLISION_RATIO * b:
        message = (
            f"link {link.scoped!r}: its collisions fill {_box_in_words(solid)} m, "
            f"its visuals only {_box_in_words(drawn)} m"
        )
        diagnostics.warning("SK-LINT-010", message, link.scene.where, "check the scale of the collision's mesh")


def _total_inertia(model: mujoco.MjModel, data: mujoco.MjData, bodies: Iterable[int]) -> tuple[float, Floats, Floats]:
    """Return the mass, the centre of mass and the inertia tensor of some bodies.

    The tensor is about the centre of mass, in world axes.
    """
    ids = list(bodies)
    masses = np.array([model.body_mass[b] for b in ids])
    if masses.sum() <= 0:
        return 0.0, np.zeros(3), np.zeros((3, 3))
    centre = matmul(masses, data.xipos[ids]) / masses.sum()
    total = np.zeros((3, 3))
    for b in ids:
        turn = data.ximat[b].reshape(3, 3)
        d = data.xipos[b] - centre
        total += matmul(turn * model.body_inertia[b], turn.T) + model.body_mass[b] * (
            matmul(d, d) * np.eye(3) - np.outer(d, d)
        )
    return float(masses.sum()), centre, total


def _corners(model: mujoco.MjModel, data: mujoco.MjData, geoms: Iterable[int]) -> Floats | None:
    """Return the corners of the bounding boxes of geoms in the first state; None if all geoms are unbounded.

    Returns:
        Corners in the world frame, shape (8 n, 3).
    """
    signs = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
    corners = []
    for g in geoms:
        if _is_unbounded(model, g):
            continue
        box = model.geom_aabb[g]
        corners.append(data.geom_xpos[g] + matmul(box[:3] + signs * box[3:], data.geom_xmat[g].reshape(3, 3).T))
    return np.concatenate(corners) if corners else None


def _is_unbounded(model: mujoco.MjModel, geom: int) -> bool:
    return int(model.geom_type[geom]) in (int(mujoco.mjtGeom.mjGEOM_PLANE), int(mujoco.mjtGeom.mjGEOM_HFIELD))


def _box_in_words(corners: Floats) -> str:
    return " × ".join(f"{v:.3g}" for v in np.ptp(corners, axis=0))
