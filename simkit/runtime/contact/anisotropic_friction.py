"""Friction that differs along and across a direction, and contacts that slip in proportion to their force.

MuJoCo's contacts have two coefficients along two tangents, which MuJoCo chooses from the normal alone. Gazebo's
contacts have them along `<fdir1>`, which turns with a link: a wheel with rollers grips along the rollers and rolls
across. Gazebo's contacts may also slip: their surfaces pass each other at a speed of compliance times force (ODE's
`slip1`, `slip2` [m/s/N]).

This module changes the contacts of such collisions after MuJoCo has computed positions and velocities, and before it
solves for forces. The contacts get their tangents and coefficients, and their friction gets the softness that lets it
slip (`contact_slip`). Every forward pass does this (`Physics.shaper`), so that readers make no difference.
"""

from __future__ import annotations

import weakref
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import mujoco
import numpy as np

from simkit.compiler.contact_friction import directional_friction, directional_slip, has_directional_friction
from simkit.diagnostics import NOWHERE, Where
from simkit.linear_algebra import matmul
from simkit.runtime.contact.contact_slip import ContactSlip
from simkit.runtime.contact.friction_contacts import AnyFrictionContacts, find_friction_contacts
from simkit.runtime.contact.friction_tangents import FrictionRow, FrictionTangents, RowContacts
from simkit.runtime.contact.moving_surface import Belt, BeltMotion, MovingSurfaces

if TYPE_CHECKING:
    from simkit.compiler import Compiled
    from simkit.compiler.name_map import LinkBinding, NameMap
    from simkit.diagnostics import Diagnostics
    from simkit.runtime.contact.contact_law import ContactShaper
    from simkit.scene import SceneCollision

Numbers = list[float]
Pair = tuple[float, float]

_ELLIPTIC = mujoco.mjtCone.mjCONE_ELLIPTIC
_DISCRETE = mujoco.mjtIntegrator.mjINT_DISCRETE
_NO_ISLANDS = int(mujoco.mjtDisableBit.mjDSBL_ISLAND)
_SHARED_KEY = "directed friction"


@dataclass(frozen=True, slots=True)
class SlippingWheel:
    """Wheel whose contacts slip in proportion to its rate of rotation.

    Attributes:
        link: scoped name of the wheel.
        joint: scoped name of the wheel's joint.
    """

    link: str
    joint: str


WheelSlips = Callable[[], list[Pair]]
"""Function that returns two compliances for each wheel, along its axle and ahead, per rate of rotation [m/N]."""


class ContactRequest(NamedTuple):
    """Requests of plugins at one tick: the motions of belts, and the slips of each plugin's wheels."""

    runs: list[BeltMotion | None]
    slips: list[list[Pair]]


class AnisotropicFriction:
    """Contacts of a simulation with directional friction or slip. A world without such contacts loses no time.

    Args:
        use_shaper: function that lets a function object change the contacts before they are solved; None for none.
        changed_contacts: function that records that contacts must be detected again.
        reports: collection for a warning if the integrator cannot support such contacts.
    """

    def __init__(
        self,
        use_shaper: Callable[[ContactShaper | None], None],
        changed_contacts: Callable[[], None],
        reports: Diagnostics,
    ) -> None:
        self._use_shaper, self._changed_contacts, self._reports = use_shaper, changed_contacts, reports
        self._compiled: Compiled
        self._plugins: frozenset[int] = frozenset()
        self._is_reported = False
        self._wheels: weakref.WeakKeyDictionary[object, tuple[tuple[SlippingWheel, ...], WheelSlips]]
        self._wheels = weakref.WeakKeyDictionary()
        self._belts: weakref.WeakKeyDictionary[object, Callable[[], Sequence[Belt]]] = weakref.WeakKeyDictionary()

    def bind(self, compiled: Compiled, plugins: Iterable[object], *, is_changed: bool = False) -> None:
        """Switch to another compiled model; only wheels and belts of these plugins count from now on.

        Args:
            compiled: compiled model with its names.
            plugins: plugins of the simulation.
            is_changed: True if surfaces have changed since an earlier call with this model.
        """
        self._compiled, self._plugins = compiled, frozenset(map(id, plugins))
        if is_changed:
            compiled.names.forget_shared(_SHARED_KEY)
        table = self._table()
        for owner, (wheels, slips) in self._wheels.items():
            if id(owner) in self._plugins:
                table.add_wheels(owner, wheels, slips)
        for owner, belts in self._belts.items():
            if id(owner) in self._plugins:
                table.add_belts(owner, belts())
        self._install(table)

    def add_belts(self, owner: object, belts: Callable[[], Sequence[Belt]]) -> None:
        """Add moving surfaces, which exist as long as their plugin.

        Args:
            owner: plugin of the belts.
            belts: function that returns the belts in the present engine model.
        """
        self._belts[owner] = belts
        table = self._table()
        table.add_belts(owner, belts())
        self._install(table)
        self._changed_contacts()

    def add_wheels(self, owner: object, wheels: Sequence[SlippingWheel], slips: WheelSlips) -> None:
        """Add slipping wheels, which exist as long as their plugin.

        Args:
            owner: plugin of the wheels.
            wheels: wheels of the plugin's model.
            slips: function that is called in every forward pass, so that the slips are part of the plugin's state.
        """
        self._wheels[owner] = tuple(wheels), slips
        table = self._table()
        table.add_wheels(owner, wheels, slips)
        self._install(table)
        self._changed_contacts()

    def _install(self, table: _ModelFriction) -> None:
        """Make the physics use a table, if the table is not empty and the integrator allows it."""
        has_place = table.model.opt.integrator != _DISCRETE
        self._use_shaper(table if table and has_place else None)
        if table and not has_place and not self._is_reported:
            self._is_reported = True
            message = (
                "directional friction, slip and moving surfaces have no effect: the discrete integrator of the engine "
                "does not compute velocities before forces"
            )
            self._reports.warning("SK-PHYS-030", message, table.where(), 'integrator="implicitfast" in <option>')

    def owners(self) -> list[object]:
        """Return the present plugins with slipping wheels."""
        return [owner for owner in self._wheels if id(owner) in self._plugins]

    def _table(self) -> _ModelFriction:
        compiled = self._compiled
        return compiled.names.shared(_SHARED_KEY, lambda: _ModelFriction(compiled.model, compiled.names))


