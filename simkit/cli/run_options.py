"""Command-line options of a run: each command takes them from the descriptions of the fields of `RunSpec`."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any, Final, NamedTuple, TypeVar, cast, get_args

import typer

from simkit.cli.terminal import completion
from simkit.cli.terminal.interfaces_option import interface_folders
from simkit.cli.terminal.options import option, validate_word
from simkit.run_fields import CommandOption, LoadArguments, OptionPart, RunField
from simkit.run_files import FileName
from simkit.run_nodes import seconds_of
from simkit.run_spec import JsonObject, LoadOptions, RunSpec, SourceOptions, run_fields
from simkit.run_values import Choice

Command = TypeVar("Command", bound=Callable[..., Any])
"""Function of a command."""
PARTS: Final = get_args(OptionPart)


def parse_seconds(text: str) -> float:
    """Parse a time: `30`, `30s`, `500ms` or `2min`."""
    seconds = seconds_of(text)
    if not seconds:
        raise typer.BadParameter(f"{text!r} is not a time; expected times above 0 such as 30, 30s, 500ms or 2min")
    return seconds


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
        return [
            option.name for name in self.values if name not in excluded and (option := fields[name].option) is not None
        ]

    def load_options(self) -> LoadOptions:
        """Return the load options, with the folders of `--interfaces`."""
        load_values = {name: value for name, value in self.values.items() if run_fields()[name].is_load_option}
        folders = interface_folders()
        return cast(LoadOptions, {**load_values, **({"interfaces": folders} if folders else {})})

    def source_options(self) -> SourceOptions:
        """Return the options for reading a file."""
        names = SourceOptions.__optional_keys__
        return cast(SourceOptions, {name: value for name, value in self.values.items() if name in names})

    def load_arguments(self) -> LoadArguments:
        """Return the arguments of `simkit.load` for a command that loads a world without a run specification."""
        loaded = {name: value for name, value in self.values.items() if run_fields()[name].is_loaded}
        return cast(LoadArguments, {**loaded, **self.load_options()})

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
        changed = spec.with_values(values)
        if "timeout" in values and not changed.until:
            message = "--timeout needs --until; limit the run with --duration S"
            raise typer.BadParameter(message, param_hint="--timeout")
        return changed


NONE_GIVEN: Final = GivenOptions()
"""Default of the parameter that `with_run_options` replaces."""


def _from_working_folder(name: FileName) -> str:
    """Return the absolute path of a file that a run would look for in its own folder."""
    path = name.path_in(Path.cwd()) if name.role in ("world", "program", "bag") else None
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
) -> Callable[[Command], Command]:
    """Return a decorator that replaces the parameter `given` of a command by options of a run.

    The command receives a `GivenOptions`. The options stand at the place of the parameter, in the order of the fields.

    Args:
        names: parts of a run ("file", "world", "run", "session") and fields.
        without: fields, or parts, that the command does not offer, with the reason; options of a field follow it.
        usual: text for the default in the help of an option, by field.
    """
    left_out, texts = dict(without or {}), dict(usual or {})
    offered = {
        name: run_field
        for name, run_field in run_fields().items()
        if run_field.option is not None
        and {name, run_field.option.part} & {*names}
        and not {name, run_field.option.of_field} & left_out.keys()
    }

    def decorate(command: Command) -> Command:
        def given_options(arguments: JsonObject) -> GivenOptions:
            values = {}
            for name, described in offered.items():
                assert described.option is not None
                value = arguments[described.option.parameter]
                if value is not None and value is not False and value not in ([], described.option.default):
                    if isinstance(described.kind, Choice):
                        validate_word(described.option.name, value, described.kind.words)
                    values[name] = described.kind.from_option(value, described.option.name)
            return GivenOptions(values)

        parameters = [_parameter(described, texts.get(name)) for name, described in offered.items()]
        run: Any = replace_parameter(command, "given", parameters, given_options)
        run.offered_options = OfferedOptions(tuple(offered), left_out)
        return cast(Command, run)

    return decorate


def replace_parameter(
    command: Command, name: str, options: Iterable[inspect.Parameter], value_of: Callable[[JsonObject], object]
) -> Command:
    """Return a command that has options at the place of one parameter.

    Args:
        command: function of the command.
        name: name of the parameter.
        options: parameters of the options.
        value_of: function that receives the values of the options and returns the value of the parameter.
    """
    added = list(options)

    @functools.wraps(command)
    def run(**arguments: object) -> object:
        values = {option.name: arguments.pop(option.name, option.default) for option in added}
        return command(**arguments, **{name: value_of(values)})

    parameters: list[inspect.Parameter] = []
    for parameter in inspect.signature(command, eval_str=True).parameters.values():
        parameters += added if parameter.name == name else [parameter]
    described: Any = run
    described.__signature__ = inspect.Signature(
        [parameter.replace(kind=inspect.Parameter.KEYWORD_ONLY) for parameter in parameters]
    )
    described.__annotations__ = {parameter.name: parameter.annotation for parameter in parameters}
    return cast(Command, run)


def _parameter(described: RunField, usual: str | None) -> inspect.Parameter:
    """Return the parameter of a command's function for a field."""
    option = described.option
    assert option is not None
    value_type = described.kind.option_type
    default: object = [] if value_type in (list[str], list[Path]) else False if value_type is bool else option.default
    if isinstance(default, str):
        value_type = str
    declaration = _option(option, option.usual if usual is None else usual)
    annotation: Any = Annotated[value_type, declaration]
    return inspect.Parameter(option.parameter, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=annotation)


def _option(command_option: CommandOption, usual: str) -> object:
    """Return the declaration of an option for Typer."""
    text = command_option.help.replace("{default}", usual)
    complete = getattr(completion, command_option.completion) if command_option.completion else None
    made = option(
        text,
        command_option.metavar or None,
        command_option.name,
        min=command_option.least,
        max=command_option.most,
        complete=complete,
        parser=_PARSERS.get(command_option.parser),
    )
    made.exists = command_option.is_there
    return made


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
    from simkit.testing.scenarios.scenario_file import read_run

    options = given.load_options()
    folders = options.get("resource_paths", ())
    scenario = read_run(world, usual_duration, folders) if isinstance(world, str) else world
    scenario_folders = scenario.options.get("resource_paths", ())
    if (
        scenario_folders and "resource_paths" in options
    ):  # the option allows files; it does not replace the scenario's folders
        options = {**options, "resource_paths": (*options["resource_paths"], *scenario_folders)}
    spec = given.applied(add_options(scenario, options, allow_code))
    if spec.played_bag is not None and spec.file is None and "duration" not in given.values:
        from simkit.recording.bags.reader import open_bag_to_read

        with open_bag_to_read(spec.played_bag) as bag:
            return spec.with_values({"duration": bag.duration})
    return spec
