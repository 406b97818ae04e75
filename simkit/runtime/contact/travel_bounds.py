"""Bounds on the motion of collision geoms per unit of joint velocity, and on the allowed travel of each geom.

All bounds are computed once from the compiled model. Indices of geoms and degrees of freedom are those of MuJoCo.
"""

from __future__ import annotations

from typing import Final

import mujoco
import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.intp]

_PLANE, _HFIELD, _SPHERE = (int(getattr(mujoco.mjtGeom, f"mjGEOM_{n}")) for n in ("PLANE", "HFIELD", "SPHERE"))
_ROUND = [int(getattr(mujoco.mjtGeom, f"mjGEOM_{n}")) for n in ("CAPSULE", "CYLINDER")]
_ELLIPSOID = int(mujoco.mjtGeom.mjGEOM_ELLIPSOID)
_FREE, _BALL, _SLIDE, _HINGE = (int(getattr(mujoco.mjtJoint, f"mjJNT_{n}")) for n in ("FREE", "BALL", "SLIDE", "HINGE"))
_UNLIMITED_SPAN: Final = 1e3
"""Assumed travel [m] of a slide joint without limits, for the levers of the joints above it."""

_MAX_COMPARED_BODIES: Final = 64
"""Largest number of bodies of a kinematic tree for which all pairs are compared."""


def half_thickness(model: mujoco.MjModel) -> Floats:
    """Return half the least extent [m] of each geom; infinite for a plane, half the base for a height field.

    The last of ngeom + 1 items is infinite, for contacts without a geom (index -1).
    """
    half = np.append(model.geom_aabb[:, 3:6].min(axis=1), np.inf)
    half[:-1][model.geom_type == _PLANE] = np.inf
    for geom in np.flatnonzero(model.geom_type == _HFIELD):
        half[geom] = model.hfield_size[model.geom_dataid[geom], 3] / 2
    return half


def rotational_symmetries(model: mujoco.MjModel) -> tuple[npt.NDArray[np.bool_], npt.NDArray[np.bool_]]:
    """Return two masks of geoms: unchanged by all rotations about their centre, unchanged by all about their z axis."""
    size, kind = model.geom_size, model.geom_type
    is_round = np.isin(kind, _ROUND) | ((kind == _ELLIPSOID) & (size[:, 0] == size[:, 1]))
    return kind == _SPHERE, is_round


def can_collide(model: mujoco.MjModel) -> npt.NDArray[np.bool_]:
    """Return a mask of the geoms that may touch anything at all."""
    has_mask: npt.NDArray[np.bool_] = (model.geom_contype | model.geom_conaffinity) != 0
    return has_mask


def can_touch(model: mujoco.MjModel, these: Ints, others: Ints) -> npt.NDArray[np.bool_]:
    """Check whether geoms may touch by their masks alone; the arguments are indices that broadcast."""
    types, affinities = model.geom_contype, model.geom_conaffinity
    is_allowed: npt.NDArray[np.bool_] = ((types[these] & affinities[others]) | (types[others] & affinities[these])) != 0
    return is_allowed


def allowed_travel(model: mujoco.MjModel, half: Floats, geoms: Ints) -> Floats:
    """Return the travel [m] up to which moving geoms cannot pass through another geom.

    Two geoms can pass through each other if their common travel exceeds half the thickness of both. Therefore a geom
    that meets moving geoms may travel half its own thickness. A geom that meets only static geoms may travel further,
    by half the thickness of the thinnest static geom.
    """
    solid = np.flatnonzero(can_collide(model))
    tree = model.body_treeid[model.geom_bodyid]
    masks = np.column_stack([model.geom_contype[solid], model.geom_conaffinity[solid]])
    kinds: dict[tuple[int, int], Ints] = {}  # masks -> geoms
    for first, second in dict.fromkeys(map(tuple, masks.tolist())):
        kinds[first, second] = solid[(masks[:, 0] == first) & (masks[:, 1] == second)]
    static_least = {key: _minimum(half[solids[tree[solids] < 0]]) for key, solids in kinds.items()}
    trees = {key: set(tree[solids].tolist()) - {-1} for key, solids in kinds.items()}
    touchy: dict[int, bool] = {}
    allowed = np.empty(len(geoms))
    by_kind: dict[tuple[int, int, int], float] = {}
    for place, geom in enumerate(geoms.tolist()):
        mine = int(model.geom_contype[geom]), int(model.geom_conaffinity[geom])
        geom_tree = int(tree[geom])
        if (*mine, geom_tree) not in by_kind:
            met = [key for key in kinds if (mine[0] & key[1]) | (key[0] & mine[1])]
            least = min((static_least[key] for key in met), default=np.inf)
            if any(len(trees[key]) > 1 or (trees[key] and geom_tree not in trees[key]) for key in met):
                least = 0.0
            elif any(geom_tree in trees[key] for key in met):
                if geom_tree not in touchy:
                    touchy[geom_tree] = _can_touch_itself(model, geom_tree)
                least = 0.0 if touchy[geom_tree] else least
            by_kind[(*mine, geom_tree)] = least
        allowed[place] = half[geom] + by_kind[(*mine, geom_tree)]
    return allowed