class _ModelFriction:
    """Slipping and directional contacts of one compiled model."""

    def __init__(self, model: mujoco.MjModel, names: NameMap) -> None:
        self.model, self._names = model, names
        self._rows: dict[str, FrictionRow] = {}
        self._sources: dict[int, tuple[list[str], WheelSlips]] = {}
        self._softness = ContactSlip(model)
        self.surfaces, self._belts = MovingSurfaces(model), set[int]()
        for link in names.links.values():
            for collision in link.scene.collisions:
                surface = collision.surface
                if has_directional_friction(surface) or any(directional_slip(surface)):
                    self._rows[collision.scoped] = self._of_surface(link, collision)
        self._arrange()

    def __bool__(self) -> bool:
        return bool(self._rows or self._belts)

    def where(self) -> Where:
        """Return the file position of the first affected link."""
        geoms = {geom for geom, concerned in enumerate(self._concerns) if concerned}
        return next((link.scene.where for link in self._names.links.values() if geoms & set(link.geoms)), NOWHERE)

    @property
    def acts(self) -> bool:
        """True if some contact may have to be changed."""
        return bool(self._rows) or self.surfaces.run

    def add_belts(self, owner: object, belts: Sequence[Belt]) -> None:
        """Add the moving surfaces of a plugin; a second call has no effect."""
        if id(owner) not in self._belts:
            self._belts.add(id(owner))
            for belt in belts:
                self.surfaces.add(belt)
                self._set_belt_friction(belt)
            self._arrange()

    def _set_belt_friction(self, belt: Belt) -> None:
        """Set the friction of a belt's collisions to the coefficients that its plugin requests."""
        if belt.friction is None:
            return
        for scoped in dict.fromkeys(self._names.geom_owner(geom)[1] for geom in belt.geoms):
            geoms = [geom for geom in belt.geoms if self._names.geom_owner(geom)[1] == scoped]
            old = self._rows.get(scoped)
            slip = (0.0, 0.0) if old is None else old.slip
            tree = int(self.model.body_treeid[belt.body])
            self._rows[scoped] = FrictionRow(geoms, belt.body, list(belt.axle), belt.friction, slip, tree)

    def _of_surface(self, link: LinkBinding, collision: SceneCollision) -> FrictionRow:
        surface = collision.surface
        frame = _direction_link(surface.fdir1_frame, link.scoped, self._names)
        body, offset = (link.body, link.offset @ collision.pose_link) if frame is None else (frame.body, frame.offset)
        axis = matmul(offset.matrix, np.array(surface.fdir1)).tolist()
        tree = int(self.model.body_treeid[link.body])
        return FrictionRow(
            self._geoms(link, collision), body, axis, directional_friction(surface), directional_slip(surface), tree
        )

    def _geoms(self, link: LinkBinding, collision: SceneCollision) -> list[int]:
        return [geom for geom in link.geoms if self._names.geom_owner(geom)[1] == collision.scoped]

    def add_wheels(self, owner: object, wheels: Sequence[SlippingWheel], slips: WheelSlips) -> None:
        """Add the slipping wheels of a plugin; a second call has no effect."""
        if id(owner) in self._sources:
            return
        keys = []
        for wheel in wheels:
            link, joint = self._names.link(wheel.link), self._names.joint(wheel.joint)
            collision = link.scene.collisions[0]
            row = self._rows.get(collision.scoped)
            number = joint.joint_ids[0]
            body, axis = int(self.model.jnt_bodyid[number]), self.model.jnt_axis[number].tolist()
            if row is None:
                mu, tree = directional_friction(collision.surface), int(self.model.body_treeid[link.body])
                row = FrictionRow(self._geoms(link, collision), body, axis, mu, (0.0, 0.0), tree)
                self._rows[collision.scoped] = row
            elif not has_directional_friction(collision.surface):
                row.body, row.axis = body, axis
            row.dof = joint.dofs[0]
            keys.append(collision.scoped)
        self._sources[id(owner)] = (keys, slips)
        self._arrange()

    def _arrange(self) -> None:
        self._list = rows = list(self._rows.values())
        self._row_of = [-1] * (self.model.ngeom + 1)  # the last item is for index -1: no geom
        for number, row in enumerate(rows):
            for geom in row.geoms:
                self._row_of[geom] = number
        self._concerns = [a >= 0 or b for a, b in zip(self._row_of, self.surfaces.concerns, strict=True)]
        is_belt = [any(self.surfaces.concerns[geom] for geom in row.geoms) for row in rows]
        self._contacts = FrictionTangents(self.model, rows, self._row_of, is_belt)
        self._slip = [row.slip for row in rows]
        order = {key: number for number, key in enumerate(self._rows)}
        self._wheels = [[(order[key], self._rows[key].dof) for key in keys] for keys, _ in self._sources.values()]
        self._may_slip = bool(self._sources) or any(map(any, self._slip))

    # ------------------------------------------------------------------ in a forward pass

    def request(self) -> ContactRequest:
        """Return the present requests of plugins."""
        return ContactRequest(self.surfaces.runs(), [slips() for _, slips in self._sources.values()])

    def shape(self, data: mujoco.MjData, request: ContactRequest | None = None) -> None:
        """Set tangents, coefficients and softness of the affected contacts."""
        model, surfaces = self.model, self.surfaces
        runs, wheels = self.request() if request is None else request
        contacts = find_friction_contacts(data, self._concerns) if data.ncon else None
        flow = surfaces.look(data, contacts, runs)
        if contacts is None:
            return
        places = self._contacts.find(contacts)
        if not len(places):
            if flow is not None:
                surfaces.carry(data, contacts.frames)
                mujoco.mj_referenceConstraint(model, data)
            return
        self._contacts.turn(data, contacts, places, flow)
        surfaces.carry(data, contacts.frames)
        mujoco.mj_makeConstraint(model, data)
        soft = self._slipping_contacts(data, contacts, places, wheels) if self._may_slip else []
        is_elliptic = model.opt.cone == _ELLIPTIC
        if is_elliptic and soft:
            self._softness.soften(data, soft)
        if not model.opt.disableflags & _NO_ISLANDS:
            mujoco.mj_island(model, data)
        mujoco.mj_projectConstraint(model, data)
        mujoco.mj_referenceConstraint(model, data)
        if soft and not is_elliptic:
            for number, _, slip in soft:
                self._softness.soften_pyramid(data, number, slip)

    def _slipping_contacts(
        self, data: mujoco.MjData, contacts: AnyFrictionContacts, places: RowContacts, wheels: list[list[Pair]]
    ) -> list[tuple[int, int, Pair]]:
        """Return the slipping contacts with their kinematic trees and compliances [m/s/N]."""
        slips = self._slip
        if self._wheels:
            slips = slips.copy()
            qvel = data.qvel
            for those, directions in zip(self._wheels, wheels, strict=True):
                for (row, dof), (along, across) in zip(those, directions, strict=True):
                    (a, b), rate = slips[row], abs(qvel.item(dof))
                    slips[row] = a + rate * along, b + rate * across
        listed = places if isinstance(places, list) else places.tolist()
        numbers = contacts.numbers
        return [(int(numbers[place]), self._list[row].tree, slips[row]) for place, row, _ in listed if any(slips[row])]


def _direction_link(name: str, link: str, names: NameMap) -> LinkBinding | None:
    """Return the link in whose frame a friction direction is given. The name is resolved in the scope of the collision.

    The result is None for the collision's own link.
    """
    if not name:
        return None
    scope = link.rpartition("::")[0]
    return names.links.get(f"{scope}::{name}" if scope else name)
