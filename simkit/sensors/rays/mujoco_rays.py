"""Ray casting with MuJoCo: through the whole model, or through planes and shapes only."""

from __future__ import annotations

import copy
from collections.abc import Sequence
from contextlib import AbstractContextManager

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.pose import Pose, Vector
from simkit.sensors.rays.geom_types import Ids
from simkit.sensors.rays.ray_culling import ENDLESS, NearbyGeoms, RayBundle, RayHits, can_reach, reaches_plane
from simkit.sensors.values_with_expiry import temporary_values

_SEEN, _UNSEEN = 0, 1  # geom groups of the copied model
_INFINITE = np.array(np.inf)
_MJCF_HEADER = (
    '<mujoco><compiler angle="radian"/><option><flag contact="disable"/></option>'
    '<default><geom mass="0" contype="1" conaffinity="1"/></default><worldbody>'
)
_GEOM_TYPE_NAMES = {0: "plane", 2: "sphere", 3: "capsule", 4: "ellipsoid", 5: "cylinder", 6: "box"}
_SOLID, _FLAT = 0, 1  # geom groups of the reduced models
SOLIDS = np.array((1, 0, 0, 0, 0, 0), dtype=np.uint8)
SOLIDS_AND_PLANES = np.array((1, 1, 0, 0, 0, 0), dtype=np.uint8)


def _cast(
    model: mujoco.MjModel, data: mujoco.MjData, rays: RayBundle, groups: npt.NDArray[np.uint8], exclude: int = -1
) -> RayHits:
    directions, start = rays.directions, rays.start
    count = len(directions)
    geoms, distances = np.empty(count, np.int32), np.empty(count)
    mujoco.mj_multiRay(
        model, data, rays.origin, directions.reshape(-1), groups, 1, exclude, geoms, distances, None, count, rays.reach
    )
    # as unsigned integers, floats keep their order, and negative floats, which are misses, come last
    infinite = distances.view(np.uint64) > rays.limit
    np.copyto(distances, _INFINITE, where=infinite)
    if start > 0 and np.minimum.reduce(distances) < start:
        # the engine has no start distance, so rays with a hit before the start are cast again, one by one
        geom = np.empty(1, np.int32)
        for i in np.flatnonzero(distances < start).tolist():
            position = rays.origin + start * directions[i]
            distance = mujoco.mj_ray(model, data, position, directions[i], groups, 1, exclude, geom, None)
            infinite[i] = distance < 0 or start + distance > rays.reach
            distances[i] = np.inf if infinite[i] else start + distance
            geoms[i] = geom[0]
    return distances, geoms, infinite


class WholeModelCaster:
    """Caster of rays through all visible geoms, in a copy of the compiled model.

    The engine skips transparent geoms, and bodies whose bounds of colliding geoms a ray misses. The copy has no
    transparent geoms, and its bounds contain all visible geoms.
    """

    def __init__(self, model: mujoco.MjModel, seen: npt.NDArray[np.bool_]) -> None:
        self.model = copied = copy.copy(model)
        copied.geom_group[:] = np.where(seen, _SEEN, _UNSEEN)
        copied.geom_matid[:] = -1
        copied.geom_rgba[:, 3] = 1.0
        rows, bounds = _bounds_to_widen(copied, seen)
        copied.bvh_aabb[rows] = bounds

    def cast(self, data: mujoco.MjData, rays: RayBundle, body: int, excluded: Sequence[int]) -> RayHits:
        """Cast rays through all visible geoms.

        Args:
            data: physics data with up-to-date poses.
            rays: rays to cast.
            body: moving body that is not hit, or 0.
            excluded: geoms that are not hit if `body` is 0; excluding the world body would exclude all static geoms.
        """
        with self.without(excluded if body <= 0 else ()):
            return _cast(self.model, data, rays, SOLIDS, body if body > 0 else -1)

    def without(self, geoms: Sequence[int]) -> AbstractContextManager[None]:
        """Hide geoms from the rays in a `with` block."""
        return temporary_values(self.model.geom_group, geoms, _UNSEEN)


