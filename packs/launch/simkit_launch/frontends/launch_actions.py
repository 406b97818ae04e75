"""Actions of launch files of ROS 2 in XML and YAML: which element makes which action, and from which attributes."""

from __future__ import annotations

import shlex
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Final

from simkit.diagnostics import Diagnostics, did_you_mean
from simkit_launch.action_places import made_at
from simkit_launch.frontends.launch_element import (
    INVALID_ELEMENT,
    INVALID_VALUE,
    UNKNOWN_NAME,
    LaunchElement,
)
from simkit_launch.frontends.launch_fault import LaunchFault
from simkit_launch.frontends.substitution_text import Template, parse_substitutions, unescape
from simkit_launch.launch_modules.launch.action import Action
from simkit_launch.launch_modules.launch.actions import (
    AppendEnvironmentVariable,
    DeclareLaunchArgument,
    ExecuteProcess,
    ForEach,
    ForLoop,
    GroupAction,
    IncludeLaunchDescription,
    Log,
    LogDebug,
    LogError,
    LogInfo,
    LogWarning,
    ResetEnvironment,
    ResetLaunchConfigurations,
    SetEnvironmentVariable,
    SetLaunchConfiguration,
    Shutdown,
    TimerAction,
    UnsetEnvironmentVariable,
    UnsetLaunchConfiguration,
)
from simkit_launch.launch_modules.launch.conditions import IfCondition, UnlessCondition
from simkit_launch.launch_modules.launch.substitution import Substitution
from simkit_launch.launch_modules.launch.substitutions import TextSubstitution
from simkit_launch.launch_modules.launch_ros.actions import (
    ComposableNodeContainer,
    LifecycleNode,
    LoadComposableNodes,
    Node,
    PushROSNamespace,
    ROSTimer,
    SetParameter,
    SetParametersFromFile,
    SetRemap,
    SetROSLogDir,
    SetUseSimTime,
)
from simkit_launch.launch_modules.launch_ros.descriptions import ComposableNode, ParameterFile, ParameterValue

_TYPES: Final[Mapping[str, Any]] = {
    "str": str,
    "bool": bool,
    "int": int,
    "float": float,
    "list_of_str": list[str],
    "list_of_bool": list[bool],
    "list_of_int": list[int],
    "list_of_float": list[float],
    "yaml": None,
}
"""Types of parameters by the value of `type`."""

_BOOLEAN_CHOICES: Final = ("true", "false", "True", "False", "TRUE", "FALSE")


class _AnyLoopValues(dict[str, str]):
    """Values of a loop whose names are not known before it runs."""

    def __contains__(self, name: object) -> bool:
        return True

    def __missing__(self, name: str) -> str:
        return "0"


def read_actions(root: LaunchElement, diagnostics: Diagnostics) -> list[Action]:
    """Return the actions of a launch file; those with an error are left out, with the error recorded."""
    return _ActionReader(diagnostics).actions(root)


_Pair = tuple[Template, Template]
_Table = dict[tuple[Substitution, ...], Template]
_Parameters = ParameterFile | dict[tuple[Substitution, ...], object]
_Convert = Callable[["_ActionReader", LaunchElement, str], object]


def _plain(_: _ActionReader, element: LaunchElement, name: str) -> str | None:
    """Convert an attribute to a text without substitutions."""
    value = element.value(name)
    return None if value is None else unescape(value)


def _template(reader: _ActionReader, element: LaunchElement, name: str) -> Template | None:
    """Convert an attribute to a text with substitutions."""
    value = element.value(name)
    return None if value is None else reader.template(value)


def _typed(kind: Any, *, least: float | None = None) -> _Convert:
    """Return a conversion to a value of a type, without substitutions."""

    def convert(_: _ActionReader, element: LaunchElement, name: str) -> Any:
        value = element.value(name, kind, can_be_str=False)
        if value is not None and least is not None and value < least:
            raise LaunchFault(INVALID_VALUE, f"attribute {name!r}: found {value}; expected at least {least:g}")
        return value

    return convert


def _typed_template(kind: Any) -> _Convert:
    """Return a conversion to a value of a type, or to a text with substitutions."""

    def convert(reader: _ActionReader, element: LaunchElement, name: str) -> Any:
        value = element.value(name, kind)
        return None if value is None else reader.typed_template(value)

    return convert


