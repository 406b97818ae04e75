"""Command-line options of a run: each command takes them from the descriptions of the fields of `RunSpec`."""

from __future__ import annotations

import functools
import inspect
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any, Final, NamedTuple, TypeVar, cast, get_args

import typer

from simkit.cli.terminal import completion
from simkit.cli.terminal.given_interfaces import interface_folders
from simkit.cli.terminal.options import option, validate_word
from simkit.run_fields import CommandOption, LoadArguments, OptionPart, RunField
from simkit.run_files import FileName
from simkit.run_spec import FilePath, LoadOptions, RunSpec, SourceOptions, run_fields
from simkit.run_values import Choice

_Command = TypeVar("_Command", bound=Callable[..., Any])
PARTS: Final = get_args(OptionPart)
_TIME: Final = re.compile(r"(\d+\.?\d*|\.\d+)\s*(s|ms|min|)")
_UNITS: Final = {"": 1.0, "s": 1.0, "ms": 1e-3, "min": 60.0}


def parse_seconds(text: str) -> float:
    """Parse a time: `30`, `30s`, `500ms` or `2min`."""
    match = _TIME.fullmatch(text.strip())
    if match is None or not float(match[1]) > 0:
        raise typer.BadParameter(f"{text!r} is not a time; expected times above 0 such as 30, 30s, 500ms or 2min")
    return float(match[1]) * _UNITS[match[2]]


_PARSERS: Final = {"seconds": parse_seconds}


@dataclass(frozen=True)
class GivenOptions:
    """Options of a run that a command line contains.

    Attributes:
        values: values of the fields by name.
    """

    values: Mapping[str, Any] = field(default_factory=dict)

    def names(self, excluded: Sequence[str] = ()) -> list[str]:
        """Return the names of the options, without those of some fields."""
        fields = run_fields()
        return [one.name for name in self.values if name not in excluded and (one := fields[name].option) is not None]

    def load_options(self) -> LoadOptions:
        """Return the load options, with the folders of `--interfaces`."""
        found = {name: value for name, value in self.values.items() if run_fields()[name].is_load_option}
        folders = interface_folders()
        return cast(LoadOptions, {**found, **({"interfaces": folders} if folders else {})})

    def source_options(self) -> SourceOptions:
        """Return the options for reading a file."""
        names = SourceOptions.__optional_keys__
        return cast(SourceOptions, {name: value for name, value in self.values.items() if name in names})

    def load_arguments(self) -> LoadArguments:
        """Return the arguments of `simkit.load` for a command that loads a world without a run specification."""
        found = {name: value for name, value in self.values.items() if run_fields()[name].is_loaded}
        return cast(LoadArguments, {**found, **self.load_options()})

    def run_spec(self, world: str, **fields: Any) -> RunSpec:
        """Return the specification of a run of a world.

        Args:
            world: world.
            fields: values of other fields, or of fields whose options are not given.
        """
        return self.applied(RunSpec(world, options=self.load_options(), **fields))

    def applied(self, spec: RunSpec) -> RunSpec:
        """Return a specification with the values of all options that are not load options.

        Raises:
            typer.BadParameter: `--timeout` without a condition.
        """
        fields, values = run_fields(), {}
        for name, value in self.values.items():
            described = fields[name]
            if not described.is_load_option:
                moved = value if spec.folder == Path() else described.kind.move(value, name, _from_working_folder)
                values[name] = (*getattr(spec, name), *moved) if described.is_appended else moved
        found = spec.with_values(values)
        if "timeout" in values and not found.until:
            message = "--timeout needs --until; limit the run with --duration S"
            raise typer.BadParameter(message, param_hint="--timeout")
        return found


NONE_GIVEN: Final = GivenOptions()
"""Default of the parameter that `with_run_options` replaces."""


def _from_working_folder(name: FileName) -> str:
    """Return the absolute path of a file that a run would look for in its own folder."""
    path = name.path_in(Path.cwd()) if name.role in ("world", "bag") else None
    return name.text if path is None else str(path)


class OfferedOptions(NamedTuple):
    """Options of a run that a command offers.

    Attributes:
        names: fields of the options.
        without: reason for each field, or part of the fields, that the command does not offer.
    """

    names: tuple[str, ...]
    without: Mapping[str, str]