class ReducedModelCaster:
    """Caster of rays through planes and shapes only, in a smaller and faster model with one body per carrier.

    Geoms that no ray can hit are left out: moving bodies above or below the whole fan, and planes out of reach.

    Args:
        model: compiled model.
        geoms: planes and shapes of that model, shape (m,).
        types, carriers: type and carrier of each geom, shape (m,).
        bodies: MuJoCo body of each carrier.

    Attributes:
        ids: geom ids of the compiled model by the ids of this model; the last, -1, means no geom.
        movers: geoms of the compiled model that can move, shape (k,).
    """

    def __init__(self, model: mujoco.MjModel, geoms: Ids, types: Ids, carriers: Ids, bodies: Sequence[int]) -> None:
        order = np.argsort(carriers, kind="stable")
        full, types, carriers = geoms[order], types[order], carriers[order]
        is_static = carriers == 0
        first = int(np.count_nonzero(is_static))
        self._static = _compile_reduced_model(model, full[:first], carriers[:first])
        self._all = _compile_reduced_model(model, full, carriers) if first < len(full) else self._static
        # not `np.unique`, because it imports `numpy.ma`, which takes 15 ms
        used_carriers = np.array(sorted(set(carriers[first:].tolist())), carriers.dtype)
        self._model, self.ids = model, np.append(full, -1).astype(np.int32)
        # carrier 0 is static; the poses of the other carriers are copied for each cast
        self.movers, self._carriers = full[first:], carriers[first:]
        self._bodies = np.array([bodies[c] for c in used_carriers], dtype=np.intp)
        self._firsts = np.searchsorted(self._carriers, used_carriers)  # index of each carrier's first geom
        data = self._all[1]
        self._geom_xpos, self._geom_xmat = data.geom_xpos[first:], data.geom_xmat[first:]
        self._poses = data.xipos[1:], data.xpos[1:], data.ximat[1:], data.xmat[1:]
        flat = np.flatnonzero(is_static & (types == 0))
        normals, points = self._static[1].geom_xmat[flat, 2::3], self._static[1].geom_xpos[flat]
        self._planes = list(zip(points.tolist(), normals.tolist(), strict=True))

    def reachable_movers(self, carrier: int, body: int, offset: Pose | None, lowest: float, highest: float) -> Ids:
        """Return the indices of the movers that a fan can hit.

        Args:
            carrier: carrier that the fan does not hit.
            body: body that carries the fan.
            offset: the fan's frame in the body's frame; None where it may change.
            lowest: lowest elevation of the rays above the plane perpendicular to the frame's z axis [rad].
            highest: highest elevation of the rays above that plane [rad].
        """
        is_reachable = self._carriers != carrier
        if offset is not None:
            is_reachable &= can_reach(self._model, body, offset, self.movers, lowest, highest)
        return np.flatnonzero(is_reachable)

    @property
    def static_model(self) -> mujoco.MjModel:
        """Model of the planes and shapes that do not move; its geoms are the first of `ids`."""
        return self._static[0]

    @property
    def has_planes(self) -> bool:
        """True if the static model has planes."""
        return bool(self._planes)

    def model_for_rows(self, has_movers: bool) -> mujoco.MjModel:
        """Return the model in which the rays of many simulations are cast, with all movers or with none."""
        return (self._all if has_movers else self._static)[0]

    def mover_bodies(self, carrier: int) -> tuple[Ids, npt.NDArray[np.bool_]]:
        """Return the body of the compiled model of each moving body, and whether a fan on a carrier may hit it."""
        return self._bodies, self._carriers[self._firsts] != carrier

    def cast(self, data: mujoco.MjData, rays: RayBundle, nearby: NearbyGeoms) -> RayHits:
        """Cast rays through planes, static shapes, and those of `movers` that are in `nearby`.

        Geoms in the result are indices in `ids`.
        """
        reached = nearby.reached(data, rays)
        if not reached.size:
            groups = SOLIDS_AND_PLANES if self._planes and self._reaches_plane(rays) else SOLIDS
            return _cast(*self._static, rays, groups)
        is_reached = np.zeros(len(self.movers), dtype=np.bool_)
        is_reached[reached] = True
        self._move(data, is_reached)
        return _cast(*self._all, rays, SOLIDS_AND_PLANES)

    def _move(self, data: mujoco.MjData, is_reached: npt.NDArray[np.bool_]) -> None:
        """Set the poses of the movers; movers that no ray reaches go far away, where the engine rejects them first."""
        # the sizes match, so this copies memory; "clip" avoids a buffer in NumPy
        data.geom_xpos.take(self.movers, 0, self._geom_xpos, "clip")
        data.geom_xmat.take(self.movers, 0, self._geom_xmat, "clip")
        self._geom_xpos[~is_reached] = ENDLESS
        xipos, xpos, ximat, xmat = self._poses
        data.xpos.take(self._bodies, 0, xpos, "clip")
        data.xmat.take(self._bodies, 0, xmat, "clip")
        xpos[~np.logical_or.reduceat(is_reached, self._firsts)] = ENDLESS
        xipos[:], ximat[:] = xpos, xmat

    def _reaches_plane(self, rays: RayBundle) -> bool:
        """Check whether a ray may hit one of the static planes; False is always correct, True may be wrong."""
        return any(reaches_plane(rays, point, normal) for point, normal in self._planes)


