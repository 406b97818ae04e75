"""Catalogue of all plugins, with the names, parameters, topics and services of each plugin."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from importlib.metadata import entry_points
from pathlib import Path

from simkit import Params, Plugin
from simkit.diagnostics import closest
from simkit.errors import InputError
from simkit.extend import Diagnostics, Options, block, choice, text, texts
from simkit.packs import is_shipped
from simkit.plugins.discovery.find_plugin_class import find_plugin, plugin_kinds
from simkit.plugins.endpoints import Endpoint
from simkit.plugins.options import Option, option_types_of
from simkit.plugins.plugin_names import ENTRY_POINT_GROUP, normalise
from simkit.runtime.engine.plugin_faults import PLUGIN_ERROR_POLICIES
from simkit.scene import ScenePlugin
from simkit_authoring.plugin_facts import Facts, Parameter, Service, Topic, merged
from simkit_authoring.source_scan import scan, scan_function

_UNKNOWN = "SK-PLUGIN-070"


@dataclass(frozen=True)
class Entry:
    """Plugin class in the catalogue.

    Attributes:
        cls: plugin class.
        names: names that a file may use for the plugin; versions and folders of libraries are left out.
        parents: kinds of entities that the plugin can be attached to: "world", "model", "visual", "sensor" or "any".
        origin: "simkit", the entry point or the file that the class comes from.
    """

    cls: type[Plugin]
    names: tuple[str, ...]
    parents: tuple[str, ...]
    origin: str

    @property
    def summary(self) -> str:
        """First paragraph of the class docstring."""
        paragraph = (inspect.getdoc(self.code) or "").split("\n\n")[0]
        return " ".join(paragraph.split())

    @property
    def source(self) -> str:
        """File and line of the class; empty if Python cannot find the source."""
        try:
            file, (_, line) = inspect.getsourcefile(self.code), inspect.getsourcelines(self.code)
        except (OSError, TypeError):
            return ""
        return f"{file}:{max(1, line)}"

    @property
    def code(self) -> type:
        """Object that the author wrote: the plugin class itself, or the gz system that the class wraps."""
        return getattr(self.cls, "wrapped_system", None) or self.cls


def spellings(name: str) -> tuple[str, ...]:
    """Return the names that a file may use for a plugin: also with Ignition's prefix, and with `lib` and `.so`."""
    plain = normalise(name)
    if "::" in plain:
        return tuple(dict.fromkeys((plain, plain.replace("gz::sim::", "ignition::gazebo::", 1))))
    if name.endswith(".py") or ":" in name:
        return (name,)
    stems = [plain, plain.replace("gz-sim", "ignition-gazebo", 1)] if plain.startswith("gz-sim") else [plain]
    return tuple(dict.fromkeys(spelled for stem in stems for spelled in (stem, f"lib{stem}.so")))


def entry_of(cls: type[Plugin], more: Iterable[str] = ()) -> Entry:
    """Return the catalogue entry of a class without a scan of its source.

    Args:
        cls: plugin class.
        more: further names of the plugin.
    """
    kinds = (cls.parent_kind,) if isinstance(cls.parent_kind, str) else cls.parent_kind
    names = dict.fromkeys(s for name in (*more, *cls.filenames, *cls.names) for s in spellings(name))
    return Entry(cls, tuple(names), tuple(kinds), _origin(cls))


def known_plugins(plugin_paths: Sequence[Path] = (), problems: Diagnostics | None = None) -> list[Entry]:
    """Return every plugin that a file can use, sorted by the first name of each.

    Args:
        plugin_paths: folders whose modules the user allows; these modules are imported.
        problems: receives the errors of modules that cannot be imported.
    """
    classes: dict[type[Plugin], list[str]] = {cls: [] for cls in plugin_kinds().values()}
    for point in entry_points(group=ENTRY_POINT_GROUP):
        for cls, names in classes.items():
            if f"{cls.__module__}:{cls.__qualname__}" == point.value.replace(" ", ""):
                names.append(point.value)
    entries = [entry_of(cls, names) for cls, names in classes.items()]
    for folder in plugin_paths:
        for file in sorted(folder.glob("*.py")):
            cls_of_file = _find_class(file.name, "", (folder,), problems if problems is not None else Diagnostics())
            if cls_of_file is not None:
                entries.append(entry_of(cls_of_file, (file.name, f"{file.stem}:{cls_of_file.__name__}")))
    return sorted(entries, key=lambda e: (e.names or (e.cls.__name__,))[0].casefold())


