"""Descriptions of new plugins, from which `plugin_skeleton` writes the source.

A description comes from a name, or from a world with a library for which no plugin exists. The type of an element is
inferred from its text: number, vector, pose, boolean or text.
"""

from __future__ import annotations

import keyword
import re
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from simkit import Params
from simkit.errors import InputError
from simkit.extend import Diagnostics, Scene, SceneJoint, SceneLink, SceneModel, did_you_mean
from simkit.plugins.base import ParentKind
from simkit.plugins.discovery.find_plugin_class import find_plugin, plugin_kinds
from simkit.plugins.plugin_names import normalise
from simkit.plugins.ros_names import RosNames
from simkit.scene import ScenePlugin

PARENTS: tuple[ParentKind, ...] = ("world", "model", "visual", "sensor")
_CLASS = re.compile(r"^(?P<module>[A-Za-z_][\w.]*):(?P<name>[A-Za-z_]\w*)$")
_BAD = "SK-PLUGIN-073"


@dataclass(frozen=True)
class NewPlugin:
    """Description of a plugin to be generated.

    Attributes:
        module: path of the new file without suffix, with dots between the folders.
        class_name: name of the new class.
        filename: library name in the world.
        gz_names: gz class names in the world.
        parent: kind of entity that the plugin is attached to.
        elements: parameters of the plugin.
        plugins: occurrences of the plugin in the world, in document order.
        sensor: type of the sensor that a sensor plugin is attached to.
    """

    module: str
    class_name: str
    filename: str
    parent: ParentKind
    gz_names: tuple[str, ...] = ()
    elements: tuple[Element, ...] = ()
    plugins: tuple[ScenePlugin, ...] = ()
    sensor: str = "imu"


def plugin_named(name: str, parent: str) -> NewPlugin:
    """Describe a new plugin without parameters.

    Args:
        name: name such as `wheel_brake`, `WheelBrake` or `libwheel_brake.so`.
        parent: kind of entity that the plugin is attached to.

    Raises:
        InputError: SK-PLUGIN-073 the name cannot become a Python name, simkit already has a plugin with this name, or
            the kind of parent is unknown.
    """
    if parent not in PARENTS:
        hint = did_you_mean(parent, PARENTS)
        text = f"--on: found {parent!r}; expected {', '.join(PARENTS)}"
        raise InputError(_BAD, text + (f"; {hint}" if hint else ""))
    if normalise(name) in plugin_kinds():
        raise InputError(_BAD, f"simkit already has a plugin {name!r}; see: simkit plugin info {name}")
    module, class_name = _python_names(name)
    filename = name if name.endswith(".so") else f"lib{module}.so"
    kind: ParentKind = next(kind for kind in PARENTS if kind == parent)
    sample = Params.from_dict({"gain": 1.0})
    return NewPlugin(module, class_name, filename, kind, elements=elements_of([sample]))


def plugins_missing_in(scene: Scene, plugin_paths: Sequence[Path] = ()) -> list[NewPlugin]:
    """Describe a new plugin for each library for which no plugin exists, with the parameters from the file.

    Args:
        scene: content of the file.
        plugin_paths: folders with plugins that the user already has.
    """
    uses_by_library: dict[str, list[tuple[ScenePlugin, ParentKind, str]]] = {}
    for plugin, parent, sensor in _plugins_of_scene(scene):
        if _is_unmapped(plugin, plugin_paths):
            key = normalise(plugin.filename) or normalise(plugin.name)
            uses_by_library.setdefault(key, []).append((plugin, parent, sensor))
    used_modules: set[str] = set()
    return [_new_plugin_of_uses(uses, used_modules) for uses in uses_by_library.values()]


def _new_plugin_of_uses(uses: Sequence[tuple[ScenePlugin, ParentKind, str]], used_modules: set[str]) -> NewPlugin:
    plugins = tuple(plugin for plugin, _, _ in uses)
    first, parent, sensor = uses[0]
    as_class = _CLASS.match(first.filename)
    if as_class:
        module, class_name = as_class["module"], as_class["name"]
    elif first.filename.endswith(".py"):
        module = first.filename.removesuffix(".py").replace("/", ".")
        class_name = first.name if first.name.isidentifier() else _python_names(module)[1]
    else:
        of_gz = next((p.name for p in plugins if "::" in p.name), "")
        module, class_name = _python_names(of_gz or first.filename or first.name)
    base, count = module, 1
    while module in used_modules:
        count += 1
        module = f"{base}_{count}"
    used_modules.add(module)
    gz_names = tuple(dict.fromkeys(p.name for p in plugins if "::" in p.name))
    blocks = [p.params for p in plugins]
    names = _common_elements(blocks)
    return NewPlugin(module, class_name, first.filename, parent, gz_names, elements_of(blocks, names), plugins, sensor)


def _common_elements(blocks: Sequence[Params]) -> frozenset[str]:
    """Return the elements that every plugin accepts for its ROS names: `<ros>` and `<robotNamespace>`."""
    names_read: set[str] = set()
    for block in blocks:
        copy = block.copied()
        copy.diagnostics = Diagnostics()
        RosNames.from_params(copy, "plugin")
        names_read |= copy.asked
    return frozenset(names_read)


def _is_unmapped(plugin: ScenePlugin, plugin_paths: Sequence[Path]) -> bool:
    diagnostics = Diagnostics()
    return find_plugin(plugin, plugin_paths, diagnostics, "any") is None and {"SK-PLUGIN-001", "SK-PLUGIN-002"} >= {
        d.code for d in diagnostics
    }


