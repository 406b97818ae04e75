"""Run parts: options of `simkit run` with what they do, one file each in a folder `cli/run_parts`.

The core and packs have such folders. A file is found by its folder, and imported when a command needs its options.
"""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, field
from functools import cache
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, ClassVar, get_args

import typer

from simkit.cli.run_options import Command, replace_parameter
from simkit.errors import SimkitError
from simkit.packs import fault_text, foreign_pack_of, installed_packs, is_shipped, warn_of_pack

if TYPE_CHECKING:
    from simkit.bridges.bridge_process import BridgeProcess
    from simkit.cli.run_loop import Interrupts, RunLoop
    from simkit.cli.run_verdict import RunVerdict
    from simkit.run_nodes import Node
    from simkit.run_spec import RunSpec
    from simkit.runtime import Simulation


@dataclass
class OpenRun:
    """Run of a loaded world, before and during its loop.

    Attributes:
        spec: run specification.
        sim: loaded simulation.
        loop: loop of the run, which has lists of callbacks.
        interrupts: Ctrl-C handler.
        advance: function that advances the run by a simulated time [s], or for ever if it is None.
        progress_lines: function that returns the lines of the progress display; None to show the topics.
        status_lines: lines that stay at the top of the progress display; on other outputs, they are printed once, last.
    """

    spec: RunSpec
    sim: Simulation
    loop: RunLoop
    interrupts: Interrupts
    advance: Callable[[float | None], object]
    progress_lines: Callable[[], Sequence[str]] | None = None
    status_lines: list[str] = field(default_factory=list)

    def start_bridge(self, bridge: BridgeProcess) -> None:
        """Start a bridge and serve it until everything is open, so that it receives the first messages.

        Raises:
            InputError: the bridge cannot start.
        """
        server = self.loop.server
        if server is None:
            raise bridge.start_error("it needs local sockets, which this system lacks")
        bridge.start(server.path, server.poll, lambda: bool(self.interrupts.exit_code))
        self.loop.watchers.append(bridge.check)


class RunPart:
    """Part of a run on the command line.

    A derived class is a dataclass. Its fields are the options, in the style of Typer and with defaults:
    `junit: Annotated[Path | None, option("JUnit XML report to write.", "FILE.xml")] = None`. Fields with `init=False`
    are no options. `__post_init__` checks the values. With the defaults, a part does nothing.

    Attributes:
        place: place of the options in the help, and of the part among the others; lower places come first.
    """

    place: ClassVar[int] = 100

    @classmethod
    def complete_words(cls, words: list[str]) -> list[str]:
        """Return the words of a command line, with what the user may leave out; see `fill_in_value`."""
        return words

    @property
    def is_watched(self) -> bool:
        """True if somebody watches the run, which then has at most the speed of real time."""
        return False

    @property
    def adds_nodes(self) -> bool:
        """True if the part adds nodes to the run."""
        return False

    def extended(self, spec: RunSpec) -> RunSpec:
        """Return the run with the models and files that the part adds to it; called before `around_run`.

        Raises:
            InputError: the run cannot do what the options request.
        """
        return spec

    def added_nodes(self, spec: RunSpec, sim: Simulation) -> Sequence[Node]:
        """Return the nodes that the part adds to the run of a loaded world."""
        return ()

    def around_run(self, spec: RunSpec, verdict: RunVerdict) -> AbstractContextManager[object]:
        """Return a context manager around loading and running; its start checks what the run will need.

        Args:
            spec: run specification.
            verdict: verdict on the run, which gets its results during the run.

        Raises:
            InputError: the run cannot do what the options request.
        """
        return nullcontext()

    def after_loading(self, sim: Simulation) -> None:
        """Prepare the part for a loaded simulation, before anything of the run is opened."""

    def around_loop(self, run: OpenRun) -> AbstractContextManager[object]:
        """Return a context manager around the loop of the run; its start adds callbacks to the loop."""
        return nullcontext()


def fill_in_value(words: Sequence[str], name: str, value: str, is_value: Callable[[str], object]) -> list[str]:
    """Complete an option that works with or without a value.

    Args:
        words: words of a command line.
        name: name of the option.
        value: value of an option without one.
        is_value: function that checks whether the word after the option is its value.
    """
    completed: list[str] = []
    for index, word in enumerate(words):
        if word == "--":
            return [*completed, *words[index:]]
        following = words[index + 1] if index + 1 < len(words) else ""
        completed.append(f"{name}={value}" if word == name and not is_value(following) else word)
    return completed


@cache
def part_classes() -> tuple[type[RunPart], ...]:
    """Return the classes of all parts, in the order of their places.

    A part of a pack of others that cannot be used causes a warning and is left out.
    """
    classes: list[type[RunPart]] = []
    for pack in (None, *installed_packs()):
        package, folder = ("simkit", Path(__file__).parents[1]) if pack is None else (pack.package, Path(pack.folder))
        for file in sorted((folder / "cli" / "run_parts").glob("[a-z]*.py")):
            module_name = f"{package}.cli.run_parts.{file.stem}"
            if pack is None or pack.is_shipped:
                classes += _parts_of(import_module(module_name))
                continue
            try:
                parts = _parts_of(import_module(module_name))
            except (Exception, SystemExit) as error:  # noqa: BLE001 - code of others may raise anything
                warn_of_pack(package, f"a run part cannot be imported: {fault_text(error, pack.folder)}")
                continue
            for cls in parts:
                if fault := _fault_of_options(cls):
                    warn_of_pack(package, fault)
                else:
                    classes.append(cls)
    return tuple(sorted(classes, key=lambda cls: cls.place))


