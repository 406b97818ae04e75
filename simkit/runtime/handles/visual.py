"""Handle of a visual; labels and temperatures of models and visuals, by scoped name."""

from __future__ import annotations

import abc
import math
from collections.abc import Iterator, Mapping, MutableMapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar, Final, Self, TypeVar

from simkit.argument_checks import checked_vector
from simkit.pose import Pose
from simkit.runtime.handles.handle import Handle, look_up

if TYPE_CHECKING:
    from simkit.runtime.engine.entity_structure import WorldStructure
    from simkit.runtime.handles.entity_handles import EntityHandles
    from simkit.runtime.handles.link import Link
    from simkit.scene import SceneModel, SceneVisual


class Visual(Handle):
    """Drawn shape of a link for one `<visual>` of the file.

    Attributes:
        scene: description in the file.
        link: link that carries the visual.
    """

    def __init__(self, handles: EntityHandles, scene: SceneVisual, link: Link) -> None:
        super().__init__(handles, scene.name, scene.scoped)
        self.scene, self.link = scene, link

    def __repr__(self) -> str:
        return f"<Visual {self.scoped!r}{'' if self.link.is_present else ' (removed)'}>"

    @property
    def geoms(self) -> tuple[int, ...]:
        """Ids of the engine's geoms of the visual in the present model; empty for a shape that is not drawn."""
        self.link.check_present()
        drawn: dict[str, tuple[int, ...]] = self._engine.names.drawn(self.link.scoped)
        return drawn.get(self.scoped, ())

    def set_colour(self, red: float, green: float, blue: float, alpha: float = 1.0) -> None:
        """Set the colour, each component from 0 to 1; gloss, glow and texture stay."""
        components = checked_vector((red, green, blue, alpha), "colour", 4).tolist()
        parts = [min(1.0, max(0.0, part)) for part in components]
        if parts == [0.5, 0.5, 0.5, 1.0]:
            parts[0] = 0.5001  # MuJoCo interprets its exact default as "not given"
        geoms = list(self.geoms)
        if geoms:
            self._engine.touch("geom_rgba")[geoms] = parts

    def set_material(self, name: str) -> None:
        """Show a material that `SpecBuilder.add_script_material` has added for this visual."""
        geoms = list(self.geoms)
        if geoms:
            self._engine.touch("geom_matid")[geoms] = self._physics.model.material(name).id

    @property
    def pose(self) -> Pose:
        """Pose of the visual's frame in the world."""
        return self.link.pose @ self.scene.pose_link


Value = TypeVar("Value")


class VisualProperty(MutableMapping[str, Value], abc.ABC):
    """Values by scoped name; they may change at any time.

    A visual has its own value, else that of the innermost entity around it. A removed model takes its values with it;
    snapshots and reset restore them.

    Attributes:
        entity_kinds: kinds of entities that may have a value, besides visuals.
        read_by: attribute of the sensors that measure the value; their pending samples are measured before a change.
        state: all values. The mapping is replaced, never written to, so that readers can detect a change.
    """

    entity_kinds: ClassVar[tuple[str, ...]] = ("model",)
    read_by: ClassVar[str] = ""

    def __init__(self, handles: EntityHandles) -> None:
        self._handles = handles
        self.state: Mapping[str, Value] = MappingProxyType({})

    @abc.abstractmethod
    def checked(self, value: Value) -> Value:
        """Return the value as it is stored; raise ValueError if it is invalid."""

    def __getitem__(self, scoped: str) -> Value:
        return self.state[scoped]

    def __setitem__(self, scoped: str, value: Value) -> None:
        """Set a value; a KeyError suggests the closest name, a ValueError reports an invalid value."""
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
        """Return the values of all visuals that have one, by scoped name, in document order.

        Args:
            nested: apply a model's value to the models in it too.
        """
        values: dict[str, Value] = {}
        for model in self._handles.engine.structure.models.values() if self.state else ():
            self._collect(model, None, nested, values)
        return values

    def _collect(self, model: SceneModel, outer: Value | None, nested: bool, values: dict[str, Value]) -> None:
        state = self.state
        of_model = state.get(model.scoped, outer)
        for link in model.links:
            of_link = state.get(link.scoped, of_model)
            for visual in link.visuals:
                value = state.get(visual.scoped, of_link)
                if value is not None:
                    values[visual.scoped] = value
        for inner in model.models:
            self._collect(inner, of_model if nested else None, nested, values)

    # ------------------------------------------------------------------ called by the simulation

    def bind(self, structure: WorldStructure) -> None:
        """Drop the values of removed models."""
        remaining = {k: v for k, v in self.state.items() if k.split("::", 1)[0] in structure.models}
        if len(remaining) != len(self.state):
            self.state = MappingProxyType(remaining)

    def get_state(self) -> Mapping[str, Value]:
        return self.state

    def set_state(self, state: Mapping[str, Value]) -> None:
        self.state = state

    # ------------------------------------------------------------------ internals

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
        """Replace the values after the pending samples of sensors have been measured with the old ones."""
        cameras: list[Any] = [
            s for s in self._handles.engine.structure.all_sensors() if getattr(s, self.read_by, False)
        ]
        for camera in cameras:
            camera.finish_samples()
        self.state = MappingProxyType(values)


MAX_LABEL: Final = 255


class Labels(VisualProperty[int]):
    """Labels by scoped name of a model or a visual; they may change at any time.

        sim.contents.labels["shelf"] = 40                    # the model and all that is in it
        sim.contents.labels["shelf::base::handle"] = 41      # one visual
        del sim.contents.labels["shelf"]

    A visual has its own label, else that of the innermost model around it. A removed model takes its labels with it;
    snapshots and reset restore them.
    """

    read_by = "reads_labels"

    def checked(self, value: int) -> int:
        number = int(value)
        if number != value or not 0 <= number <= MAX_LABEL:
            raise ValueError(f"a label is a whole number from 0 to {MAX_LABEL}, got {value}")
        return number


@dataclass(frozen=True, slots=True)
class HeatSignature:
    """Image on a surface, placed by texture coordinates. The red channel gives the temperature.

    Attributes:
        coldest: temperature at red 0 [K].
        hottest: temperature at full red [K].
    """

    picture: Path
    coldest: float
    hottest: float


Temperature = float | HeatSignature


class Temperatures(VisualProperty[Temperature]):
    """Temperature [K] or heat signature by scoped name of a model, a link or a visual; may change at any time.

        sim.contents.temperatures["stove::base::plate"] = 450.0     # one visual
        sim.contents.temperatures["stove"] = 310.0                  # all visuals without their own

    A visual has its own temperature, else that of its link, else that of the innermost model around it. A removed model
    takes its temperatures with it; snapshots and reset restore them.
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
