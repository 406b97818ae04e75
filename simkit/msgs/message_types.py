"""Message types: types of ROS 2 Jazzy from rosbags, types in `definitions/`, and types of the user (`own_interfaces`).

A type is read at its first use.
The definition of a simkit type is the file `definitions/<package>/<msg, srv or action>/<Name>.<msg, srv or action>`,
with the published fields, constants and default values in the published order. A service or action is several message
types, which `---` separates in the file: `<package>/srv/<Name>_Request` and `…_Response`,
`<package>/action/<Name>_Goal`, `…_Result` and `…_Feedback`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

from simkit.argument_checks import check_text
from simkit.diagnostics import did_you_mean
from simkit.errors import MessageError
from simkit.msgs import own_interfaces
from simkit.msgs.definition_parser import PARTS, MessageDefinition, interface_of
from simkit.msgs.message_repr import attribute_names, with_readable_text
from simkit.msgs.notebook_pictures import with_notebook_pictures
from simkit.msgs.shipped_interfaces import (
    PACKAGES_WITH_LONG_NAMES,
    definition_files,
    foreign_message_types,
    pack_message_types,
    rosbags_types,
    shipped_message_types,
    shipped_parts,
)
from simkit.msgs.wide_strings import with_wide_strings

if TYPE_CHECKING:
    from rosbags.typesys.store import Typestore
    from typing_extensions import TypeVar  # the types of the standard library contain it

    M = TypeVar("M", default=Any)
    M_co = TypeVar("M_co", default=Any, covariant=True)
    R = TypeVar("R", default=Any)
    F = TypeVar("F", default=Any)

    def cache(function: M) -> M:
        """Remember results, as `functools.cache` does, which hides the arguments from editors."""

else:
    from functools import cache
    from typing import TypeVar

    M = TypeVar("M")  # class of a message, a request or a goal; Any if it is not given
    M_co = TypeVar("M_co", covariant=True)
    R = TypeVar("R")  # class of a response or a result
    F = TypeVar("F")  # class of a feedback message

# Message of any type: an object of a dataclass that rosbags creates at run time.
Message = Any
# Value of a message's field: a number, a text, an array, a message or a list of these.
FieldValue = Any
_Entry = Any  # entry of the type store: a class, or its constants and fields


class _ReadOnDemand(dict[str, _Entry]):
    """Table of the type store that also contains the types of simkit and of the user, registered on first access."""

    def __contains__(self, type_name: object) -> bool:
        return super().__contains__(type_name) or (isinstance(type_name, str) and definition_of(type_name) is not None)

    def __missing__(self, type_name: str) -> _Entry:
        _register(type_name)
        return self[type_name]


@cache
def type_store() -> Typestore:
    """Return the type store of all message types that simkit knows."""
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_JAZZY)
    with_readable_text(store.types.values())
    with_notebook_pictures(store.types)
    return with_wide_strings(store, _ReadOnDemand(store.fielddefs), _ReadOnDemand(store.types))


def interface_parts(interface_name: str) -> tuple[MessageDefinition, ...] | None:
    """Return the parts of an interface of simkit or of the user; None for types of rosbags and unknown names.

    Raises:
        InterfaceError: the definition of a type of the user has errors.
    """
    if interface_name in definition_files():
        return shipped_parts(interface_name)
    added = own_interfaces.find(interface_name)
    return None if added is None else added.parts


def definition_of(type_name: str) -> MessageDefinition | None:
    """Return the definition of a message type of simkit or of the user; None for types of rosbags and unknown names.

    Raises:
        InterfaceError: the definition of a type of the user has errors.
    """
    interface, part = interface_of(type_name) or ("", 0)
    parts = interface_parts(interface) if interface else None
    return None if parts is None else parts[part]


def _register(type_name: str) -> None:
    """Register one message type of simkit or of the user in the type store.

    Raises:
        KeyError: the type is unknown.
    """
    definition = definition_of(type_name)
    if definition is None:
        raise KeyError(type_name)
    constants: Any = [
        (name, kind, _SpecialNumber(value) if kind.startswith("float") else value)
        for name, kind, value in definition.constants
    ]
    fields: Any = definition.fields
    type_store().register({type_name: (constants, fields)})
    with_readable_text([type_store().types[type_name]])
    make_picklable(type_store().types[type_name])


def make_picklable(cls: type, find: Callable[[str], type] | None = None) -> None:
    """Let messages of a registered class be pickled; another process registers the class by its type name.

    Args:
        cls: class that rosbags generated; no module has it.
        find: function of a module that returns the class of a type name; None for `type_of`.
    """

    def reduce(message: Message) -> tuple[object, ...]:
        values = tuple(getattr(message, name) for name in attribute_names(message))
        return _new_message, (find or type_of, message.__msgtype__, values)

    cls.__reduce__ = reduce  # type: ignore[assignment]  # as above


def _new_message(find: Callable[[str], type], type_name: str, values: tuple[object, ...]) -> object:
    return find(type_name)(*values)


class _SpecialNumber(float):
    """Number whose text is Python code also if it is NaN or infinite: rosbags writes constants into generated code."""

    def __repr__(self) -> str:
        return f"float({str(float(self))!r})"


def message_type_names() -> list[str]:
    """Return the full name of every message type, including the parts of services and actions."""
    return sorted({*rosbags_types(), *shipped_message_types()})


def full_name(type_name: str) -> str:
    """Return the full name of a message type: `sensor_msgs/Imu` is `sensor_msgs/msg/Imu`.

    Raises:
        MessageError: the type is unknown; the message suggests the closest name.
    """
    check_text(type_name, "the name of a type")
    known = type_store().fielddefs
    package, _, rest = type_name.partition("/")
    long = f"{package}/msg/{rest}"
    for name in (type_name, long):
        if name in known:
            return name
    is_long = any(f"/{kind}/" in type_name for kind in PARTS)
    names = [*known, *shipped_message_types(), *own_interfaces.names()]
    hint = did_you_mean(type_name if is_long else long, names)
    raise MessageError(f"unknown message type {type_name!r}; {hint}".rstrip("; ") + own_package_hint(package, names))


def own_package_hint(package: str, names: Iterable[str]) -> str:
    """Return a hint about `--interfaces` if no known type is in the package; else an empty text."""
    if any(name.startswith(f"{package}/") for name in names):
        return ""
    return f"; if the package {package!r:.80} is yours, add its folder with --interfaces DIR"


def named_type(type_: str | type) -> str:
    """Return the name of a message type, given by its name or by its class.

    Raises:
        MessageError: the class is not that of a message.
    """
    if not isinstance(type_, type):
        return type_
    name = getattr(type_, "__msgtype__", None)
    if not isinstance(name, str):
        raise MessageError(f"{type_.__name__} is not a class of messages; use one of simkit.msgs, such as LaserScan")
    return name


def interface_type(type_: str | type, part: str) -> str:
    """Return the name of a service or action type, given by its name or by the class of its first part.

    Args:
        type_: name such as `std_srvs/srv/SetBool`, or class such as `msgs.SetBool_Request`.
        part: name of the part whose class is accepted: "Request" or "Goal".

    Raises:
        MessageError: the class is not that of such a part.
    """
    if not isinstance(type_, type):
        return type_
    name = named_type(type_)
    if not name.endswith(f"_{part}"):
        raise MessageError(f"{name} is no class of a {part.lower()}; use one of simkit.msgs that ends with _{part}")
    return name.removesuffix(f"_{part}")


@cache
def type_of(type_name: str) -> type[Message]:
    """Return the dataclass of a message type. In code that must be fast, call the class directly."""
    return type_store().types[full_name(type_name)]


@cache
def class_names() -> dict[str, str]:
    """Return the type name of each message class by the class's name in `simkit.msgs`.

    The name of a class is the last part of its type name: `LaserScan`. If several types have the same last part, ROS's
    own type has the short name, and a type of `PACKAGES_WITH_LONG_NAMES` has it only if no other package has the name.
    A type of a pack never takes the name from one of the core, and one of another distribution's pack never from one of
    simkit. The other types have their full name: `gazebo_msgs__srv__SpawnEntity_Request`.
    """
    names = message_type_names()
    candidates: dict[str, list[str]] = {}
    for name in sorted(names, key=_rank):
        candidates.setdefault(name.rpartition("/")[2], []).append(name)
    classes = {}
    for name in names:
        short = name.rpartition("/")[2]
        first, *others = candidates[short]
        is_ambiguous = bool(others) and _rank(first) == _rank(others[0])
        classes[short if name == first and not is_ambiguous else name.replace("/", "__")] = name
    return classes


def _rank(type_name: str) -> int:
    """Return the priority of a type for a short class name: 0 for ROS's own types."""
    if type_name not in shipped_message_types():
        return 0
    if type_name in foreign_message_types():
        return 4
    if type_name in pack_message_types():
        return 3
    return 2 if type_name.split("/")[0] in PACKAGES_WITH_LONG_NAMES else 1