def _parts_of(module: ModuleType) -> list[type[RunPart]]:
    """Return the classes of the parts that a module defines."""
    classes = (cls for cls in vars(module).values() if isinstance(cls, type) and cls.__module__ == module.__name__)
    return [cls for cls in classes if issubclass(cls, RunPart)]


def _fault_of_options(cls: type[RunPart]) -> str:
    """Return place and fault of the options of a part in a pack of others; empty if there is none."""
    fields = {name: text for name, text in vars(cls).get("__annotations__", {}).items() if "ClassVar" not in str(text)}
    if fields and "__dataclass_fields__" not in vars(cls):
        return f"{_place_of(cls)}: run part {cls.__name__} has options, but is not a dataclass; write @dataclass above"
    place: object = cls.place
    if not isinstance(place, int):
        return f"{_place_of(cls)}: run part {cls.__name__}: found place {place!r:.80}; expected a whole number"
    namespace = vars(sys.modules[cls.__module__])
    for name, annotation in fields.items():
        option = f"{_place_of(cls, name)}: option {name!r} of run part {cls.__name__}"
        try:
            parameter = inspect.signature(cls).parameters.get(name)
            if parameter is None:  # a field with `init=False`
                continue
            kind = eval(annotation, namespace) if isinstance(annotation, str) else annotation
            if parameter.default is inspect.Parameter.empty:
                return f"{option} needs a default value"
            _check_option(parameter.replace(annotation=kind))
        except Exception as error:  # noqa: BLE001 - as above
            return f"{option}: {type(error).__name__}: {error}"
    try:
        _options(cls)  # with the fields of base classes
    except Exception as error:  # noqa: BLE001 - as above
        return f"{_place_of(cls)}: run part {cls.__name__}: {type(error).__name__}: {error}"
    return ""


def _check_option(parameter: inspect.Parameter) -> None:
    """Check that Typer can make an option.

    Raises:
        Exception: it cannot, for example because it has no conversion to the type.
    """

    def command(option: object) -> None:
        """Command with the option alone."""

    app = typer.Typer()
    app.command()(replace_parameter(command, "option", [parameter], lambda values: values))
    typer.main.get_command(app)


def _place_of(cls: type, field: str = "class ") -> str:
    """Return file and line of a class or of one of its fields."""
    lines, first = inspect.getsourcelines(cls)
    line = next((number for number, text in enumerate(lines, first) if text.strip().startswith(field)), first)
    return f"{inspect.getsourcefile(cls)}:{line}"


def complete_words(words: list[str]) -> list[str]:
    """Return the words of a command line, completed by all parts; a part of a pack of others that fails is left out."""
    for cls in part_classes():
        try:
            words = cls.complete_words(words)
        except Exception as error:
            pack = foreign_pack_of(error)
            if pack is None:
                raise
            warn_of_pack(pack.package, fault_text(error, pack.folder))
    return words


def run_parts(**values: object) -> tuple[RunPart, ...]:
    """Return all parts, with values for some of their options and the defaults of all others."""
    return tuple(_parts(part_classes(), values))


def _parts(classes: Iterable[type[RunPart]], values: Mapping[str, Any]) -> Iterator[RunPart]:
    """Yield the parts of some classes. A part of a pack of others that fails without a value of its own is left out."""
    for cls in classes:
        options = _options(cls)
        used = {name: values[name] for name in options if name in values}
        try:
            yield cls(**used)
        except Exception as error:
            pack = foreign_pack_of(error)
            is_needed = any(value != options[name].default for name, value in used.items())
            if pack is None or is_needed or isinstance(error, SimkitError):
                raise
            warn_of_pack(pack.package, fault_text(error, pack.folder))


def _options(cls: type[RunPart]) -> dict[str, inspect.Parameter]:
    return dict(inspect.signature(cls, eval_str=True).parameters)


def with_run_parts(command: Command) -> Command:
    """Replace the parameter `parts` of a command by the options of all parts; the command receives the parts."""
    parameters = inspect.signature(command, eval_str=True).parameters
    owners = dict.fromkeys((*parameters, *_names_in_help(parameters)), "the command")
    accepted: dict[type[RunPart], dict[str, inspect.Parameter]] = {}
    for cls in sorted(part_classes(), key=lambda cls: not is_shipped(cls)):  # those of simkit keep their names
        added = _options(cls)
        names = (*_names_in_help(added), *added)
        repeated = next((name for name in names if name in owners), None)
        if repeated is not None:
            text = f"{_place_of(cls)}: run part {cls.__name__}: there is another option {repeated}, of"
            warn_of_pack(cls.__module__.partition(".")[0], f"{text} {owners[repeated]}")
        else:
            owners |= dict.fromkeys(names, cls.__module__)
            accepted[cls] = added
    classes = [cls for cls in part_classes() if cls in accepted]
    options = [option for cls in classes for option in accepted[cls].values()]
    return replace_parameter(command, "parts", options, lambda values: tuple(_parts(classes, values)))


def _names_in_help(parameters: Mapping[str, inspect.Parameter]) -> list[str]:
    """Return the names of options on the command line, such as `--rtf`, in the order of the parameters."""
    names: list[str] = []
    for name, parameter in parameters.items():
        info = next(iter(get_args(parameter.annotation)[1:]), None)
        # in an annotation, the first name is where Typer has a default elsewhere
        declared = [getattr(info, "default", None), *(getattr(info, "param_decls", None) or ())]
        names += [text for text in declared if isinstance(text, str)] or [f"--{name.replace('_', '-')}"]
    return names