def _compile_reduced_model(model: mujoco.MjModel, geoms: Ids, carriers: Ids) -> tuple[mujoco.MjModel, mujoco.MjData]:
    reduced = mujoco.MjModel.from_xml_string(_reduced_mjcf(model, geoms, carriers))
    data = mujoco.MjData(reduced)
    mujoco.mj_kinematics(reduced, data)
    return reduced, data


def _reduced_mjcf(model: mujoco.MjModel, geoms: Ids, carriers: Ids) -> str:
    """Return MJCF of some geoms sorted by carrier: carrier 0 is the world body, each other carrier is a body."""
    parts, carrier = [_MJCF_HEADER], 0
    for geom, geom_carrier in zip(geoms.tolist(), carriers.tolist(), strict=True):
        if geom_carrier != carrier:
            parts.append(("</body>" if carrier else "") + '<body mocap="true"><inertial pos="0 0 0" mass="1"')
            parts.append(' diaginertia="1 1 1"/>')
            carrier = geom_carrier
        kind = int(model.geom_type[geom])
        position, quaternion, size = (
            " ".join(map(repr, values.tolist()))
            for values in (model.geom_pos[geom], model.geom_quat[geom], model.geom_size[geom])
        )
        group = _SOLID if kind else _FLAT
        shape = f'type="{_GEOM_TYPE_NAMES[kind]}" group="{group}" size="{size}"'
        parts.append(f'<geom {shape} pos="{position}" quat="{quaternion}"/>')
    parts.append(("</body>" if carrier else "") + "</worldbody></mujoco>")
    return "".join(parts)


def _bounds_to_widen(model: mujoco.MjModel, is_seen: npt.NDArray[np.bool_]) -> tuple[npt.NDArray[np.intp], Vector]:
    """Return the bounds of bodies that must grow, because visible geoms extend beyond them.

    Bounds are rows of `bvh_aabb`: centre and half size, in the inertial frame.

    Returns:
        The rows, shape (k,), and their new values, shape (k, 6).
    """
    seen = np.flatnonzero(is_seen)
    bodies = model.geom_bodyid[seen]
    seen = seen[model.body_bvhnum[bodies] > 0]
    bodies = model.geom_bodyid[seen]
    turn = np.empty((model.nbody, 9))
    moved_bodies = np.array(sorted(set(bodies.tolist())), bodies.dtype)
    for body in moved_bodies:
        mujoco.mju_quat2Mat(turn[body], model.body_iquat[body])
    centre = model.geom_pos[seen] - model.body_ipos[bodies]
    centre = np.einsum("gji,gj->gi", turn.reshape(-1, 3, 3)[bodies], centre)
    # MuJoCo gives planes a radius of 0, but a plane is infinite
    radius = np.where(model.geom_rbound[seen] > 0, model.geom_rbound[seen], ENDLESS)[:, None]
    roots = model.body_bvhadr
    low, high = np.full((model.nbody, 3), np.inf), np.full((model.nbody, 3), -np.inf)
    np.minimum.at(low, bodies, centre - radius)
    np.maximum.at(high, bodies, centre + radius)
    rows = roots[moved_bodies].astype(np.intp)
    box = model.bvh_aabb[rows]
    low, high = (
        np.minimum(low[moved_bodies], box[:, :3] - box[:, 3:]),
        np.maximum(high[moved_bodies], box[:, :3] + box[:, 3:]),
    )
    wide = np.hstack(((low + high) / 2, (high - low) / 2))
    changed = (wide[:, 3:] > box[:, 3:] + 1e-12).any(axis=1)
    return rows[changed], wide[changed]
