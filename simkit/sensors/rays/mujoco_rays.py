"""RayBundle by MuJoCo's own casting: through everything, or through planes and shapes alone."""

from __future__ import annotations

import copy
from collections.abc import Sequence

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.pose import Pose, Vector
from simkit.sensors.rays.geom_types import Ids
from simkit.sensors.rays.ray_culling import ENDLESS, NearbyGeoms, RayBundle, RayHits, can_meet, reaches_plane
from simkit.sensors.temporary_values import temporary_values

_SEEN, _UNSEEN = 0, 1  # geom groups of the copy
_INFINITE = np.array(np.inf)
_MJCF_HEADER = (
    '<mujoco><compiler angle="radian"/><option><flag contact="disable"/></option>'
    '<default><geom mass="0" contype="1" conaffinity="1"/></default><worldbody>'
)
_GEOM_TYPE_NAMES = {0: "plane", 2: "sphere", 3: "capsule", 4: "ellipsoid", 5: "cylinder", 6: "box"}
_SOLID, _FLAT = 0, 1  # geom groups of the reduced models
_SOLIDS = np.array((1, 0, 0, 0, 0, 0), dtype=np.uint8)
_SOLIDS_AND_PLANES = np.array((1, 1, 0, 0, 0, 0), dtype=np.uint8)


def _cast(
    model: mujoco.MjModel, data: mujoco.MjData, rays: RayBundle, groups: npt.NDArray[np.uint8], exclude: int = -1
) -> RayHits:
    directions, start = rays.directions, rays.start
    count = len(directions)
    geoms, distances = np.empty(count, np.int32), np.empty(count)
    mujoco.mj_multiRay(
        model, data, rays.origin, directions.reshape(-1), groups, 1, exclude, geoms, distances, None, count, rays.reach
    )
    # read as unsigned numbers, floats keep their order, and negative ones, which are misses, come after all others
    infinite = distances.view(np.uint64) > rays.limit
    np.copyto(distances, _INFINITE, where=infinite)
    if start > 0 and np.minimum.reduce(distances) < start:
        # the engine knows one origin for all, so what is hit too near is looked for again, one by one
        geom = np.empty(1, np.int32)
        for i in np.flatnonzero(distances < start).tolist():
            place = rays.origin + start * directions[i]
            found = mujoco.mj_ray(model, data, place, directions[i], groups, 1, exclude, geom, None)
            infinite[i] = found < 0 or start + found > rays.reach
            distances[i] = np.inf if infinite[i] else start + found
            geoms[i] = geom[0]
    return distances, geoms, infinite


class WholeModelCaster:
    """Everything that is seen, in a copy of the compiled model.

    The copy differs in what the engine passes over: geoms without opacity, and bodies where a ray misses what
    collides of them. Their bounds hold all that is seen here.
    """

    def __init__(self, model: mujoco.MjModel, seen: npt.NDArray[np.bool_]) -> None:
        self.model = own = copy.copy(model)
        own.geom_group[:] = np.where(seen, _SEEN, _UNSEEN)
        own.geom_matid[:] = -1
        own.geom_rgba[:, 3] = 1.0
        rows, bounds = _bounds_to_widen(own, seen)
        own.bvh_aabb[rows] = bounds

    def cast(self, data: mujoco.MjData, rays: RayBundle, body: int, own: Sequence[int]) -> RayHits:
        """Casts through everything.

        Args:
            body: not hit, where it moves.
            own: geoms that are not hit where it does not: excluding the body would exclude the world.
        """
        with temporary_values(self.model.geom_group, own if body <= 0 else (), _UNSEEN):
            return _cast(self.model, data, rays, _SOLIDS, body if body > 0 else -1)