def _minimum(values: Floats) -> float:
    return float(values.min()) if len(values) else np.inf


def _can_touch_itself(model: mujoco.MjModel, tree: int) -> bool:
    """Check whether two bodies of a kinematic tree may touch each other."""
    solid = model.geom_bodyid[can_collide(model)]
    bodies = sorted(set(solid[model.body_treeid[solid] == tree].tolist()))
    if len(bodies) > _MAX_COMPARED_BODIES:
        return True
    pairs = BodyPairs(model)
    return any(not pairs.is_filtered(a, b) for n, a in enumerate(bodies) for b in bodies[:n])


class BodyPairs:
    """Pairs of bodies whose contacts the engine ignores, whatever their masks."""

    def __init__(self, model: mujoco.MjModel) -> None:
        weld = model.body_weldid
        self._weld: list[int] = weld.tolist()
        self._above: list[int] = weld[model.body_parentid[weld]].tolist()
        self._has_parents = not model.opt.disableflags & int(mujoco.mjtDisableBit.mjDSBL_FILTERPARENT)
        self._excluded = set(model.exclude_signature.tolist())

    def is_filtered(self, first: int, other: int) -> bool:
        """Check whether the engine ignores contacts between two bodies."""
        a, b = self._weld[first], self._weld[other]
        if a == b:
            return True
        if self._has_parents and a and b and (a == self._above[b] or b == self._above[a]):
            return True
        return not self._excluded.isdisjoint(((first << 16) + other, (other << 16) + first))


def velocity_levers(model: mujoco.MjModel, geoms: Ints) -> tuple[Ints, Ints, Floats]:
    """Return rows of (index in `geoms`, degree of freedom, lever): the lever is the largest speed per joint velocity.

    Surface points of the geom have at most the speed lever · |velocity|, in all configurations. The lever is 1 for a
    translation and a length [m] for a rotation.
    """
    rows: list[Ints] = []
    dofs: list[Ints] = []
    levers: list[Floats] = []
    is_ball, is_round = rotational_symmetries(model)
    places, body = np.arange(len(geoms)), model.geom_bodyid[geoms].astype(np.intp)
    offset = model.geom_pos[geoms]
    reach = np.linalg.norm(offset, axis=1)
    radius = np.where(is_ball[geoms], 0.0, model.geom_rbound[geoms])
    axis_of = np.array([_z_axis(q) for q in model.geom_quat[geoms]]).reshape(-1, 3)
    is_own = True
    while len(places):
        extra = np.linalg.norm(model.body_pos[body], axis=1)
        for k in range(int(model.body_jntnum[body].max(initial=0))):
            some = np.flatnonzero(model.body_jntnum[body] > k)
            joint = model.body_jntadr[body[some]] + k
            kind, at = model.jnt_type[joint], model.jnt_pos[joint]
            where = places[some]
            anchor = np.linalg.norm(at, axis=1)
            lever = reach[some] + anchor + radius[where]
            exact = (kind == _HINGE) & is_own & (model.body_jntnum[body[some]] == 1)
            arm, axis = offset[where] - at, model.jnt_axis[joint]
            across = np.linalg.norm(np.cross(arm, axis), axis=1)
            spin = np.where(is_round[geoms[where]], np.linalg.norm(np.cross(axis_of[where], axis), axis=1), 1.0)
            lever = np.where(exact, across + radius[where] * spin, lever)
            first = model.jnt_dofadr[joint]
            for chosen, count, shift, value in (
                (kind == _HINGE, 1, 0, lever),
                (kind == _SLIDE, 1, 0, np.ones(len(some))),
                (kind == _BALL, 3, 0, lever),
                (kind == _FREE, 3, 0, np.ones(len(some))),
                (kind == _FREE, 3, 3, reach[some] + radius[where]),
            ):
                for i in range(count):
                    rows.append(where[chosen])
                    dofs.append(first[chosen] + shift + i)
                    levers.append(value[chosen])
            slack = np.where((kind == _HINGE) | (kind == _BALL), 2.0 * anchor, 0.0)
            span = np.where(model.jnt_limited[joint] != 0, np.abs(model.jnt_range[joint]).max(axis=1), _UNLIMITED_SPAN)
            extra[some] += np.where(kind == _SLIDE, span, slack)
        reach = reach + extra
        body = model.body_parentid[body].astype(np.intp)
        is_own = False
        goes_on = model.body_treeid[body] >= 0
        places, body, reach = places[goes_on], body[goes_on], reach[goes_on]
    if not rows:
        return np.zeros(0, np.intp), np.zeros(0, np.intp), np.zeros(0)
    return np.concatenate(rows).astype(np.intp), np.concatenate(dofs).astype(np.intp), np.concatenate(levers)


def _z_axis(q: Floats) -> tuple[float, float, float]:
    w, x, y, z = (float(v) for v in q)
    return 2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)
