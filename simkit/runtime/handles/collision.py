"""Handle of a collision."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from simkit.argument_checks import checked_number
from simkit.compiler.contact_friction import has_directional_friction
from simkit.compiler.number_edits import surface_numbers
from simkit.errors import InputError
from simkit.runtime.handles.handle import Handle

if TYPE_CHECKING:
    from simkit.runtime.handles.entity_handles import EntityHandles
    from simkit.runtime.handles.link import Link
    from simkit.scene import SceneCollision

_FRICTION_FIELDS = ("friction", "condim", "priority")


class Collision(Handle):
    """Collision of a link.

    Attributes:
        link: link that carries the collision.
    """

    def __init__(self, handles: EntityHandles, name: str, scoped: str, link: Link) -> None:
        super().__init__(handles, name, scoped)
        self.link = link

    @property
    def scene(self) -> SceneCollision:
        """Description of the collision in the file."""
        return next(c for c in self.link.scene.collisions if c.scoped == self.scoped)

    @property
    def friction(self) -> float:
        """Coefficient of sliding friction, at most 2; settable. Of two surfaces the smaller coefficient counts."""
        geoms = self._geoms()
        return float(self._physics.model.geom_friction[geoms[0], 0]) if geoms else self.scene.surface.mu

    @friction.setter
    def friction(self, friction: float) -> None:
        mu = checked_number(friction, "friction", 0.0)
        surface = self.scene.surface
        if has_directional_friction(surface):
            message = f"the friction of collision {self.scoped!r} has a direction, so it cannot change during a run"
            help_ = f"set it before the load, with overrides=['{self.scoped}.mu=…']"
            raise InputError("SK-CORE-006", message, help=help_)
        geoms = self._geoms()
        numbers = surface_numbers(self._engine.compiled, replace(surface, mu=mu, mu2=mu))
        for field in _FRICTION_FIELDS if geoms else ():
            self._engine.numbers.write(f"geom_{field}", geoms, numbers[field])
        self._engine.numbers.keep("collision", self.scoped, "friction", mu)

    def _geoms(self) -> list[int]:
        """Return the geoms of the collision that make contacts."""
        self.link.check_present()
        names = self._engine.names
        return [g for g in names.link(self.link.scene.scoped).geoms if names.geom_owner(g)[1] == self.scoped]