def message_class(class_name: str) -> type[Message]:
    """Return a message class by its name in `simkit.msgs`.

    Raises:
        AttributeError: the name is unknown; the message suggests the closest name.
    """
    # a lower-case name is a submodule or a typing error; it must not load the type store
    if class_name[:1].isupper() or "__" in class_name.strip("_"):
        names = class_names()
        if class_name in names:
            return type_of(names[class_name])
        added = own_interfaces.message_type(class_name)
        if added:
            return type_of(added)
        raise AttributeError(f"simkit.msgs has no {class_name!r}; {did_you_mean(class_name, names)}".rstrip("; "))
    raise AttributeError(f"simkit.msgs has no {class_name!r}")


@cache
def types_of(*type_names: str) -> tuple[type[Message], ...]:
    """Return the dataclasses of several types. The first call of a process loads the type store, which takes 0.2 s."""
    return tuple(map(type_of, type_names))


@cache
def definition(type_name: str) -> str:
    """Return the definition of a type as `ros2msg` text, with the definitions of all types that it uses."""
    name, store = full_name(type_name), type_store()
    texts: dict[str, tuple[str, str]] = {}
    text = store.gendefhash(name, texts, 2)[0]
    # rosbags' texts have neither default values nor the bounds of wstring; types of the user keep their own text
    pieces = [_own_text(name) or text]
    for used, (used_text, _) in texts.items():
        package, _, short = used.split("/")
        pieces.append(f"MSG: {package}/{short}\n{_own_text(used) or used_text}")
    return ("=" * 80 + "\n").join(pieces)


def _own_text(type_name: str) -> str:
    """Return the text of a type of the user; empty for all other types."""
    interface, _ = interface_of(type_name) or ("", 0)
    definition = None if interface in definition_files() else definition_of(type_name)
    return "" if definition is None else definition.text
