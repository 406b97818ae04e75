"""Description of the fields of a run: for each field its form in files and bundles, and its command-line option.

A field of `RunSpec` has its description in its metadata (`run_field`); a load option has a row in `LOAD_FIELDS`.
Everything that writes, reads, moves or packs a run, and every command that runs a world, uses these descriptions.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from typing import Any, Final, Literal, NamedTuple, TypedDict, get_args

from simkit.run_files import FilePath, PackagePaths
from simkit.run_values import (
    Choice,
    Flag,
    Folders,
    NamedTexts,
    NamedValues,
    Packages,
    ParameterFiles,
    ValueKind,
    WordOrFile,
)

PluginErrorPolicy = Literal["stop", "disable"]
"""Policy for a plugin that raises: end the run, or continue without the plugin."""
RendererName = Literal["auto", "gl", "software"]
"""Renderer of images: OpenGL, simkit's software renderer, or OpenGL if this machine has it and else software."""
RENDERERS: Final[tuple[str, ...]] = get_args(RendererName)
BASES: Final = ("auto", "fixed", "floating")
"""Bases of a bare model."""
_METADATA: Final = "run"  # key of the description in the metadata of a dataclass field


class SourceOptions(TypedDict, total=False):
    """Options for reading a file, shared by `simkit.load`, `check` and `describe`."""

    resource_paths: Sequence[FilePath]
    package_paths: PackagePaths
    xacro_args: NamedValues
    base: str


class LoadOptions(SourceOptions, total=False):
    """Arguments of `simkit.load` that a run passes and that are not fields of `RunSpec`."""

    plugin_paths: Sequence[FilePath]
    interfaces: Sequence[FilePath]
    params_files: FilePath | Sequence[FilePath | tuple[str, FilePath]]
    strict: bool
    sleep: bool
    render_thread: bool | None
    on_error: PluginErrorPolicy | None
    renderer: RendererName | None
    remap: NamedValues
    start_controllers: bool
    hold_joints: bool
    realism: str | None


class LoadArguments(LoadOptions, total=False):
    """All keyword arguments of `simkit.load`."""

    seed: int
    overrides: Sequence[str]
    spawn: Sequence[Any]
    model_world: str
    plugins: Sequence[object]
    change_world: Callable[[Any], Any] | None


OptionPart = Literal["file", "world", "run", "session"]
"""Part of a run that an option belongs to, in the order in which a command needs them.

- "file": how the world's file is read.
- "world": what is loaded from it.
- "run": what happens to the world, and when it ends.
- "session": how a person follows a run.
"""


class CommandOption(NamedTuple):
    """Command-line option of a field.

    Attributes:
        name: name, such as `--set`.
        metavar: placeholder of the value in a help text; empty for a flag.
        help: help text. `{default}` is the default of the command.
        part: part of a run that the option belongs to.
        usual: text for `{default}` in the help text, for a command without another one.
        default: value without the option, if a help text shows it.
        least, most: limits of a number.
        parser: name of the text conversion in `simkit.cli.run_options`; empty for none.
        completion: name of a function in `simkit.cli.terminal.completion`; empty for none.
        is_there: True for a path that must exist.
        of_field: field without which the option has no use, such as `until` for `--timeout`; empty for none. A command
            that leaves out that field leaves out the option, for the same reason.
    """

    name: str
    metavar: str
    help: str
    part: OptionPart = "run"
    usual: str = ""
    default: object = None
    least: float | None = None
    most: float | None = None
    parser: str = ""
    completion: str = ""
    is_there: bool = False
    of_field: str = ""

    @property
    def parameter(self) -> str:
        """Name of the parameter of a command's function."""
        return self.name.removeprefix("--").replace("-", "_") + "_"


class RunField(NamedTuple):
    """Description of one field of a run.

    Attributes:
        name: name of the field of `RunSpec`, or of the load option.
        kind: kind of its value.
        option: its command-line option; None if a run takes the value from Python or from a file only.
        key: key in a scenario file; None if a scenario file cannot contain the field.
        is_stored: True if a golden run stores the value.
        packed: "first" for a value that a bundle contains since its first format; "changed" for a value that a bundle
            contains if it differs from the default; "never" for a value that the repeated run does not need, because
            the journal of commands or the packed world replaces it.
        is_appended: True if values of an option follow those of a scenario file; else they replace them.
        is_loaded: True for an argument of `simkit.load`.
        is_load_option: True for a load option; false for a field of `RunSpec`.
        default: default value.
    """

    name: str
    kind: ValueKind
    option: CommandOption | None = None
    key: str | None = None
    is_stored: bool = True
    packed: Literal["first", "changed", "never"] = "changed"
    is_appended: bool = False
    is_loaded: bool = False
    is_load_option: bool = False
    default: object = None


_PYTHON_ONLY: Final = ValueKind()


