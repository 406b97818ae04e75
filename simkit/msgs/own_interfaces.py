"""Messages, services and actions that are not shipped with simkit: from files of the user, or from another process.

A definition comes from `simkit.msgs.add`, from the folders of `--interfaces` and `SIMKIT_INTERFACES`, or from a client
or a running simulation. At its first use, a type is also searched in ROS packages on `AMENT_PREFIX_PATH` and near the
loaded world. A type has one definition in a process.
"""

from __future__ import annotations

import logging
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Final

from simkit import hidden_text
from simkit.diagnostic_record import Diagnostic
from simkit.diagnostics import did_you_mean
from simkit.errors import InterfaceError
from simkit.home_folder import expand_home
from simkit.input_file import read_failure, read_input_text
from simkit.linked_files import choose_folders, leads_outside
from simkit.msgs.definition_parser import (
    PARTS,
    UNKNOWN_TYPE,
    FieldNode,
    MessageDefinition,
    interface_of,
    name_problem,
    names_of_ros1,
    parse_interface,
)
from simkit.msgs.interface_folders import definitions_in, installed_file, installed_names, is_in_ros1_package
from simkit.msgs.shipped_interfaces import rosbags_types, shipped_message_types, shipped_parts
from simkit.msgs.type_limits import DefinitionTooLarge, check_size

VARIABLE: Final = "SIMKIT_INTERFACES"
_DIFFERS, _TOO_LARGE, _UNREADABLE = "SK-INTERFACE-004", "SK-INTERFACE-005", "SK-INTERFACE-006"
_NAMES_OF_ROS1: Final = "SK-INTERFACE-007"
_LARGEST_FILE: Final = 1 << 20  # [bytes]; the longest definition of ROS 2 Jazzy has 20 kB with its comments


@dataclass(frozen=True)
class OwnInterface:
    """Message, service or action with its definition.

    Attributes:
        name: full name, such as `my_msgs/srv/AddInts`.
        parts: definition of each part: one for a message, two for a service, three for an action.
        source: file of the definition; the interface's name for a definition without a file.
    """

    name: str
    parts: tuple[MessageDefinition, ...]
    source: str

    @property
    def content(self) -> list[tuple[object, ...]]:
        """Everything that two equal definitions have in common: not the comments."""
        return [part.content for part in self.parts]

    @property
    def text(self) -> str:
        """Text of the definition file."""
        return "---\n".join(part.text for part in self.parts)


Fields = list[tuple[str, FieldNode]]
InterfaceFinder = Callable[[str, str], Path | None]
"""Function that returns the definition file of a package and a relative path such as `msg/Num.msg`."""

_added: dict[str, OwnInterface] = {}
_received: dict[str, tuple[str, str]] = {}  # text and sender of definitions that were not used yet
_used: set[str] = set()  # names that were looked up
_left_out: dict[str, list[Diagnostic]] = {}  # problems of definitions in folders that were left out
_told: set[str] = set()  # reports that were printed
_missing: set[str] = set()  # names that no folder has; looked up again after a change of the folders
_finders: list[InterfaceFinder] = []
_read_variable = ""


def find(name: str) -> OwnInterface | None:
    """Return an interface by its full name; search its package if it is not known yet.

    Raises:
        InterfaceError: the definition, or another definition in its folder, has errors.
    """
    read_environment()
    if name in _left_out and name not in _added:
        raise InterfaceError(_left_out[name])
    if name not in _added and name not in _missing:
        # a package std_msgs of a ROS workspace must not compete with simkit's types
        source = _located(name) if shipped_parts(name) is None else None
        if source is None:
            _missing.add(name)
        else:
            _add_all([(name, source)])
    if name in _added:
        _used.add(name)
    return _added.get(name)


def has_any() -> bool:
    """Check whether any interface was added or received."""
    return bool(_added or _received)


def is_known(name: str) -> bool:
    """Check whether an interface was added or received."""
    return name in _added or name in _received


def known_names() -> list[str]:
    """Return the full name of every interface that was added or received, sorted."""
    read_environment()
    return sorted({*_added, *_received})


def names() -> list[str]:
    """Return the full name of every interface that was added or received, or is in a ROS workspace, sorted."""
    return sorted({*known_names(), *installed_names()})


def add(name: str, text: str) -> None:
    """Define a message, service or action for this process.

    A second definition with the same fields, constants and defaults has no effect.

    Args:
        name: full name, such as `my_msgs/msg/Num`, `my_msgs/srv/AddInts` or `my_msgs/action/Count`.
        text: definition, as in a `.msg`, `.srv` or `.action` file.

    Raises:
        InterfaceError: the name or the definition is invalid, or the type has another definition already.
    """
    _add_all([(name, text)])


