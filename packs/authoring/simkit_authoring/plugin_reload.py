"""Reloading of a plugin after a change of its file, between two steps of a running simulation."""

from __future__ import annotations

import inspect
import linecache
import sys
import traceback
from collections.abc import Callable, Iterable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, replace
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING

from simkit import Diagnostic, Params
from simkit.errors import LoadError, SimkitError
from simkit.extend import Diagnostics, SceneModel, SceneSensor, SceneVisual
from simkit.packs import is_shipped_module
from simkit.plugins.discovery.find_plugin_class import find_plugin
from simkit.plugins.discovery.python_plugins import SceneEntity

if TYPE_CHECKING:
    from simkit import Plugin, Simulation
    from simkit.runtime.engine.entity_structure import AttachedPlugin

_BROKEN, _REFUSED = "SK-PLUGIN-071", "SK-PLUGIN-076"


@dataclass
class _WatchedFile:
    """Watched file, with its modification time, size and content at the last check."""

    path: Path
    stamp: tuple[int, int]
    content: bytes


class PluginReloader:
    """Watcher of plugin files: after a change of a file, it replaces the file's plugins with the new code.

    Each call of `poll` calls `stat` once for each file; there is no thread. Without a change, the run is the same as
    without the watcher.

    Args:
        sim: simulation with the plugins.
        plugin_paths: folders of plugins; other modules that are imported from these folders are watched as well.
        say: function called for each event, with a text of one or several lines.
    """

    def __init__(self, sim: Simulation, plugin_paths: Sequence[Path], say: Callable[[str], None]) -> None:
        self._sim, self._paths, self._say = sim, [p.resolve() for p in plugin_paths], say
        self._files: dict[Path, _WatchedFile] = {}
        self._look_for_files()

    @property
    def files(self) -> list[Path]:
        """Watched files."""
        return sorted(self._files)

    def poll(self) -> bool:
        """Reload the plugins whose file has changed since the last call; return True after a reload."""
        changed = [file for file in self._files.values() if _has_changed(file)]
        if not changed:
            return False
        done = self._reload(changed)
        self._look_for_files()
        return done

    # ------------------------------------------------------------------ files

    def _modules(self) -> dict[Path, list[str]]:
        """Return the names of the modules that the user wrote, by file."""
        names_by_file: dict[Path, list[str]] = {}
        of_plugins = self._of_plugins()
        for name, module in list(sys.modules.items()):
            file = getattr(module, "__file__", None)
            if not file or not file.endswith(".py") or is_shipped_module(name):
                continue
            path = Path(file).resolve()
            if name in of_plugins or any(path.is_relative_to(folder) for folder in self._paths):
                names_by_file.setdefault(path, []).append(name)
        return names_by_file

    def _of_plugins(self) -> set[str]:
        return {name for plugin in self._sim.engine.structure.all_plugins() for name in modules_of(plugin)}

    def _look_for_files(self) -> None:
        for path in self._modules():
            if path not in self._files:
                stamp = _file_stamp(path)
                if stamp is not None:
                    self._files[path] = _WatchedFile(path, stamp, path.read_bytes())

    # ------------------------------------------------------------------ reloading

    def _reload(self, changed: Sequence[_WatchedFile]) -> bool:
        names = self._modules()
        of_plugins = self._of_plugins()
        paths = [file.path for file in changed]
        if any(not of_plugins.intersection(names.get(path, ())) for path in paths):
            # a module that plugins import has changed: reload these plugins as well
            paths += [p for p, modules in names.items() if p not in paths and of_plugins.intersection(modules)]
            paths.sort(key=lambda path: bool(of_plugins.intersection(names.get(path, ()))))
        before = {name: sys.modules[name] for path in paths for name in names.get(path, ())}
        for path in paths:
            for name in names.get(path, ()):
                if not self._import(name, path):
                    sys.modules.update(before)
                    return False
        replaced = [p for p in self._sim.engine.structure.all_plugins() if before.keys() & modules_of(p)]
        done = [self._exchange(plugin, before) for plugin in replaced]
        if not all(done):
            sys.modules.update(before)
        return any(done)

    def _import(self, name: str, path: Path) -> bool:
        """Execute a changed file as a new module with the same name; report the reason if the file has an error."""
        old = sys.modules[name]
        new = ModuleType(name)
        vars(new).update({k: v for k, v in vars(old).items() if k in _MODULE_ATTRIBUTES})
        linecache.checkcache(str(path))
        try:
            watched = self._files.get(path)
            content = path.read_bytes() if watched is None else watched.content
            code = compile(content, str(path), "exec")
            sys.modules[name] = new
            with ExitStack() as contexts:  # the module may import what any of the plugins may import
                for plugin in self._sim.engine.structure.all_plugins():
                    contexts.enter_context(plugin.importing())
                exec(code, vars(new))
        except SyntaxError as error:
            self._say(
                f"{error.filename}:{error.lineno}: error {_BROKEN}: {error.msg}; the run continues with the old code"
            )
        except (Exception, SystemExit) as error:  # noqa: BLE001 - a user's module may raise anything
            what = f"{type(error).__name__}: {error}"
            self._say(f"{_user_file_line(error, path)}: error {_BROKEN}: {what}; the run continues with the old code")
        else:
            return True
        sys.modules[name] = old
        return False

    def _exchange(self, old: AttachedPlugin, before: dict[str, ModuleType]) -> bool:
        """Replace a plugin with an instance of its new class; return false after a report if this is not possible."""
        from simkit.runtime.plugin_replacement import replace_plugin

        sim = self._sim
        file = Path(str(next(before[name].__file__ for name in modules_of(old) if name in before)))
        try:
            problems = Diagnostics()
            new = self._new_instance(old, problems)
            if new is None:
                self._say_all(problems)
                self._say(f"{old.where}: error {_REFUSED}: {old.name!r} is no longer in {file}")
                return False
            replace_plugin(sim, old, new, scene_of(sim, old.scoped))
        except LoadError as error:
            self._say_all(error.diagnostics)
            self._say(f"{old.name!r} is not reloaded; the run continues with the old code")
            return False
        except SimkitError as error:
            cause = error.__cause__
            where = f"{_user_file_line(cause, file)}: " if cause is not None else ""
            self._say(f"{where}error: {error}; the run continues with the old code")
            return False
        except Exception as error:  # noqa: BLE001 - `prepare` of a user's class may raise anything
            what = f"{type(error).__name__}: {error}"
            place = _user_file_line(error, file)
            self._say(f"{place}: error {_REFUSED}: {old.name!r} cannot be reloaded: {what}")
            return False
        new.report_unread()
        self._say_all(d for d in new.params.diagnostics if d.severity == "warning")
        self._say(f"{file.name}: {new.name!r} reloaded at {sim.time:.6g} s")
        return True

    def _new_instance(self, old: AttachedPlugin, diagnostics: Diagnostics) -> Plugin | None:
        """Return an instance of the new class with the old parameters; None if the class no longer exists."""
        new: Plugin | None
        if old.source is None:
            cls: type[Plugin] | None = getattr(sys.modules[type(old).__module__], type(old).__name__, None)
            new = cls(**vars(old).get("_values", {})) if inspect.isclass(cls) else None
            if new is not None:
                new.hand_over(diagnostics, old.scoped)
        else:
            source = replace(old.source, params=with_diagnostics(old.source.params, diagnostics))
            named = find_plugin(source, self._paths, diagnostics, "any")
            new = named() if named is not None else None
            if new is not None:
                new.take_source(source, old.plugin_paths)
        return new

    def _say_all(self, diagnostics: Iterable[Diagnostic]) -> None:
        for diagnostic in diagnostics:
            self._say(str(diagnostic))