def with_run_options(
    *names: str, without: Mapping[str, str] | None = None, usual: Mapping[str, str] | None = None
) -> Callable[[_Command], _Command]:
    """Return a decorator that replaces the parameter `given` of a command by options of a run.

    The command receives a `GivenOptions`. The options stand at the place of the parameter, in the order of the fields.

    Args:
        names: parts of a run ("file", "world", "run", "session") and fields.
        without: fields, or parts, that the command does not offer, with the reason.
        usual: text for the default in the help of an option, by field.
    """
    left_out, texts = dict(without or {}), dict(usual or {})
    offered = {
        name: one
        for name, one in run_fields().items()
        if one.option is not None and {name, one.option.part} & {*names} and name not in left_out
    }

    def decorate(command: _Command) -> _Command:
        @functools.wraps(command)
        def run(**arguments: Any) -> Any:
            values = {}
            for name, described in offered.items():
                assert described.option is not None
                value = arguments.pop(described.option.parameter, described.option.default)
                if value is not None and value is not False and value not in ([], described.option.default):
                    if isinstance(described.kind, Choice):
                        validate_word(described.option.name, value, described.kind.words)
                    values[name] = described.kind.from_option(value, described.option.name)
            return command(**arguments, given=GivenOptions(values))

        parameters: list[inspect.Parameter] = []
        for one in inspect.signature(command, eval_str=True).parameters.values():
            if one.name == "given":
                parameters += [_parameter(described, texts.get(name)) for name, described in offered.items()]
            else:
                parameters.append(one.replace(kind=inspect.Parameter.KEYWORD_ONLY))
        described_command: Any = run
        described_command.__signature__ = inspect.Signature(parameters)
        described_command.__annotations__ = {one.name: one.annotation for one in parameters}
        described_command.offered_options = OfferedOptions(tuple(offered), left_out)
        return cast(_Command, run)

    return decorate


def _parameter(described: RunField, usual: str | None) -> inspect.Parameter:
    """Return the parameter of a command's function for a field."""
    found = described.option
    assert found is not None
    value_type = described.kind.option_type
    default: Any = [] if value_type in (list[str], list[Path]) else False if value_type is bool else found.default
    if isinstance(default, str):
        value_type = str
    declaration = _option(found, found.usual if usual is None else usual, value_type)
    annotation: Any = Annotated[value_type, declaration]
    return inspect.Parameter(found.parameter, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=annotation)


def _option(found: CommandOption, usual: str, value_type: Any) -> Any:
    """Return the declaration of an option for Typer."""
    text = found.help.replace("{default}", usual)
    if value_type is bool:
        return typer.Option(found.name, help=text)
    complete = getattr(completion, found.completion) if found.completion else None
    made = option(
        text, found.metavar, found.name, min=found.least, max=found.most, complete=complete,
        parser=_PARSERS.get(found.parser),
    )  # fmt: skip
    made.exists = found.is_there
    return made


def read_run(world: str, usual_duration: float = 10.0, folders: Sequence[FilePath] = ()) -> RunSpec:
    """Return the run specification of a world or scenario file, with the requests of the file for code.

    Args:
        world: world or scenario file.
        usual_duration: simulated time of a world without a scenario [s].
        folders: folders of the user in which a scenario may name files.

    Raises:
        LoadError: the scenario file has errors.
    """
    from simkit.testing.scenarios.scenario_file import is_scenario_file, read_scenario

    if "<" not in world and is_scenario_file(world):
        return read_scenario(world, folders)
    return RunSpec(world, duration=usual_duration)


def scenario_spec(
    world: str | RunSpec, given: GivenOptions, *, allow_code: bool = False, usual_duration: float = 10.0
) -> RunSpec:
    """Return the run specification of a world, or of a scenario file with the options of a command.

    Args:
        world: world, scenario file, or its run specification.
        given: options. Their plugin folders allow the code in them.
        allow_code: allow all plugin folders that the scenario names.
        usual_duration: simulated time of a world without a scenario [s], if no bag is played.

    Raises:
        LoadError: the scenario file has errors, or SK-SCEN-008 it names code that is not allowed.
        InputError: the bag of `--play` cannot be read.
    """
    from simkit.testing.scenarios.code_permission import add_options

    options = given.load_options()
    folders = options.get("resource_paths", ())
    found = read_run(world, usual_duration, folders) if isinstance(world, str) else world
    own = found.options.get("resource_paths", ())
    if own and "resource_paths" in options:  # the option allows files; it does not replace the scenario's folders
        options = {**options, "resource_paths": (*options["resource_paths"], *own)}
    spec = given.applied(add_options(found, options, allow_code))
    if spec.played_bag is not None and spec.file is None and "duration" not in given.values:
        from simkit.recording.bags.reader import open_bag_to_read

        with open_bag_to_read(spec.played_bag) as bag:
            return spec.with_values({"duration": bag.duration})
    return spec