def add_received(texts: Mapping[str, str]) -> None:
    """Define interfaces that another process has sent, given as texts by name. They may use each other.

    Raises:
        InterfaceError: see `add`.
    """
    _add_all(list(texts.items()), is_ros1=True)


def remember_received(texts: Mapping[str, str], sender: str) -> None:
    """Store definitions that another process has sent. They are read when their types are used for the first time.

    A client that only forwards messages therefore needs neither rosbags nor NumPy.

    Args:
        texts: text of each interface by name.
        sender: description of the other process, for error messages.

    Raises:
        InterfaceError: a type has another definition in this process.
    """
    batch = _Batch([])
    for name, text in texts.items():
        if name in _added or name in _received:
            batch.read(name, text, f"{name} of {sender}")
    if batch.problems:
        raise InterfaceError(batch.problems)
    _received.update({name: (text, sender) for name, text in texts.items()})
    _missing.clear()


def add_folders(folders: Iterable[str | os.PathLike[str]]) -> list[Diagnostic]:
    """Define all interfaces in folders: ROS packages, workspaces, or folders with definition files.

    A definition with errors is left out, with those that use it; the others can be used.

    Returns:
        Warnings about definitions that were left out, and notes about names that only ROS 1 allows.

    Raises:
        InterfaceError: a folder has no definitions, or all its definitions have errors; the exception lists all errors.
    """
    definitions: list[tuple[str, str | Path]] = []
    problems: list[Diagnostic] = []
    for folder in folders:
        path = expand_home(folder)
        if leads_outside(str(path)):
            hidden_text.hide(str(path), os.path.realpath(path))
        else:
            choose_folders([path.absolute()])
        in_folder = list(definitions_in(path)) if path.is_dir() else []
        if not in_folder:
            what = "has no file .msg, .srv or .action" if path.is_dir() else "is not a folder"
            hint = "give a ROS package, a workspace, or a folder such as my_msgs with my_msgs/msg/Num.msg"
            problems.append(Diagnostic(_UNREADABLE, "error", f"interfaces: {str(path)!r} {what}", hint=hint))
        definitions += in_folder
    batch = _Batch(list(problems))
    for name, source in definitions:
        batch.read(name, source)
    batch.check()
    reports = [] if problems else batch.leave_out_invalid()
    _store(batch)
    return [*reports, *batch.notes]


def note_told(reports: Iterable[Diagnostic]) -> None:
    """Note that reports of `add_folders` were printed, so that a world with the same folders does not repeat them."""
    _told.update(str(report) for report in reports)