def _words(reader: _ActionReader, element: LaunchElement, name: str) -> list[Template] | None:
    """Convert an attribute to the words of a command line."""
    value = element.value(name)
    return None if value is None else reader.words(value)


def _on_exit(_: _ActionReader, element: LaunchElement, name: str) -> list[Action] | None:
    value = element.value(name)
    if value not in (None, "shutdown"):
        raise LaunchFault(INVALID_VALUE, f"attribute {name!r}: found {value!r}; expected 'shutdown'")
    return None if value is None else [Shutdown(reason="a required process has ended")]


# ---------------------------------------------------------------------- elements inside an action


def _pairs(first: str, second: str) -> Callable[[_ActionReader, LaunchElement, str], list[_Pair] | None]:
    """Return a conversion of elements with two attributes to a list of pairs."""

    def convert(reader: _ActionReader, element: LaunchElement, name: str) -> list[_Pair] | None:
        pairs: list[_Pair] = []
        for child in element.elements(name):
            with reader.checked(child):
                one, two = (reader.template(child.required_text(key)) for key in (first, second))
                pairs.append((one, two))
        return pairs or None

    return convert


def _table(reader: _ActionReader, element: LaunchElement, name: str) -> _Table | None:
    """Convert elements with a name and a value to a table."""
    pairs = _pairs("name", "value")(reader, element, name)
    return None if pairs is None else {tuple(key): value for key, value in pairs}


def _arguments(reader: _ActionReader, element: LaunchElement, name: str) -> list[_Pair] | None:
    """Convert the arguments of an include, which are elements `arg` or `let`."""
    pairs = [pair for key in (name, "let") for pair in (_table(reader, element, key) or {}).items()]
    return [(list(key), value) for key, value in pairs] or None


def _choices(reader: _ActionReader, element: LaunchElement, name: str) -> list[str] | None:
    choices: list[str] = []
    for child in element.elements(name):
        with reader.checked(child):
            choices.append(unescape(child.required_text("value")))
    return choices or None


def _parameters(reader: _ActionReader, element: LaunchElement, name: str) -> list[_Parameters] | None:
    """Convert the parameters of a node to values and files."""
    found: list[_Parameters] = []
    for child in element.elements(name):
        with reader.checked(child):
            found.append(_parameter_file(reader, child) if "from" in child.values else _parameter(reader, child))
    return found or None


def _parameter_file(reader: _ActionReader, element: LaunchElement) -> ParameterFile:
    substitutes = element.value("allow_substs", bool)
    file = reader.template(element.required_text("from"))
    if "name" in element.values:
        raise LaunchFault(INVALID_ELEMENT, "the attributes 'from' and 'name' exclude each other")
    allow = reader.template(substitutes) if isinstance(substitutes, str) else bool(substitutes)
    return ParameterFile(file, allow_substs=allow)


def _parameter(reader: _ActionReader, element: LaunchElement) -> dict[tuple[Substitution, ...], object]:
    """Return a table with the value of a parameter, or with the parameters inside it."""
    if "name" not in element.values:
        raise LaunchFault(INVALID_ELEMENT, "a parameter needs the attribute 'name', or 'from' for a file")
    name = tuple(reader.template(element.required_text("name")))
    kind = element.value("type")
    if kind is not None and kind not in _TYPES:
        hint = did_you_mean(kind, _TYPES) or f"there are {', '.join(_TYPES)}"
        raise LaunchFault(INVALID_VALUE, f"attribute 'type': there is no type {kind!r}", hint)
    value = element.value("value", None if kind is None else _TYPES[kind])
    inside = element.elements("param")
    if (value is None) == (not inside):
        raise LaunchFault(INVALID_ELEMENT, "a parameter needs either the attribute 'value' or parameters inside it")
    if value is not None:
        return {name: ParameterValue(reader.typed_template(value), value_type=_TYPES.get(kind or "yaml"))}
    if kind is not None:
        raise LaunchFault(INVALID_ELEMENT, "a parameter with parameters inside it has no attribute 'type'")
    below: dict[tuple[Substitution, ...], object] = {}
    for child in inside:
        with reader.checked(child):
            below |= _parameter(reader, child)
    return {name: below}