_MODULE_ATTRIBUTES = {"__name__", "__file__", "__spec__", "__loader__", "__package__", "__path__", "__cached__"}


def modules_of(plugin: AttachedPlugin) -> set[str]:
    """Return the names of the modules that contain a plugin's code: its class and the system that it runs."""
    objects = plugin.code_objects()
    names = {item.__name__ if isinstance(item, ModuleType) else type(item).__module__ for item in objects}
    return {name for name in names if not is_shipped_module(name) and name.split(".")[0] not in sys.stdlib_module_names}


def _file_stamp(path: Path) -> tuple[int, int] | None:
    """Return the modification time [ns] and size [bytes] of a file; None while the file is missing."""
    try:
        status = path.stat()
    except OSError:
        return None
    return status.st_mtime_ns, status.st_size


def _has_changed(file: _WatchedFile) -> bool:
    """Check whether the content of a file has changed since the last check.

    A missing or empty file and a file that changes while it is read count as unchanged, because an editor may delete or
    empty the file for a moment while it saves. The next check sees the whole file.
    """
    stamp = _file_stamp(file.path)
    if stamp is None or stamp == file.stamp:
        return False
    try:
        content = file.path.read_bytes()
    except OSError:
        return False
    if not content or _file_stamp(file.path) != stamp:
        return False
    file.stamp = stamp
    if content == file.content:
        return False
    file.content = content
    return True


def _user_file_line(error: BaseException | None, path: Path) -> str:
    """Return `file:line` of the innermost frame of an error in this file."""
    frames = traceback.extract_tb(error.__traceback__) if error is not None else []
    in_file = [frame for frame in frames if Path(frame.filename).resolve() == path.resolve()] or frames
    return f"{in_file[-1].filename}:{in_file[-1].lineno}" if in_file else str(path)


def with_diagnostics(params: Params, diagnostics: Diagnostics) -> Params:
    """Return a copy of parameters, all of them unread, which reports problems to `diagnostics`."""
    children = [with_diagnostics(child, diagnostics) for child in params.children]
    return Params(params.name, params.value, params.attributes, children, params.where, diagnostics)


def scene_of(sim: Simulation, scoped: str) -> SceneEntity:
    """Return the scene object with this scoped name: a model, a visual or a sensor; the world if there is none."""
    for top in sim.engine.structure.models.values():
        if scoped != top.scoped and not scoped.startswith(f"{top.scoped}::"):
            continue
        entities: list[SceneModel | SceneSensor | SceneVisual] = [
            *top.all_models(),
            *top.all_sensors(),
            *(v for k in top.all_links() for v in k.visuals),
        ]
        entity_with_name = next((entity for entity in entities if entity.scoped == scoped), None)
        if entity_with_name is not None:
            return entity_with_name
    return sim.world
