"""Labelled objects of a world, and which geom belongs to which of them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit.compiler.name_map import NameMap
from simkit.runtime import Simulation
from simkit.runtime.engine.entity_structure import WorldStructure

Numbers = npt.NDArray[np.int32]

UNLABELLED: Final = -1
_GAZEBOS_BACKGROUND: Final = 255


@dataclass(frozen=True, slots=True)
class DrawnVisual:
    """A visual with what draws it.

    Attributes:
        scoped: its name.
        link: scoped name of its link.
        model: name of its top-level model.
        geoms: ids of the engine's geoms.
        label: that it wears; UNLABELLED where it wears none.
    """

    scoped: str
    link: str
    model: str
    geoms: tuple[int, ...]
    label: int


@dataclass(frozen=True, slots=True, eq=False)
class LabelledObject:
    """All that wears one label in a top-level model.

    Attributes:
        model: name of the top-level model.
        label: of all of it.
        instance: counts the items of that label from 1.
        visuals: in document order.
    """

    model: str
    label: int
    instance: int
    visuals: tuple[DrawnVisual, ...]


@dataclass(frozen=True, slots=True, eq=False)
class LabelledObjects:
    """The items of a world. Tables have one row for each geom and a last one for what is no geom, number -1.

    Attributes:
        items: in the order of their instances: by model name, from the last in the alphabet to the first, as Gazebo.
        label_of: the label of each geom, UNLABELLED for none.
        instance_of: the instance of each geom, 0 where it wears no label.
        item_of: the position in `items` of what each geom belongs to, -1 for none.
    """

    items: tuple[LabelledObject, ...]
    label_of: Numbers
    instance_of: Numbers
    item_of: Numbers


def find_labelled_objects(sim: Simulation, boxed: bool = False) -> LabelledObjects:
    """The items of a simulation as it is now.

    Args:
        boxed: whether boxes are put around them. Gazebo then makes one item of all that wears a label in a top-level
            model, whichever, and takes the label 255 for the background.
    """
    quirks = bool(sim.world.gazebo_quirks)
    labels = sim.contents.labels.by_visual(nested=not quirks)
    if quirks and boxed:
        labels = {scoped: label for scoped, label in labels.items() if label != _GAZEBOS_BACKGROUND}
    visuals = list(_drawn_visuals(sim.engine.structure, labels))
    size = int(sim.engine.structure.compiled.model.ngeom) + 1
    label_of, instance_of, item_of = np.full(size, UNLABELLED, np.int32), np.zeros(size, np.int32), np.full(size, -1)
    items = _group_visuals(visuals, quirks and boxed)
    for position, item in enumerate(items):
        for visual in item.visuals:
            geoms = list(visual.geoms)
            label_of[geoms], instance_of[geoms], item_of[geoms] = item.label, item.instance, position
    if quirks and not boxed:
        for visual, count in _count_instances_as_gazebo(visuals):
            instance_of[list(visual.geoms)] = count if visual.label > 0 else 0
    return LabelledObjects(tuple(items), label_of, instance_of, item_of.astype(np.int32))


def _drawn_visuals(structure: WorldStructure, labels: dict[str, int]) -> Iterator[DrawnVisual]:
    """Every visual that is drawn, in document order."""
    names: NameMap = structure.compiled.names
    for model in structure.models.values():
        for link in model.all_links():
            drawn = names.drawn(link.scoped)
            for visual in link.visuals:
                geoms = drawn.get(visual.scoped, ())
                if geoms:
                    label = labels.get(visual.scoped, UNLABELLED)
                    yield DrawnVisual(visual.scoped, link.scoped, model.name, geoms, label)


def _gazebo_name_order(name: str) -> bytes:
    # as gz's names continue, so that `cup` comes before `cup_2` there or after it
    return f"{name}::".encode()


def _group_visuals(visuals: list[DrawnVisual], is_merged: bool) -> list[LabelledObject]:
    groups: dict[tuple[str, int], list[DrawnVisual]] = {}
    firsts: dict[str, int] = {}
    for visual in visuals:
        if visual.label != UNLABELLED:
            label = firsts.setdefault(visual.model, visual.label) if is_merged else visual.label
            groups.setdefault((visual.model, label), []).append(visual)
    counts: dict[int, int] = {}
    items = []
    for model, label in sorted(groups, key=lambda key: (_gazebo_name_order(key[0]), -key[1]), reverse=True):
        counts[label] = counts.get(label, 0) + 1
        items.append(LabelledObject(model, label, counts[label], tuple(groups[model, label])))
    return items


def _count_instances_as_gazebo(visuals: list[DrawnVisual]) -> Iterator[tuple[DrawnVisual, int]]:
    """gz counts an instance only where the model changes, so a model's second label shares a number or has 0.

    It goes through all visuals by name, from the last to the first (gz-rendering, Ogre2SegmentationMaterialSwitcher).
    """
    counts: dict[int, int] = {}
    before = ""
    for visual in sorted(visuals, key=lambda v: v.scoped.encode(), reverse=True):
        label = max(visual.label, 0)
        counts.setdefault(label, 0)
        if visual.model != before:
            counts[label] += 1
            before = visual.model
        yield visual, counts[label]