def _components(reader: _ActionReader, element: LaunchElement, name: str) -> list[ComposableNode]:
    """Convert the nodes of a container."""
    nodes = [reader.component(child) for child in element.elements(name)]
    return [node for node in nodes if node is not None]


def _extra_arguments(reader: _ActionReader, element: LaunchElement, name: str) -> list[_Table] | None:
    table = _table(reader, element, name)
    return None if table is None else [{key: value} for key, value in table.items()]


# ---------------------------------------------------------------------- table of actions


@dataclass(frozen=True)
class _Kind:
    """Kind of action.

    Attributes:
        make: function that makes it from keywords.
        attributes: keyword and conversion of each attribute and each list of elements.
        required: attributes that cannot be left out.
        actions: keyword of the actions inside; empty if there are none.
        fixed: keywords that are always the same.
    """

    make: Callable[..., object]
    attributes: Mapping[str, tuple[str, _Convert]] = field(default_factory=dict)
    required: tuple[str, ...] = ()
    actions: str = ""
    fixed: Mapping[str, Any] = field(default_factory=dict)


_NAME: Final = {"name": ("name", _template)}
_NAME_AND_VALUE: Final = {**_NAME, "value": ("value", _template)}
_MESSAGE: Final = {"message": ("msg", _template)}
_PROCESS: Final[Mapping[str, tuple[str, _Convert]]] = {
    "cwd": ("cwd", _template),
    "launch-prefix": ("prefix", _template),
    "output": ("output", _template),
    "on_exit": ("on_exit", _on_exit),
    "respawn": ("respawn", _template),
    "respawn_max_retries": ("respawn_max_retries", _typed(int)),
    "respawn_delay": ("respawn_delay", _typed(float, least=0.0)),
    "sigkill_timeout": ("sigkill_timeout", _typed(float, least=0.0)),
    "sigterm_timeout": ("sigterm_timeout", _typed(float, least=0.0)),
    "emulate_tty": ("emulate_tty", _typed(bool)),
    "shell": ("shell", _typed(bool)),
    "env": ("additional_env", _table),
}
_NODE: Final[Mapping[str, tuple[str, _Convert]]] = {
    **_PROCESS,
    "pkg": ("package", _template),
    "exec": ("executable", _template),
    "name": ("name", _template),
    "namespace": ("namespace", _template),
    "exec_name": ("exec_name", _template),
    "args": ("arguments", _words),
    "ros_args": ("ros_arguments", _words),
    "remap": ("remappings", _pairs("from", "to")),
    "param": ("parameters", _parameters),
}
_ARGUMENT: Final[Mapping[str, tuple[str, _Convert]]] = {
    "name": ("name", _plain),
    "default": ("default_value", _template),
    "description": ("description", _plain),
}
_LOG_OF_LEVEL: Final = {"log_info": LogInfo, "log_warning": LogWarning, "log_error": LogError, "log_debug": LogDebug}

_TIMER: Final[Mapping[str, tuple[str, _Convert]]] = {"period": ("period", _typed_template(float))}

_COMPONENT: Final = _Kind(
    ComposableNode,
    {
        "pkg": ("package", _template),
        "plugin": ("plugin", _template),
        "name": ("name", _template),
        "namespace": ("namespace", _template),
        "param": ("parameters", _parameters),
        "remap": ("remappings", _pairs("from", "to")),
        "extra_arg": ("extra_arguments", _extra_arguments),
    },
    ("pkg", "plugin", "name"),
)

