"""Handle of a visual; labels and temperatures of models and visuals, by scoped name."""

from __future__ import annotations

import abc
import math
from collections.abc import Iterator, Mapping, MutableMapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar, Final, Self, TypeVar

from simkit.pose import Pose
from simkit.runtime.handles.handle import Handle, look_up

if TYPE_CHECKING:
    from simkit.runtime.engine.entity_structure import WorldStructure
    from simkit.runtime.handles.entity_handles import EntityHandles
    from simkit.runtime.handles.link import Link
    from simkit.scene import SceneModel, SceneVisual


class Visual(Handle):
    """What is drawn of a link for one `<visual>` of the file.

    Attributes:
        scene: as the file has it.
        link: that carries it.
    """

    def __init__(self, handles: EntityHandles, scene: SceneVisual, link: Link) -> None:
        super().__init__(handles, scene.name, scene.scoped)
        self.scene, self.link = scene, link

    def __repr__(self) -> str:
        return f"<Visual {self.scoped!r}{'' if self.link._is_present else ' (removed)'}>"

    @property
    def geoms(self) -> tuple[int, ...]:
        """Ids of the engine's geoms that draw it, in the present model; none for a shape that is not drawn."""
        self.link._check()
        drawn: dict[str, tuple[int, ...]] = self._engine.names.drawn(self.link.scoped)
        return drawn.get(self.scoped, ())

    def set_colour(self, red: float, green: float, blue: float, alpha: float = 1.0) -> None:
        """Paints it, each part from 0 to 1; what it is made of (gloss, glow, a picture it wears) stays."""
        parts = [min(1.0, max(0.0, float(part))) for part in (red, green, blue, alpha)]
        if parts == [0.5, 0.5, 0.5, 1.0]:
            parts[0] = 0.5001  # exactly MuJoCo's default would be taken for "not given"
        geoms = list(self.geoms)
        if geoms:
            self._engine.touch("geom_rgba")[geoms] = parts

    @property
    def pose(self) -> Pose:
        """Pose of the visual's frame in the world."""
        return self.link.pose @ self.scene.pose_link


Value = TypeVar("Value")


class VisualProperty(MutableMapping[str, Value], abc.ABC):
    """A value by scoped name; may be changed at any time.

    A visual has its own, else that of what is around it, the innermost first. A model that is removed takes its values
    along; snapshots and reset bring back what was.

    Attributes:
        entity_kinds: kinds of entities that may have one, besides visuals.
        read_by: attribute of the sensors that measure it; what they hold is measured before a change.
        state: all of them; never written to, only replaced, so that whoever worked something out of it knows.
    """

    entity_kinds: ClassVar[tuple[str, ...]] = ("model",)
    read_by: ClassVar[str] = ""

    def __init__(self, handles: EntityHandles) -> None:
        self._handles = handles
        self.state: Mapping[str, Value] = MappingProxyType({})

    @abc.abstractmethod
    def checked(self, value: Value) -> Value:
        """The value as it is kept; raises ValueError."""

    def __getitem__(self, scoped: str) -> Value:
        return self.state[scoped]

    def __setitem__(self, scoped: str, value: Value) -> None:
        """Raises KeyError, which names the closest, and ValueError."""
        value = self.checked(value)
        self._find(scoped)
        if self.state.get(scoped) != value:
            self._change({**self.state, scoped: value})

    def __delitem__(self, scoped: str) -> None:
        left = dict(self.state)
        del left[scoped]
        self._change(left)

    def __iter__(self) -> Iterator[str]:
        return iter(self.state)

    def __len__(self) -> int:
        return len(self.state)

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {dict(self.state)}>"

    def __deepcopy__(self, memo: dict[int, object]) -> Self:
        return self

    def by_visual(self, *, nested: bool = True) -> dict[str, Value]:
        """The value of every visual that has one, by scoped name, in document order.

        Args:
            nested: whether a model's also counts for the models in it.
        """
        found: dict[str, Value] = {}
        for model in self._handles.engine.structure.models.values() if self.state else ():
            self._collect(model, None, nested, found)
        return found

    def _collect(self, model: SceneModel, outer: Value | None, nested: bool, found: dict[str, Value]) -> None:
        state = self.state
        own = state.get(model.scoped, outer)
        for link in model.links:
            of_link = state.get(link.scoped, own)
            for visual in link.visuals:
                value = state.get(visual.scoped, of_link)
                if value is not None:
                    found[visual.scoped] = value
        for inner in model.models:
            self._collect(inner, own if nested else None, nested, found)

    # ------------------------------------------------------------------ what the simulation calls

    def bind(self, structure: WorldStructure) -> None:
        """Forgets the values of models that are not there any more."""
        kept = {k: v for k, v in self.state.items() if k.split("::", 1)[0] in structure.models}
        if len(kept) != len(self.state):
            self.state = MappingProxyType(kept)

    def get_state(self) -> Mapping[str, Value]:
        return self.state

    def set_state(self, state: Mapping[str, Value]) -> None:
        self.state = state

    # ------------------------------------------------------------------ within

    def _find(self, scoped: str) -> None:
        handles = self._handles
        known = {name: handle for kind in self.entity_kinds for name, handle in handles.tables[kind].items()}
        if scoped in known:
            return
        try:
            handles.find_visual(scoped)
        except KeyError:
            look_up({**known, **handles.visuals()}, scoped, f"{', '.join(self.entity_kinds)} or visual")

    def _change(self, values: dict[str, Value]) -> None:
        """Samples that wait to be looked at are measured with the values of their time."""
        found: list[Any] = [s for s in self._handles.engine.structure.all_sensors() if getattr(s, self.read_by, False)]
        for camera in found:
            camera.finish_samples()
        self.state = MappingProxyType(values)


MAX_LABEL: Final = 255


class Labels(VisualProperty[int]):
    """Label by scoped name of a model or a visual; may be changed at any time.

        sim.contents.labels["shelf"] = 40                    # the model and all that is in it
        sim.contents.labels["shelf::base::handle"] = 41      # one visual
        del sim.contents.labels["shelf"]

    A visual wears its own label, else that of the innermost model around it that has one. A model that is removed
    takes its labels along; snapshots and reset bring back what was.
    """

    read_by = "reads_labels"

    def checked(self, value: int) -> int:
        number = int(value)
        if number != value or not 0 <= number <= MAX_LABEL:
            raise ValueError(f"a label is a whole number from 0 to {MAX_LABEL}, got {value}")
        return number


@dataclass(frozen=True, slots=True)
class HeatSignature:
    """A picture that a surface wears by its texture coordinates; its red tells the temperature.

    Attributes:
        coldest, hottest: where red is 0 and where it is full [K].
    """

    picture: Path
    coldest: float
    hottest: float


Temperature = float | HeatSignature


class Temperatures(VisualProperty[Temperature]):
    """Temperature [K] or heat signature by scoped name of a model, a link or a visual; may be changed at any time.

        sim.contents.temperatures["stove::base::plate"] = 450.0     # one visual
        sim.contents.temperatures["stove"] = 310.0                  # all that has none of its own

    A visual has its own, else that of its link, else that of the innermost model around it that has one. A model that
    is removed takes them along; snapshots and reset bring back what was.
    """

    entity_kinds = ("model", "link")
    read_by = "reads_temperatures"

    def checked(self, value: Temperature) -> Temperature:
        if isinstance(value, HeatSignature):
            return value
        kelvins = float(value)
        if not (math.isfinite(kelvins) and kelvins >= 0):
            raise ValueError(f"a temperature is a number of at least 0 [K], got {kelvins}")
        return kelvins