def run_field(
    default: object,
    kind: ValueKind = _PYTHON_ONLY,
    option: CommandOption | None = None,
    *,
    key: str | None = "",
    is_stored: bool | None = None,
    packed: Literal["first", "changed", "never"] | None = None,
    is_appended: bool = False,
    is_loaded: bool = False,
) -> Any:
    """Return a dataclass field with the description of a field of a run; see `RunField`.

    Args:
        default: default value, or a function that makes it.
        kind: kind of the value; without one, the field has no general form in files.
        option: command-line option.
        key: key in a scenario file; empty for the field's name.
        is_stored: True if a golden run stores the value; None for a field with a key.
        packed: when a bundle contains the value; None for the changed value of an argument of `simkit.load`.
        is_appended: True if values of an option follow those of a scenario file.
        is_loaded: True for an argument of `simkit.load`.
    """
    metadata = {
        _METADATA: {
            "kind": kind, "option": option, "key": key, "is_appended": is_appended, "is_loaded": is_loaded,
            "is_stored": key is not None if is_stored is None else is_stored,
            "packed": packed or ("changed" if is_loaded else "never"),
        }
    }  # fmt: skip
    if callable(default):
        return dataclasses.field(default_factory=default, metadata=metadata)
    return dataclasses.field(default=default, metadata=metadata)


def described_fields(run_class: type) -> dict[str, RunField]:
    """Return the descriptions of the fields of a class by name; fields from Python only have none."""
    fields: dict[str, RunField] = {}
    for field in dataclasses.fields(run_class):
        description = field.metadata.get(_METADATA)
        if description is not None and description["kind"] is not _PYTHON_ONLY:
            key, factory = description["key"], field.default_factory
            default = field.default if factory is dataclasses.MISSING else factory()
            rest = {**description, "key": field.name if key == "" else key, "default": default}
            fields[field.name] = RunField(field.name, **rest)
    return fields


def _load_options(*rows: RunField) -> dict[str, RunField]:
    return {row.name: row._replace(is_loaded=True, is_load_option=True) for row in rows}


LOAD_FIELDS: Final = _load_options(
    RunField("interfaces", Folders(), key="interfaces", packed="never", default=()),  # all commands have the option
    RunField(
        "resource_paths", Folders(must_exist=True), key="resource_paths", packed="never", default=(),
        option=CommandOption(
            "--resource-path", "DIR", "Search folder for model://, package:// and relative URIs; repeatable.", "file"
        ),
    ),
    RunField(
        "package_paths", Packages(), key="package_paths", packed="never", default=(),
        option=CommandOption(
            "--package-path", "[NAME=]DIR", "Workspace of ROS packages, or folder of the package NAME; repeatable.",
            "file",
        ),
    ),
    RunField(
        "xacro_args", NamedTexts(), key="xacro_args", packed="never", default=(),
        option=CommandOption("--xacro-arg", "NAME:=VALUE", "Argument of a xacro file; repeatable.", "file"),
    ),
    RunField(
        "base", Choice(BASES), key="base", packed="first", default="auto",
        option=CommandOption(
            "--base", "BASE", "Base of a bare model: fixed, floating, or auto (floating unless joined to the world).",
            "file", default="auto",
        ),
    ),
    RunField(
        "params_files", ParameterFiles(), key="params_files", packed="first", default=(),
        option=CommandOption(
            "--params-file", "[MODEL=]FILE.yaml",
            "Controller parameter file, for all control plugins or for those of one model; repeatable.", "world",
        ),
    ),
    RunField(
        "plugin_paths", Folders(), packed="never", default=(),  # a scenario file asks for its folders
        option=CommandOption(
            "--plugin-path", "DIR", "Folder of Python plugins to allow; repeatable.", "world", is_there=True
        ),
    ),
    RunField(
        "on_error", Choice(get_args(PluginErrorPolicy)), packed="first",
        option=CommandOption(
            "--on-plugin-error", "stop|disable",
            "Action if a plugin raises an error: stop ends the run (exit 4), disable continues without the plugin.",
            "world",
        ),
    ),
    RunField(
        "renderer", Choice(RENDERERS), key="renderer", packed="first",
        option=CommandOption(
            "--renderer", "auto|gl|software",
            "Renderer of images: gl, software, or auto (OpenGL if this machine has it); default: the world's, else "
            "auto.",
            "world",
        ),
    ),
    RunField(
        "remap", NamedTexts(), key="remap", default=(),
        option=CommandOption(
            "--remap", "OLD:=NEW", "Other name for a topic, service or action of the world; repeatable.", "world"
        ),
    ),
    RunField(
        "strict", Flag(), packed="never", default=False,  # a packed world was accepted
        option=CommandOption("--strict", "", "Treat warnings as errors.", "world"),
    ),
    RunField(
        "hold_joints", Flag(), key="hold_joints", packed="first", default=False,
        option=CommandOption(
            "--hold-joints", "", "Hold each joint that no plugin drives at its initial position.", "world"
        ),
    ),
    RunField(
        "realism", WordOrFile(), key="realism",
        option=CommandOption(
            "--realism", "datasheet|ideal|SET|FILE.yaml",
            "Errors of all sensors: those of the data sheets, none, or those of a set or file; default: the files'.",
            "world", completion="realism",
        ),
    ),
    RunField("sleep", Flag(), packed="first", default=True),
    RunField("start_controllers", Flag(), key="start_controllers", packed="first", default=True),
    RunField("render_thread", Flag(), packed="never"),  # it does not change the bits
)  # fmt: skip
"""Load options by name, in the order of a command's help."""
