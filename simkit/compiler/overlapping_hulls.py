"""Exclusion of contacts between links of one model whose convex hulls overlap at the start.

The engine replaces a mesh by its convex hull or by the hulls of its pieces. The hulls of two neighbouring links of a
hand may overlap by centimetres where the meshes of the file do not touch. Contacts would then push the links apart for
as long as the simulation runs: a hand with 30 links that collide with each other turned itself by 2.8 rad in 7 s.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

import mujoco

from simkit.compiler.name_map import ModelRecord, NameMap
from simkit.compiler.start_positions import place_joints
from simkit.diagnostics import Diagnostics
from simkit.number_text import counted

_LEAST_DEPTH: Final = 1e-3
"""Overlap [m] from which two links do not collide; links that touch at the start overlap by less."""

_NAMED_MOST: Final = 3


def exclude_overlapping_hulls(
    spec: mujoco.MjSpec, model: mujoco.MjModel, records: Iterable[ModelRecord], diagnostics: Diagnostics
) -> bool:
    """Exclude the contacts of all links of one model that overlap at the start, if one of them is a mesh.

    Args:
        spec: specification that receives the exclusions.
        model: the specification, compiled.
        records: elements of the models; only new models with self-collision are considered.
        diagnostics: receives one warning for each model.

    Returns:
        True if the specification was changed, so that it has to be compiled again.
    """
    suspects = [record for record in records if record.has_unchecked_hulls]
    if not suspects:
        return False
    data = mujoco.MjData(model)
    names = NameMap.of(suspects, model)
    place_joints(model, data, names.joints.values())
    mujoco.mj_kinematics(model, data)
    mujoco.mj_collision(model, data)
    owners = {link: record for record in suspects for link in record.links}
    found: dict[str, dict[tuple[str, str], float]] = {}
    for i in (data.contact.dist < -_LEAST_DEPTH).nonzero()[0] if data.ncon else ():
        geoms = data.contact.geom[i]
        first, second = (names.geom_owner(geom)[0] for geom in geoms)
        record = owners.get(first)
        is_mesh = (model.geom_type[geoms] == int(mujoco.mjtGeom.mjGEOM_MESH)).any()
        if record is not None and record is owners.get(second) and is_mesh:
            of_model, pair = found.setdefault(record.scene.scoped, {}), (min(first, second), max(first, second))
            of_model[pair] = max(of_model.get(pair, 0.0), -float(data.contact.dist[i]))
    for record in suspects:
        record.has_unchecked_hulls = False
        if pairs := found.get(record.scene.scoped):
            for a, b in sorted(pairs):
                name = f"{a}|{b}"
                spec.add_exclude(name=name, bodyname1=a, bodyname2=b)
                record.excludes.append(name)
            _report(record, pairs, diagnostics)
    return bool(found)


def _report(record: ModelRecord, pairs: dict[tuple[str, str], float], diagnostics: Diagnostics) -> None:
    deepest = sorted(pairs, key=lambda pair: (-pairs[pair], pair))
    texts = [" and ".join(link.rpartition("::")[2] for link in pair) for pair in deepest[:_NAMED_MOST]]
    more = f" and {counted(len(deepest) - _NAMED_MOST, 'more pair')}" if len(deepest) > _NAMED_MOST else ""
    message = (
        f"model {record.scene.scoped}: the links {'; '.join(texts)}{more} do not collide with each other: the convex "
        f"hulls of their meshes overlap at the start, by up to {1e3 * max(pairs.values()):.0f} mm"
    )
    where = record.links[deepest[0][0]].scene.where
    hint = 'give their collisions simple shapes, or <mesh optimization="convex_decomposition">'
    diagnostics.warning("SK-PHYS-034", message, where, hint)