def untold(reports: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Return the reports that were not printed yet."""
    return [report for report in reports if str(report) not in _told]


def add_definitions(definitions: Mapping[str, str | Path]) -> None:
    """Define interfaces that may use each other, each by its full name with its text or its file.

    Raises:
        InterfaceError: see `add`.
    """
    _add_all(list(definitions.items()))


def read_environment() -> None:
    """Define all interfaces in the folders of `SIMKIT_INTERFACES`, once for each value of the variable.

    Raises:
        InterfaceError: see `add_folders`.
    """
    global _read_variable
    value = os.environ.get(VARIABLE, "")
    if value != _read_variable:
        _read_variable = value  # first, because the search for a type that a definition uses comes here again
        try:
            for report in add_folders(folder for folder in value.split(os.pathsep) if folder):
                logging.getLogger("simkit").warning("%s", report)
        except BaseException:
            _read_variable = ""
            raise


def set_finder(finder: InterfaceFinder) -> None:
    """Set the function that searches packages near the world; worlds that were loaded before keep their types."""
    _finders[:] = [finder]
    _missing.clear()


def message_type(class_name: str) -> str:
    """Return the message type of a class name, such as `Num` or `my_msgs__msg__Num`; empty if there are not one."""
    names = [f"{name}{part}" for name in _added for part in PARTS[name.split("/")[1]]]
    matching = [n for n in names if class_name in (n.rpartition("/")[2], n.replace("/", "__"))]
    return matching[0] if len(matching) == 1 else ""


def texts_used_by(type_names: Iterable[str]) -> dict[str, str]:
    """Return the text of each own interface that some message types or interfaces consist of, by name."""
    texts: dict[str, str] = {}
    waiting = list(type_names)
    while waiting:
        name = waiting.pop()
        interface = name if name in _added or name in _received else (interface_of(name) or ("", 0))[0]
        added = _added.get(interface) or _received_interface(interface)
        if added is not None and added.name not in texts:
            texts[added.name] = added.text
            waiting += [used for part in added.parts for _, used in part.used_types()]
    return dict(sorted(texts.items()))


def used_texts() -> dict[str, str]:
    """Return the text of each own interface that was used in this process, by name."""
    return texts_used_by(_used)


def used_ros1_packages() -> set[str]:
    """Return the packages of the own interfaces used in this process that have names which only ROS 1 allows."""
    used = (_added[name] for name in used_texts() if name in _added)
    return {item.name.partition("/")[0] for item in used if any(map(names_of_ros1, item.parts))}


# ---------------------------------------------------------------------- reading and checks


def _located(name: str) -> Path | str | None:
    """Return the received text of an interface, or its file in a ROS workspace or near the world; None for neither."""
    if name_problem(name) is not None:
        return None
    if name in _received:
        return _received[name][0]
    package, kind, short = name.split("/")
    file = f"{kind}/{short}.{kind}"
    return installed_file(package, file) or next((f for find in _finders if (f := find(package, file))), None)


def _add_all(definitions: Sequence[tuple[str, str | Path]], *, is_ros1: bool = False) -> None:
    """Parse, check and store definitions, and those definitions in workspaces that they use.

    Args:
        definitions: name, and text or file, of each definition.
        is_ros1: accept names of fields and constants that only ROS 1 allows.

    Raises:
        InterfaceError: there are problems; nothing is stored.
    """
    batch = _Batch([])
    for name, source in definitions:
        batch.read(name, source, is_ros1=is_ros1)
    batch.check()
    _store(batch)


def _store(batch: _Batch) -> None:
    """Store the definitions of a batch.

    Raises:
        InterfaceError: there are problems; nothing is stored.
    """
    if batch.problems:
        raise InterfaceError(batch.problems)
    if batch.interfaces:
        _added.update(batch.interfaces)
        _missing.clear()
        for name in batch.interfaces:
            _left_out.pop(name, None)


class _Batch:
    """Definitions that are read together, because they may use each other."""

    def __init__(self, problems: list[Diagnostic]) -> None:
        self.problems = problems
        self.notes: list[Diagnostic] = []
        self.interfaces: dict[str, OwnInterface] = {}
        self._waiting: list[OwnInterface] = []

    def read(self, name: str, source: str | Path, label: str = "", *, is_ros1: bool = False) -> None:
        """Parse one definition and compare it with the definition that the type may have already.

        Args:
            name: full name of the interface.
            source: text or file.
            label: source of a text in messages; default: the name.
            is_ros1: accept names of fields and constants that only ROS 1 allows; a file of a catkin package may have
                such names in any case.
        """
        file = str(source) if isinstance(source, Path) else label or name
        wrong = name_problem(name)
        if wrong is not None:
            self._report(file, wrong.code, 0, wrong.message, wrong.hint)
            return
        try:
            if isinstance(source, Path):
                text = read_input_text(source, _LARGEST_FILE, inside=source.parent)
            else:
                text = source
        except (OSError, UnicodeDecodeError) as error:
            self._report(file, _UNREADABLE, 0, f"the definition cannot be read: {read_failure(error)}")
            return
        has_any_names = is_ros1 or bool(label) or (isinstance(source, Path) and is_in_ros1_package(source))
        parts, mistakes = parse_interface(name, text, is_ros1=has_any_names)
        self._note_names(parts, source)
        for problem in mistakes:
            self._report(file, problem.code, problem.line, problem.message, problem.hint)
        self._put(OwnInterface(name, tuple(parts), file), is_valid=not mistakes)

    def _note_names(self, parts: Sequence[MessageDefinition], source: str | Path) -> None:
        names = [name for part in parts for name in names_of_ros1(part)] if isinstance(source, Path) else []
        if names:
            text = f"names that ROS 1 allows and ROS 2 refuses: {', '.join(names)}"
            self.notes.append(Diagnostic(_NAMES_OF_ROS1, "note", text, str(source)))

    def leave_out_invalid(self) -> list[Diagnostic]:
        """Leave out the definitions with errors and those that use them; return a warning for each error.

        If no valid definition remains, nothing changes and the result is empty.
        """
        reports: list[Diagnostic] = []
        kept, problems = dict(self.interfaces), self.problems
        while problems:
            files = {problem.file for problem in problems}
            invalid = {name for name, interface in kept.items() if interface.source in files}
            kept = {name: interface for name, interface in kept.items() if name not in invalid}
            reports += problems
            problems = [
                Diagnostic(UNKNOWN_TYPE, "error", f"{used} is left out", interface.source, part.lines[field])
                for interface in kept.values()
                for part in interface.parts
                for field, used in part.used_types()
                if used in invalid
            ]
        if not kept:
            return []
        for name, interface in self.interfaces.items():
            if name not in kept:
                _left_out[name] = [problem for problem in reports if problem.file == interface.source]
        self.interfaces, self.problems = kept, []
        for interface in kept.values():
            self._check_size(interface)
        return [replace(r, severity="warning", message=f"{r.message}; the definition is left out") for r in reports]

    def _put(self, interface: OwnInterface, *, is_valid: bool) -> None:
        known = self.interfaces.get(interface.name) or _added.get(interface.name) or _shipped(interface.name)
        received = _received_interface(interface.name)
        other = next((o for o in (known, received) if o is not None and o.content != interface.content), None)
        if is_valid and other is not None:
            text = f"{interface.name} is defined differently already: {_difference(other, interface)}"
            hint = f"use one definition, or another name; compare with {other.source}"
            self._report(interface.source, _DIFFERS, 0, text, hint)
        elif known is None:  # the types of a definition with errors are checked too
            self.interfaces[interface.name] = interface
            self._waiting.append(interface)

    def check(self) -> None:
        """Check that every type that is used exists, has an end and a moderate size."""
        while self._waiting:
            added = self._waiting.pop(0)
            for part in added.parts:
                for field, used in part.used_types():
                    self._require(added, part.lines[field], used)
        if not self.problems:
            for added in self.interfaces.values():
                self._check_size(added)

    def _require(self, interface: OwnInterface, line: int, used: str) -> None:
        if used in self.interfaces or used in _added or _shipped(used) is not None:
            return
        source = _located(used)
        if source is not None:
            self.read(used, source)
        elif not any(used == problem.file for problem in self.problems):
            known = [*self.interfaces, *_added, *shipped_message_types(), *rosbags_types()]
            same = sorted(name for name in known if name.endswith(used[used.rindex("/") :]) and "/msg/" in name)
            hint = f"did you mean {same[0]!r}?" if same else did_you_mean(used, known)
            hint = hint or "add the folder of its package with --interfaces DIR"
            self._report(interface.source, UNKNOWN_TYPE, line, f"unknown type {used!r}", hint)

    def _check_size(self, interface: OwnInterface) -> None:
        """Check each field of an interface alone, so that a problem has its line, and then all fields together."""
        for part in interface.parts:
            for fields in (*([field] for field in part.fields), part.fields):
                try:
                    check_size(interface.name, partial(self._fields_of, {interface.name: fields}))
                except DefinitionTooLarge as error:
                    name = fields[0][0]
                    self._report(interface.source, _TOO_LARGE, part.lines[name], f"{name!r}: {error}")
                    break

    def _fields_of(self, definitions: Mapping[str, Fields], type_name: str) -> Fields:
        if type_name in definitions:
            return definitions[type_name]
        added = self.interfaces.get(type_name) or _added.get(type_name) or _shipped(type_name)
        assert added is not None
        return added.parts[0].fields

    def _report(self, file: str, code: str, line: int, message: str, hint: str = "") -> None:
        self.problems.append(Diagnostic(code, "error", message, file, line or None, hint))


def _received_interface(name: str) -> OwnInterface | None:
    """Return an interface that was received and not used yet."""
    text, sender = _received.get(name, ("", ""))
    return (
        OwnInterface(name, tuple(parse_interface(name, text, is_ros1=True)[0]), f"{name} of {sender}")
        if sender
        else None
    )


def _shipped(name: str) -> OwnInterface | None:
    """Return an interface that is shipped with simkit or with rosbags."""
    parts = shipped_parts(name)
    return None if parts is None else OwnInterface(name, parts, "simkit's own definition")


def _difference(before: OwnInterface, now: OwnInterface) -> str:
    """Describe the first difference between two definitions of an interface."""
    for old, other in zip(before.parts, now.parts, strict=True):
        for what, first, second in (
            ("fields", old.fields, other.fields),
            ("constants", old.constants, other.constants),
            ("defaults", sorted(old.defaults.items()), sorted(other.defaults.items())),
        ):
            if first != second:
                pairs = enumerate(zip(first, second, strict=False))
                index = next((i for i, (one_item, other_item) in pairs if one_item != other_item), None)
                if index is None:
                    return f"there were {len(first)} {what}, now there are {len(second)}"
                return f"{what} {first[index][0]!r} and {second[index][0]!r} differ"
    return "the parts differ"