_KINDS: Final[Mapping[str, _Kind]] = {
    "arg": _Kind(DeclareLaunchArgument, {**_ARGUMENT, "choice": ("choices", _choices)}, ("name",)),
    "bool_arg": _Kind(DeclareLaunchArgument, _ARGUMENT, ("name",), fixed={"choices": _BOOLEAN_CHOICES}),
    "let": _Kind(SetLaunchConfiguration, _NAME_AND_VALUE, ("name", "value")),
    "unset": _Kind(UnsetLaunchConfiguration, _NAME, ("name",)),
    "reset": _Kind(ResetLaunchConfigurations, {"keep": ("launch_configurations", _table)}),
    "set_env": _Kind(SetEnvironmentVariable, _NAME_AND_VALUE, ("name", "value")),
    "unset_env": _Kind(UnsetEnvironmentVariable, _NAME, ("name",)),
    "append_env": _Kind(
        AppendEnvironmentVariable,
        {
            **_NAME_AND_VALUE,
            "prepend": ("prepend", _typed_template(bool)),
            "separator": ("separator", _template),
        },
        ("name", "value"),
    ),
    "reset_env": _Kind(ResetEnvironment),
    "group": _Kind(
        GroupAction,
        {
            "scoped": ("scoped", _typed(bool)),
            "forwarding": ("forwarding", _typed(bool)),
            "keep": ("launch_configurations", _table),
        },
        actions="actions",
    ),
    "include": _Kind(
        IncludeLaunchDescription,
        {
            "file": ("launch_description_source", _template),
            "arg": ("launch_arguments", _arguments),
        },
        ("file",),
    ),
    "executable": _Kind(
        ExecuteProcess,
        {**_PROCESS, "cmd": ("cmd", _words), "name": ("name", _template)},
        ("cmd",),
    ),
    "timer": _Kind(
        TimerAction,
        {**_TIMER, "cancel_on_shutdown": ("cancel_on_shutdown", _typed_template(bool))},
        ("period",),
        "actions",
    ),
    "ros_timer": _Kind(ROSTimer, _TIMER, ("period",), "actions"),
    "log": _Kind(Log, {**_MESSAGE, "level": ("level", _template)}, ("message",)),
    **{name: _Kind(kind, _MESSAGE, ("message",)) for name, kind in _LOG_OF_LEVEL.items()},
    "shutdown": _Kind(Shutdown, {"reason": ("reason", _plain)}),
    "node": _Kind(Node, _NODE, ("exec",)),
    "lifecycle_node": _Kind(
        LifecycleNode,
        {**_NODE, "autostart": ("autostart", _typed_template(bool))},
        ("exec", "name", "namespace"),
    ),
    "node_container": _Kind(
        ComposableNodeContainer,
        {**_NODE, "composable_node": ("composable_node_descriptions", _components)},
        ("exec", "name", "namespace"),
    ),
    "load_composable_node": _Kind(
        LoadComposableNodes,
        {
            "target": ("target_container", _template),
            "composable_node": ("composable_node_descriptions", _components),
        },
        ("target",),
    ),
    "push_ros_namespace": _Kind(PushROSNamespace, {"namespace": ("namespace", _template)}, ("namespace",)),
    "push-ros-namespace": _Kind(PushROSNamespace, {"namespace": ("namespace", _template)}, ("namespace",)),
    "set_remap": _Kind(SetRemap, {"from": ("src", _template), "to": ("dst", _template)}, ("from", "to")),
    "set_parameter": _Kind(SetParameter, _NAME_AND_VALUE, ("name", "value")),
    "set_parameters_from_file": _Kind(SetParametersFromFile, {"filename": ("filename", _template)}, ("filename",)),
    "set_use_sim_time": _Kind(SetUseSimTime, {"value": ("value", _template)}, ("value",)),
    "set_ros_log_dir": _Kind(SetROSLogDir, {"new_log_dir": ("new_log_dir", _template)}, ("new_log_dir",)),
}

_LOOPS: Final = ("for", "for_each")
ACTION_NAMES: Final = (*_KINDS, *_LOOPS)
"""Names of the elements that are actions."""


class _Checked:
    """Block that records an error in an element, and then what the block has not read of the element."""

    def __init__(self, reader: _ActionReader, element: LaunchElement) -> None:
        self.reader, self.element = reader, element

    def __enter__(self) -> None:
        pass

    def __exit__(self, kind: object, error: BaseException | None, trace: object) -> bool:
        if error is None:
            self.element.report_unread(self.reader.diagnostics)
        elif isinstance(error, LaunchFault):
            message = f"{self.element.shown}: {error}"
            self.reader.diagnostics.error(error.code, message, self.element.where, error.hint)
        return isinstance(error, LaunchFault)


