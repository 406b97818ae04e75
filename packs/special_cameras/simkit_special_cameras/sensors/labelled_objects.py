"""Labelled objects of a world, and the geoms that belong to them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from simkit import Simulation
from simkit.compiler import NameMap
from simkit.runtime import WorldStructure

Numbers = npt.NDArray[np.int32]

UNLABELLED: Final = -1
_GAZEBOS_BACKGROUND: Final = 255


@dataclass(frozen=True, slots=True)
class DrawnVisual:
    """Visual with the geoms that draw it.

    Attributes:
        scoped: scoped name.
        link: scoped name of its link.
        model: name of its top-level model.
        geoms: geom ids of the engine.
        label: label of the visual; UNLABELLED for none.
    """

    scoped: str
    link: str
    model: str
    geoms: tuple[int, ...]
    label: int


@dataclass(frozen=True, slots=True, eq=False)
class LabelledObject:
    """All visuals with one label in a top-level model.

    Attributes:
        model: name of the top-level model.
        label: label of the visuals.
        instance: number of the object among those of its label, from 1.
        visuals: visuals in document order.
    """

    model: str
    label: int
    instance: int
    visuals: tuple[DrawnVisual, ...]


@dataclass(frozen=True, slots=True, eq=False)
class LabelledObjects:
    """Labelled objects of a world. Tables have one row per geom and a last row for "no geom", number -1.

    Attributes:
        items: objects in the order of their instances: by model name, in reverse alphabetical order, as in Gazebo.
        label_of: label of each geom, UNLABELLED for none.
        instance_of: instance of each geom, 0 without a label.
        item_of: index in `items` of each geom's object, -1 for none.
    """

    items: tuple[LabelledObject, ...]
    label_of: Numbers
    instance_of: Numbers
    item_of: Numbers


def find_labelled_objects(sim: Simulation, boxed: bool = False) -> LabelledObjects:
    """Return the labelled objects of a simulation in its current state.

    Args:
        sim: simulation.
        boxed: True for bounding boxes. Gazebo then makes one object of all labelled visuals in a top-level model,
            whatever their labels, and treats the label 255 as background.
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
    """Yield every visual that is drawn, in document order."""
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
    # gz continues names with "::", which decides whether `cup` precedes `cup_2`
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
    """Yield visuals with instance counts as gz computes them.

    gz increments the count only when the model changes, so a model's second label shares a number or has 0. gz visits
    all visuals by name in reverse order (gz-rendering, Ogre2SegmentationMaterialSwitcher).
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