def _plugins_of_scene(scene: Scene) -> Iterator[tuple[ScenePlugin, ParentKind, str]]:
    """Yield every plugin, the kind of its parent, and the type of the parent if the parent is a sensor."""
    models = [scene.model] if scene.model else []
    for world in scene.worlds:
        for plugin in world.plugins:
            yield plugin, "world", ""
        models += world.models
    for model in models:
        yield from _plugins_of_model(model)


def _plugins_of_model(model: SceneModel) -> Iterator[tuple[ScenePlugin, ParentKind, str]]:
    for sensor in model.all_sensors():
        for plugin in sensor.plugins:
            yield plugin, "sensor", sensor.kind
    for nested in model.all_models():
        owners: list[SceneLink | SceneJoint] = [*nested.links, *nested.joints]
        below = [p for owner in owners for p in owner.plugins]
        for plugin in (*below, *nested.plugins):
            yield plugin, "model", ""
    for link in model.all_links():
        for visual in link.visuals:
            for plugin in visual.plugins:
                yield plugin, "visual", ""


def _python_names(name: str) -> tuple[str, str]:
    """Return the names of the module and the class for a library: my_thing and MyThing for `libMyThing.so`.

    Raises:
        InputError: SK-PLUGIN-073 the name cannot become a Python name.
    """
    stem = normalise(name).rsplit("::", 1)[-1].removeprefix("gz-sim-")
    words = re.findall(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+", re.sub(r"[^A-Za-z0-9]+", " ", stem))
    module = "_".join(word.lower() for word in words)
    class_name = "".join(word[0].upper() + word[1:] for word in words)
    if module and module[0].isdigit():
        module, class_name = f"plugin_{module}", f"Plugin{class_name}"
    if module in sys.stdlib_module_names or keyword.iskeyword(module):
        module, class_name = f"{module}_plugin", f"{class_name}Plugin"
    if not module.isidentifier():
        allowed = "expected names such as wheel_brake, WheelBrake or libwheel_brake.so"
        raise InputError(_BAD, f"{name!r} cannot become a Python name; {allowed}")
    return module, class_name


_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?|[+-]?(inf|infinity)", re.IGNORECASE)
_TRUTHS = {"true", "false"}
_POSES = ("pose", "offset", "origin", "transform")


@dataclass(frozen=True)
class Element:
    """Parameter of a new plugin, inferred from all elements with this name.

    Attributes:
        name: name of the element; the name of an attribute begins with `@`.
        kind: "boolean", "number", "vector", "pose", "text" or "block".
        values: texts of the elements, in document order.
        size: number of values in a vector.
        repeated: whether one plugin contains several elements with this name.
        children: parameters in a block.
    """

    name: str
    kind: str
    values: tuple[str, ...] = ()
    size: int = 1
    repeated: bool = False
    children: tuple[Element, ...] = field(default=())

    @property
    def depth(self) -> int:
        """Nesting depth of blocks; 0 for a value."""
        return 1 + max((c.depth for c in self.children), default=0) if self.kind == "block" else 0


def elements_of(blocks: Sequence[Params], leave_out: frozenset[str] = frozenset()) -> tuple[Element, ...]:
    """Return the parameters of a new plugin, in the order of their first occurrence.

    Args:
        blocks: `<plugin>` elements that use the library.
        leave_out: names of elements to skip.
    """
    names = dict.fromkeys(c.name for block in blocks for c in block.children)
    selected = [name for name in names if ":" not in name and name not in leave_out]
    return tuple(_element(name, [[c for c in b.children if c.name == name] for b in blocks]) for name in selected)


def _element(name: str, by_plugin: Sequence[Sequence[Params]]) -> Element:
    occurrences = [element for elements in by_plugin for element in elements]
    repeated = any(len(elements) > 1 for elements in by_plugin)
    attributes = dict.fromkeys(a for e in occurrences for a in e.attributes)
    children = elements_of(occurrences)
    if children or (attributes and any(":" not in a for a in attributes)):
        texts = tuple(e.value for e in occurrences if e.value)
        of_attributes = tuple(
            _of_texts(f"@{a}", [e.attributes[a] for e in occurrences if a in e.attributes]) for a in attributes
        )
        return Element(name, "block", texts, repeated=repeated, children=of_attributes + children)
    return _of_texts(name, [e.value for e in occurrences], repeated)


def _of_texts(name: str, texts: Sequence[str], repeated: bool = False) -> Element:
    values = tuple(text.strip() for text in texts)
    words = [value.split() for value in values]
    if all(value.lower() in {*_TRUTHS, "0", "1"} for value in values) and _TRUTHS & {v.lower() for v in values}:
        return Element(name, "boolean", values, repeated=repeated)
    sizes = {len(w) for w in words}
    if len(sizes) == 1 and 0 not in sizes and all(_NUMBER.fullmatch(n) for w in words for n in w):
        size = sizes.pop()
        endless = any("inf" in n.lower() for w in words for n in w)
        if size == 1:
            return Element(name, "number", values, repeated=repeated)
        if size == 6 and not endless and any(word in name.lower() for word in _POSES):
            return Element(name, "pose", values, size, repeated)
        if not endless:
            return Element(name, "vector", values, size, repeated)
    return Element(name, "text", values, repeated=repeated)