class ReducedModelCaster:
    """Planes and shapes alone, each carrier a body, so that there is less to look through than in the compiled model.

    What no ray can meet is left out: moving bodies above or below the whole fan, and planes out of reach.

    Args:
        model: compiled.
        geoms: planes and shapes of that model, shape (m,).
        types, carriers: of each, shape (m,).
        bodies: MuJoCo body of each carrier.

    Attributes:
        ids: geoms of the compiled model by those here; the last, -1, is for none.
        movers: geoms of the compiled model that do not stand still, shape (k,).
    """

    def __init__(self, model: mujoco.MjModel, geoms: Ids, types: Ids, carriers: Ids, bodies: Sequence[int]) -> None:
        order = np.argsort(carriers, kind="stable")
        full, types, carriers = geoms[order], types[order], carriers[order]
        standing = carriers == 0
        first = int(np.count_nonzero(standing))
        self._alone = _compile_reduced_model(model, full[:first], carriers[:first])
        self._all = _compile_reduced_model(model, full, carriers) if first < len(full) else self._alone
        kept = np.unique(carriers[first:])
        self._model, self.ids = model, np.append(full, -1).astype(np.int32)
        # carrier 0 stands where it is; all the others are looked up when they are needed
        self.movers, self._carriers = full[first:], carriers[first:]
        self._bodies = np.array([bodies[c] for c in kept], dtype=np.intp)
        self._firsts = np.searchsorted(self._carriers, kept)  # of each one's geoms
        data = self._all[1]
        self._geom_xpos, self._geom_xmat = data.geom_xpos[first:], data.geom_xmat[first:]
        self._places = data.xipos[1:], data.xpos[1:], data.ximat[1:], data.xmat[1:]
        flat = np.flatnonzero(standing & (types == 0))
        normals, points = self._alone[1].geom_xmat[flat, 2::3], self._alone[1].geom_xpos[flat]
        self._planes = list(zip(points.tolist(), normals.tolist(), strict=True))

    def sight(self, carrier: int, body: int, offset: Pose | None, lowest: float, highest: float) -> Ids:
        """Which of the movers a fan may meet.

        Args:
            carrier: what it does not meet.
            body: that it is on.
            offset: its frame in the body's; None where that may change.
            lowest, highest: angles between which its rays leave the plane across the frame's z [rad].
        """
        met = self._carriers != carrier
        if offset is not None:
            met &= can_meet(self._model, body, offset, self.movers, lowest, highest)
        return np.flatnonzero(met)

    def cast(self, data: mujoco.MjData, rays: RayBundle, nearby: NearbyGeoms) -> RayHits:
        """Casts through planes, what stands still, and those of `movers` that are in `nearby`.

        Geoms are positions in `ids`.
        """
        found = nearby.met(data, rays)
        if not found.size:
            groups = _SOLIDS_AND_PLANES if self._planes and self._reaches_plane(rays) else _SOLIDS
            return _cast(*self._alone, rays, groups)
        met = np.zeros(len(self.movers), dtype=np.bool_)
        met[found] = True
        self._move(data, met)
        return _cast(*self._all, rays, _SOLIDS_AND_PLANES)

    def _move(self, data: mujoco.MjData, met: npt.NDArray[np.bool_]) -> None:
        """Puts movers in their places; far away those that no ray meets, where the engine passes them over soonest."""
        # the sizes fit, so this is memory copied to memory; "clip" only spares NumPy a buffer
        data.geom_xpos.take(self.movers, 0, self._geom_xpos, "clip")
        data.geom_xmat.take(self.movers, 0, self._geom_xmat, "clip")
        self._geom_xpos[~met] = ENDLESS
        xipos, xpos, ximat, xmat = self._places
        data.xpos.take(self._bodies, 0, xpos, "clip")
        data.xmat.take(self._bodies, 0, xmat, "clip")
        xpos[~np.logical_or.reduceat(met, self._firsts)] = ENDLESS
        xipos[:], ximat[:] = xpos, xmat

    def _reaches_plane(self, rays: RayBundle) -> bool:
        """Whether a ray may come down on one of the planes that stand still; never wrongly False."""
        return any(reaches_plane(rays, point, normal) for point, normal in self._planes)


def _compile_reduced_model(model: mujoco.MjModel, geoms: Ids, carriers: Ids) -> tuple[mujoco.MjModel, mujoco.MjData]:
    reduced = mujoco.MjModel.from_xml_string(_reduced_mjcf(model, geoms, carriers))
    data = mujoco.MjData(reduced)
    mujoco.mj_kinematics(reduced, data)
    return reduced, data


def _reduced_mjcf(model: mujoco.MjModel, geoms: Ids, carriers: Ids) -> str:
    """MJCF of some geoms, those of carrier 0 in the world, the others in a body each; sorted by carrier."""
    text, carrier = [_MJCF_HEADER], 0
    for geom, of in zip(geoms.tolist(), carriers.tolist(), strict=True):
        if of != carrier:
            text.append(("</body>" if carrier else "") + '<body mocap="true"><inertial pos="0 0 0" mass="1"')
            text.append(' diaginertia="1 1 1"/>')
            carrier = of
        kind = int(model.geom_type[geom])
        place, turn, size = (
            " ".join(map(repr, values.tolist()))
            for values in (model.geom_pos[geom], model.geom_quat[geom], model.geom_size[geom])
        )
        group = _SOLID if kind else _FLAT
        text.append(
            f'<geom type="{_GEOM_TYPE_NAMES[kind]}" group="{group}" size="{size}" pos="{place}" quat="{turn}"/>'
        )
    text.append(("</body>" if carrier else "") + "</worldbody></mujoco>")
    return "".join(text)


def _bounds_to_widen(model: mujoco.MjModel, is_seen: npt.NDArray[np.bool_]) -> tuple[npt.NDArray[np.intp], Vector]:
    """Bounds of bodies (rows of `bvh_aabb`: centre and half size, in the inertial frame) that seen geoms stick out of.

    Returns:
        The rows, shape (k,), and what they should be, shape (k, 6).
    """
    seen = np.flatnonzero(is_seen)
    bodies = model.geom_bodyid[seen]
    seen = seen[model.body_bvhnum[bodies] > 0]
    bodies = model.geom_bodyid[seen]
    turn = np.empty((model.nbody, 9))
    for body in np.unique(bodies):
        mujoco.mju_quat2Mat(turn[body], model.body_iquat[body])
    centre = model.geom_pos[seen] - model.body_ipos[bodies]
    centre = np.einsum("gji,gj->gi", turn.reshape(-1, 3, 3)[bodies], centre)
    # a plane has no radius: it has no end
    radius = np.where(model.geom_rbound[seen] > 0, model.geom_rbound[seen], ENDLESS)[:, None]
    roots = model.body_bvhadr
    low, high = np.full((model.nbody, 3), np.inf), np.full((model.nbody, 3), -np.inf)
    np.minimum.at(low, bodies, centre - radius)
    np.maximum.at(high, bodies, centre + radius)
    found = np.unique(bodies)
    rows = roots[found].astype(np.intp)
    box = model.bvh_aabb[rows]
    low, high = np.minimum(low[found], box[:, :3] - box[:, 3:]), np.maximum(high[found], box[:, :3] + box[:, 3:])
    wide = np.hstack(((low + high) / 2, (high - low) / 2))
    changed = (wide[:, 3:] > box[:, 3:] + 1e-12).any(axis=1)
    return rows[changed], wide[changed]
