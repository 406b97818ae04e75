"""Which links of a model touch each other."""

from __future__ import annotations

from itertools import combinations
from typing import Final

import mujoco

from simkit.compiler.name_map import ModelRecord
from simkit.scene import SceneJoint, SceneLink, SceneModel

FIRST_OWN_BIT: Final = 16
"""Files' masks have 16 bits; those above tell models apart."""

PAIRS_MOST: Final = 2000
"""From so many pairs on, the links of a model know each other by a bit instead of by a list of pairs."""

_ALL_BITS: Final = 0xFFFF
_ALL_OWN: Final = 0x7FFF0000


def exclude_self_collisions(
    spec: mujoco.MjSpec, record: ModelRecord, moving: list[SceneLink], joints: list[SceneJoint]
) -> None:
    """Links of one model touch only where one of them collides with its own model, and never across a joint.

    A nested model that no joint ties to the rest is a stranger to it, as in Gazebo: their links touch.

    Either by excludes, a pair of bodies each; or, for a model of very many links that never touch each other and have
    the format's plain masks, by a bit of its own: what has it meets everything but what has it too.
    """
    model = record.scene
    joined = {frozenset((j.parent_link, j.child_link)) for j in joints}
    owns = {link.scoped: m.self_collide for m in model.all_models() for link in m.links}
    solid = [link for link in moving if link.collisions]
    touchy = model.self_collide or any(k.self_collide or owns[k.scoped] for k in solid)
    whole = _jointed_groups(model, joints)
    is_one = len({whole[link.scoped] for link in solid}) < 2
    many = is_one and len(solid) * (len(solid) - 1) // 2 > PAIRS_MOST
    if not touchy and many and record.own_bit and _is_plain(solid):
        _mark_geom(spec, record, {link.scoped for link in solid})
        return
    record.own_bit = 0
    for a, b in combinations(solid, 2):
        if whole[a.scoped] != whole[b.scoped]:
            continue
        collide = model.self_collide or any(k.self_collide or owns[k.scoped] for k in (a, b))
        if not collide or frozenset((a.scoped, b.scoped)) in joined:
            name = f"{a.scoped}|{b.scoped}"
            spec.add_exclude(name=name, bodyname1=a.scoped, bodyname2=b.scoped)
            record.excludes.append(name)


def _jointed_groups(model: SceneModel, joints: list[SceneJoint]) -> dict[str, str]:
    """Of each link a name of the whole that it belongs to: links of one model, and models that joints tie together."""
    of_link = {link.scoped: m.scoped for m in model.all_models() for link in m.links}
    above: dict[str, str] = {}

    def top(name: str) -> str:
        while name in above:
            name = above[name]
        return name

    for joint in joints:
        if joint.parent_link in of_link and joint.child_link in of_link:
            one, other = top(of_link[joint.parent_link]), top(of_link[joint.child_link])
            if one != other:
                above[other] = one
    return {link: top(owner) for link, owner in of_link.items()}


def _is_plain(links: list[SceneLink]) -> bool:
    surfaces = [c.surface for link in links for c in link.collisions]
    return all(s.collide_bitmask == s.category_bitmask == _ALL_BITS for s in surfaces)


def _mark_geom(spec: mujoco.MjSpec, record: ModelRecord, links: set[str]) -> None:
    for name, owner in record.geoms.items():
        if owner.is_visual or owner.link not in links:
            continue
        geom = spec.geom(name)
        if geom.contype or geom.conaffinity:
            geom.contype, geom.conaffinity = record.own_bit, _ALL_BITS | (_ALL_OWN & ~record.own_bit)