def find_entry(name: str, plugin_paths: Sequence[Path] = ()) -> Entry:
    """Return the catalogue entry of a plugin.

    Args:
        name: name of the plugin in any spelling, name of its class, `module:Class` or a Python file.
        plugin_paths: folders whose modules the user allows; these modules are imported.

    Raises:
        InputError: SK-PLUGIN-070 no plugin has this name; the message suggests the closest name.
    """
    by_class = {cls.__name__: cls for cls in plugin_kinds().values()}
    diagnostics = Diagnostics()
    plugin_class = by_class.get(name) or _find_class(name, name, plugin_paths, diagnostics)
    diagnostics.raise_if_errors()
    if plugin_class is not None:
        return entry_of(plugin_class, (name,) if name.endswith(".py") or ":" in name.replace("::", "") else ())
    if name.endswith(".py") and Path(name).is_file():
        hint = f"allow its folder with --plugin-path {Path(name).parent}, and give only the file name"
    else:
        near = closest(normalise(name), [*plugin_kinds(), *by_class])
        hint = f"did you mean {near!r}?" if near else "simkit plugin list shows all plugins"
    raise InputError(_UNKNOWN, f"there is no plugin {name!r}; {hint}")


def _find_class(filename: str, name: str, plugin_paths: Sequence[Path], problems: Diagnostics) -> type[Plugin] | None:
    """Return the plugin class for a library, file or class name; errors in the plugin's file go to `problems`."""
    diagnostics = Diagnostics()
    cls = find_plugin(ScenePlugin(name, filename, "anything", Params("plugin")), plugin_paths, diagnostics)
    problems.extend(d for d in diagnostics if d.severity == "error")
    return cls


def _origin(cls: type[Plugin]) -> str:
    if is_shipped(cls):
        return "simkit"
    if cls.__module__.split(".")[0] == "simkit_user_plugins":
        return str(inspect.getsourcefile(getattr(cls, "wrapped_system", None) or cls))
    return f"entry point, module {cls.__module__}"


@functools.cache
def facts_of(cls: type[Plugin]) -> Facts:
    """Return the parameters, topics and services of a plugin, from its declared options and from its source.

    The plugin does not run; only its module has been imported.

    Args:
        cls: plugin class.
    """
    gz_system = getattr(cls, "wrapped_system", None)
    if gz_system is not None:
        return (
            scan(gz_system, "model")
            if inspect.isclass(gz_system)
            else scan_function(getattr(gz_system, "configure", None))
        )
    kinds = getattr(cls, "parent_kind", "any")
    facts = scan(cls, kinds if isinstance(kinds, str) and kinds != "any" else "model")
    declared = [p for options in option_types_of(cls) for p in _declared(options)]
    # if a helper function reads a block, the scan finds the parameters without the name of the block
    known = {name for p in declared for name in (p.name, p.path[-1])}
    both = merged([*declared, *(p for p in facts.parameters if p.name not in known)])
    common = {p.path[0] for p in common_facts().parameters}
    facts = replace(facts, parameters=tuple(p for p in both if p.path[0] not in common))
    return (
        facts if not cls.endpoints else replace(facts, topics=_topics(cls.endpoints), services=_services(cls.endpoints))
    )


def _topics(endpoints: Iterable[Endpoint]) -> tuple[Topic, ...]:
    topics = (e for e in endpoints if e.role in ("publishes", "listens"))
    return tuple(Topic(e.name, e.types, e.role == "publishes", False, e.named_by) for e in topics)


def _services(endpoints: Iterable[Endpoint]) -> tuple[Service, ...]:
    services = (e for e in endpoints if e.role in ("offers", "acts"))
    return tuple(Service(e.name, e.types[0], e.named_by, e.role == "acts") for e in services)


def _declared(options: type[Options], above: tuple[str, ...] = ()) -> Iterator[Parameter]:
    """Yield the parameters of a class of options, including those in nested blocks."""
    fields = options.fields()
    for option in fields.values():
        inside, path = option.options is not None, (*above, option.element)
        parameter = Parameter(
            path,
            option.kind,
            None if option.required or inside or option.kind == "pose" else _default(option, fields),
            (fields[option.instead].element,) if option.instead else (),
            option.required,
            option.minimum,
            option.maximum,
            option.choices,
            option.size,
            option.repeated,
            option.is_live,
            option.description,
            option.unit,
        )
        yield parameter
        if option.ros_1:
            yield replace(parameter, path=(*above, option.ros_1), instead=())
        if option.options is not None:
            yield from _declared(option.options, path)


def _default(option: Option, fields: Mapping[str, Option]) -> object:
    """Return the default to show; a field with `instead` has the default of the field that `instead` names."""
    while option.instead:
        option = fields[option.instead]
    return option.default


class _RosOptions(Options):
    """Options in the `<ros>` block."""

    namespace: str = text()
    remapping: tuple[str, ...] = texts()
    argument: tuple[str, ...] = texts()


class _CommonOptions(Options):
    """Options of every plugin: names as in a ROS node, and the error policy."""

    robot_namespace: str = text(element="robotNamespace")
    ros: _RosOptions = block(_RosOptions)
    on_error: str = choice(PLUGIN_ERROR_POLICIES)


@functools.cache
def common_facts() -> Facts:
    """Return the parameters that every plugin accepts: names as in a ROS node, and the error policy."""
    return Facts(tuple(_declared(_CommonOptions)))