class _ActionReader:
    """Reader of the actions of a file."""

    def __init__(self, diagnostics: Diagnostics, loop_values: Mapping[str, str] | None = None) -> None:
        self.diagnostics = diagnostics
        self.loop_values: Mapping[str, str] = {} if loop_values is None else loop_values

    def actions(self, element: LaunchElement) -> list[Action]:
        """Return the actions inside an element; those with an error are left out, with the error recorded."""
        actions = [self._action(child) for child in element.actions()]
        return [action for action in actions if action is not None]

    def component(self, element: LaunchElement) -> ComposableNode | None:
        """Return a node of a container."""
        made: ComposableNode | None = self._made(_COMPONENT, element)
        return made

    def checked(self, element: LaunchElement) -> _Checked:
        """Return a block that records an error in an element, and what the block has not read of the element."""
        return _Checked(self, element)

    def template(self, text: str) -> Template:
        """Return the parts of a text with substitutions."""
        return parse_substitutions(text, self.loop_values)

    def typed_template(self, value: Any) -> Any:
        """Return a value, in which texts with substitutions are replaced by their parts."""
        if isinstance(value, list):
            return [self.typed_template(item) for item in value]
        if not isinstance(value, str):
            return value
        parts = self.template(value)
        if len(parts) == 1 and isinstance(parts[0], TextSubstitution):
            return parts[0].text
        return parts

    def words(self, text: str) -> list[Template]:
        """Return the words of a command line; spaces of the text separate them, those of substitutions do not."""
        words: list[Template] = [[]]
        for part in self.template(text):
            if not isinstance(part, TextSubstitution):
                words[-1].append(part)
                continue
            try:
                pieces = shlex.split(part.text)
            except ValueError as error:
                raise LaunchFault(INVALID_VALUE, f"found {text!r}; {str(error).lower()}") from None
            if part.text[:1].isspace():
                words.append([])
            for number, piece in enumerate(pieces):
                words += [[]] if number else []
                words[-1].append(TextSubstitution(text=piece))
            if part.text[-1:].isspace():
                words.append([])
        return [word for word in words if word]

    def _action(self, element: LaunchElement) -> Action | None:
        if element.name in _LOOPS:
            return self._loop(element)
        kind = _KINDS.get(element.name)
        if kind is None:
            hint = did_you_mean(element.name, ACTION_NAMES) or f"there are {', '.join(sorted(ACTION_NAMES))}"
            self.diagnostics.error(UNKNOWN_NAME, f"there is no action {element.shown}", element.where, hint)
            return None
        made: Action | None = self._made(kind, element)
        return made

    def _made(self, kind: _Kind, element: LaunchElement) -> Any:
        with self.checked(element), made_at(element.where):
            keywords = dict(kind.fixed)
            keywords |= self._condition(element)
            for name in kind.required:
                if name not in element.values:
                    element.required_text(name)
            for name, (keyword, convert) in kind.attributes.items():
                value = convert(self, element, name)
                if value is not None:
                    keywords[keyword] = value
            if kind.actions:
                keywords[kind.actions] = self.actions(element)
            try:
                return kind.make(**keywords)
            except (TypeError, ValueError, RuntimeError) as error:
                raise LaunchFault(INVALID_VALUE, str(error)) from None
        return None

    def _condition(self, element: LaunchElement) -> dict[str, Any]:
        condition, inverse = (_template(self, element, name) for name in ("if", "unless"))
        if condition is not None and inverse is not None:
            raise LaunchFault(INVALID_ELEMENT, "the attributes 'if' and 'unless' exclude each other")
        if condition is not None:
            return {"condition": IfCondition(condition)}
        return {} if inverse is None else {"condition": UnlessCondition(inverse)}

    def _loop(self, element: LaunchElement) -> Action | None:
        """Return a loop: its actions are read again in each pass, with the values of this pass."""
        with self.checked(element), made_at(element.where):
            condition = self._condition(element)
            if element.name == "for":
                name = element.required_text("name")
                length = self.template(element.required_text("len"))
                self._pass(element, {name: "0"})
                return ForLoop(length, function=lambda i: self._pass(element, {name: str(i)}), **condition)
            values = self.template(element.required_text("values"))
            self._pass(element, _AnyLoopValues())
            return ForEach(values, function=lambda **each: self._pass(element, each), **condition)
        return None

    def _pass(self, element: LaunchElement, values: Mapping[str, Any]) -> list[Action]:
        texts = values if isinstance(values, _AnyLoopValues) else {name: str(value) for name, value in values.items()}
        inner = texts if isinstance(texts, _AnyLoopValues) else {**self.loop_values, **texts}
        return _ActionReader(self.diagnostics, inner).actions(element)
