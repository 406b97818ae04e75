"""Reader of launch files of ROS 1: executes the elements of `.launch` files into a plan of processes and parameters."""

from __future__ import annotations

import math
import os
import re
import shlex
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

from simkit import Params
from simkit.diagnostics import Diagnostics, Where, did_you_mean
from simkit.errors import InputError
from simkit.input_file import read_failure, read_input, read_input_text
from simkit.loaders.resources.xml_reader import parse_file
from simkit.run_files import PackagePaths
from simkit_launch.command_output import command_output
from simkit_launch.frontends.launch_fault import LaunchFault
from simkit_launch.frontends.roslaunch_elements import ATTRIBUTES, CHILDREN, REQUIRED
from simkit_launch.frontends.roslaunch_scope import RoslaunchScope, split_ros_words
from simkit_launch.frontends.roslaunch_substitutions import AnonymousNames, Substitutions, UnsetArgument
from simkit_launch.frontends.roslaunch_values import (
    INVALID_VALUE,
    canonical_name,
    convert_boolean,
    convert_text,
    flat_parameters,
    join_names,
    read_parameters,
)
from simkit_launch.launch_environment import environment_folders
from simkit_launch.launch_packages import LaunchPackages, missing_package_of
from simkit_launch.launch_plan import MOST_INCLUDES, DeclaredArgument, LaunchedProcess, LaunchPlan, StartCondition
from simkit_launch.launch_prefix import WITHOUT_EFFECT, prefix_delay

INVALID_ELEMENT: Final = "SK-LAUNCH-023"
SAME_NAME: Final = "SK-LAUNCH-032"
UNKNOWN_NAME: Final = "SK-LAUNCH-026"
INVALID_ARGUMENT: Final = "SK-LAUNCH-027"
MISSING_FILE: Final = "SK-LAUNCH-028"
UNKNOWN_ARGUMENT: Final = "SK-LAUNCH-031"

_LEGAL_NAME: Final = re.compile(r"[~/A-Za-z][\w/]*")
_SHORTEST_RESPAWN: Final = 0.1  # [s] period in which roslaunch looks for ended processes
_DEEPEST: Final = 50  # files that include one another
_LARGEST_BINARY: Final = 64 << 20  # [bytes]
_LEFT_OUT: Final = object()
"""Value of a parameter whose file or command is missing."""


def read_roslaunch(
    file: Path, arguments: Mapping[str, str], package_paths: PackagePaths | None = None, *, strict: bool = False
) -> LaunchPlan:
    """Execute a launch file of ROS 1 and return its plan.

    Args:
        file: launch file.
        arguments: values of its arguments, as `name:=value` on the command line of roslaunch.
        package_paths: folders of packages by name, or workspaces.
        strict: count warnings as errors.

    Raises:
        LoadError: with all problems of the launch file and of the files that it includes.
    """
    reader = _Reader(file, arguments, package_paths)
    reader.read()
    reader.plan.diagnostics.raise_if_errors(strict)
    return reader.plan


def roslaunch_arguments(
    file: Path, arguments: Mapping[str, str], package_paths: PackagePaths | None = None
) -> list[DeclaredArgument]:
    """Return the arguments that a launch file of ROS 1 declares; those of included files do not reach it."""
    reader = _Reader(file, arguments, package_paths, only_arguments=True)
    reader.read()
    return list(reader.declared.values())


_Handler = Callable[[Params, RoslaunchScope], None]


class _Reader:
    """Reader of a launch file and the files that it includes."""

    def __init__(
        self,
        file: Path,
        arguments: Mapping[str, str],
        package_paths: PackagePaths | None,
        *,
        only_arguments: bool = False,
    ) -> None:
        self.plan = LaunchPlan(file)
        self.diagnostics: Diagnostics = self.plan.diagnostics
        self.given = dict(arguments)
        self.packages = LaunchPackages(file.absolute().parent, package_paths, self.diagnostics)
        self.package_paths = package_paths
        self.only_arguments = only_arguments
        self.declared: dict[str, DeclaredArgument] = {}
        self.included = 0
        self.unset: list[dict[str, Where]] = []  # of each open file, the arguments that it uses without a value
        self.node_places: dict[str, Where] = {}
        self.handlers: dict[str, _Handler] = {
            "arg": self._argument,
            "group": self._group,
            "node": self._node,
            "test": self._test,
            "param": self._param,
            "rosparam": self._rosparam,
            "remap": self._remap,
            "env": self._env,
            "include": self._include,
            "machine": self._machine,
            "master": self._master,
        }

    def read(self) -> None:
        """Read the launch file."""
        self._add_resource_paths((*os.environ.items(), *self.packages.variables.items()))
        root = self._parsed(self.plan.file)
        if root is None:
            return
        scope = RoslaunchScope(self.plan.file, arguments=dict(self.given))
        unset = self._file(root, scope)
        self.plan.arguments = {name: scope.arguments[name] for name in self.declared if name in scope.arguments}
        self._report_arguments(root, unset)

    def _report_arguments(self, root: Params, unset: Mapping[str, Where]) -> None:
        """Report the arguments that have no value, and the given ones that the file does not declare."""
        if unset:
            names = list(unset)
            several = len(names) > 1
            message = f"the argument{'s' * several} {', '.join(names)} need{'s' * (not several)} a value"
            hint = "give " + " ".join(f"{name}:=…" for name in names)
            self.diagnostics.error(INVALID_ARGUMENT, message, unset[names[0]], hint)
        for name in self.given:
            if name not in self.declared:
                near = did_you_mean(name, self.declared)
                known = near or "it has " + (", ".join(self.declared) or "none")
                message = f"the launch file has no argument {name!r}; {known}"
                self.diagnostics.warning(UNKNOWN_ARGUMENT, message, root.where)

    # ------------------------------------------------------------------ files

    def _parsed(self, file: Path) -> Params | None:
        document = parse_file(file, self.diagnostics, keep_space=True)
        if document is None:
            return None
        root = document.root
        if root.name != "launch":
            message = f"found the outermost element <{root.name}>; a launch file has <launch>"
            self.diagnostics.error(INVALID_ELEMENT, message, root.where, did_you_mean(root.name, ["launch"]))
            return None
        return root

    def _file(self, root: Params, scope: RoslaunchScope) -> dict[str, Where]:
        """Execute a file; return the arguments that it declares and uses, but that have no value."""
        self.unset.append({})
        if reason := root.attributes.get("deprecated"):
            self.diagnostics.note(WITHOUT_EFFECT, f"this launch file is deprecated: {reason}", root.where)
        self._check_names(root)
        self._children(root, scope)
        return self.unset.pop()

    def _children(self, parent: Params, scope: RoslaunchScope) -> None:
        for element in parent.children:
            if element.name in CHILDREN[parent.name] and (element.name == "arg" or not self.only_arguments):
                self._element(element, scope, self.handlers[element.name])

    def _element(
        self, element: Params, scope: RoslaunchScope, handler: _Handler, failed: set[str] | None = None
    ) -> None:
        """Execute an element; an error in it is recorded, and the next element follows.

        Args:
            element: element.
            scope: values for its substitutions.
            handler: function that executes it.
            failed: receives the name of an argument that has an error, so that its uses are no further errors; None
                for that of the scope.
        """
        self._check_names(element)
        try:
            if self._applies(element, scope):
                for name in REQUIRED.get(element.name, ()):
                    if name not in element.attributes:
                        raise LaunchFault(INVALID_ELEMENT, f"the attribute {name!r} is missing")
                handler(element, scope)
        except UnsetArgument as error:
            for name in error.names:
                if name in scope.declared and name not in scope.failed:
                    self.unset[-1].setdefault(name, scope.declared[name])
                elif name not in scope.failed:
                    self._record(UnsetArgument(name, scope.arguments), element)
        except LaunchFault as error:
            self._record(error, element)
        else:
            return
        if element.name == "arg":
            (scope.failed if failed is None else failed).add(element.attributes.get("name", ""))

    def _record(self, error: LaunchFault, element: Params) -> None:
        name = element.attributes.get("name") or element.attributes.get("test-name")
        shown = f'<{element.name} name="{name}">' if name else f"<{element.name}>"
        self.diagnostics.error(error.code, f"{shown}: {error}", element.where, error.hint)

    def _check_names(self, element: Params) -> None:
        """Warn of attributes and inner elements that ROS 1 does not know; roslaunch ignores them, too."""
        known = ("if", "unless", *ATTRIBUTES[element.name])
        for name in element.attributes:
            if name not in known and ":" not in name and name != "xmlns":
                hint = did_you_mean(name, known) or f"it has {', '.join(sorted(known))}"
                message = f"<{element.name}> has no attribute {name!r}; it has no effect"
                self.diagnostics.warning(UNKNOWN_NAME, message, element.where, hint)
        inner = CHILDREN.get(element.name, ())
        for child in element.children:
            if child.name not in inner:
                hint = did_you_mean(child.name, inner) or (f"it has {', '.join(sorted(inner))}" if inner else "")
                message = f"<{element.name}> has no element <{child.name}>; it has no effect"
                self.diagnostics.warning(UNKNOWN_NAME, message, child.where, hint)

    def _applies(self, element: Params, scope: RoslaunchScope) -> bool:
        """Evaluate `if` and `unless`."""
        condition = self._optional(element, "if", scope)
        inverse = self._optional(element, "unless", scope)
        if condition is not None and inverse is not None:
            raise LaunchFault(INVALID_ELEMENT, "the attributes 'if' and 'unless' exclude each other")
        if condition is not None:
            return convert_boolean(condition)
        return inverse is None or not convert_boolean(inverse)

    # ------------------------------------------------------------------ attributes

    def _resolved(self, text: str, element: Params, scope: RoslaunchScope) -> str:
        names = Substitutions(
            scope.arguments, scope.declared, scope.anonymous, scope.file, self.packages, self.diagnostics
        )
        return names.resolve(text, element.where)

    def _optional(self, element: Params, name: str, scope: RoslaunchScope) -> str | None:
        text = element.attributes.get(name)
        return None if text is None else self._resolved(text, element, scope)

    def _required(self, element: Params, name: str, scope: RoslaunchScope) -> str:
        return self._resolved(element.attributes[name], element, scope)

    def _flag(self, element: Params, name: str, scope: RoslaunchScope) -> bool:
        text = self._optional(element, name, scope)
        if text is None:
            return False
        if text.lower() not in ("true", "false"):
            raise LaunchFault(INVALID_VALUE, f"attribute {name!r}: found {text!r}; expected true or false")
        return text.lower() == "true"

    def _namespace(self, element: Params, scope: RoslaunchScope) -> str:
        namespace = self._optional(element, "ns", scope)
        if namespace == "":
            raise LaunchFault(INVALID_ELEMENT, "the attribute 'ns' is empty; leave it out for no namespace")
        if self._flag(element, "clear_params", scope) and not namespace and element.name in ("group", "include"):
            raise LaunchFault(INVALID_ELEMENT, "the attribute 'clear_params' needs the attribute 'ns'")
        return namespace or ""

    # ------------------------------------------------------------------ arguments, groups, files

    def _argument(self, element: Params, scope: RoslaunchScope) -> None:
        name = self._required(element, "name", scope)
        value = self._optional(element, "value", scope)
        default = self._optional(element, "default", scope)
        if value is not None and default is not None:
            raise LaunchFault(INVALID_ARGUMENT, f"argument {name!r} has both 'value' and 'default'; write one of them")
        if name in scope.declared and not scope.passes_all:
            raise LaunchFault(INVALID_ARGUMENT, f"argument {name!r} is declared twice, first in {scope.declared[name]}")
        scope.declared[name] = element.where
        if len(self.unset) == 1 and value is None:
            description = element.attributes.get("doc", "")
            self.declared[name] = DeclaredArgument(name, default, description, where=element.where)
        if value is not None:
            if name in scope.arguments and not scope.passes_all:
                message = f"argument {name!r} has a fixed value, so that it cannot be given"
                raise LaunchFault(INVALID_ARGUMENT, message, "write default=… instead of value=…")
            scope.arguments[name] = value
        elif default is not None:
            scope.arguments.setdefault(name, default)

    def _group(self, element: Params, scope: RoslaunchScope) -> None:
        self._children(element, scope.child(self._namespace(element, scope)))

    def _include(self, element: Params, scope: RoslaunchScope) -> None:
        file = self.packages.source_of(Path(self._required(element, "file", scope)))
        passes_all = self._flag(element, "pass_all_args", scope)
        inner = scope.child(self._namespace(element, scope))
        inner.file, inner.passes_all = file, passes_all
        inner.arguments = dict(scope.arguments) if passes_all else {}
        inner.declared = {}
        inner.anonymous = AnonymousNames(used=scope.anonymous.used)
        passed: dict[str, Where] = {}

        def pass_argument(child: Params, outer: RoslaunchScope) -> None:
            name = self._required(child, "name", outer)
            value = self._optional(child, "value", outer)
            default = self._optional(child, "default", outer)
            if (value is None) == (default is None):
                raise LaunchFault(INVALID_ARGUMENT, f"argument {name!r} needs one of 'value' and 'default'")
            if name in passed and not passes_all:
                message = f"argument {name!r} is passed twice, first in {passed[name]}"
                raise LaunchFault(INVALID_ARGUMENT, message)
            passed[name] = child.where
            if value is not None:
                inner.arguments[name] = value
            else:
                inner.arguments.setdefault(name, default or "")

        inner.failed = set(scope.failed) if passes_all else set()
        for child in element.children:
            if child.name == "arg":
                self._element(child, scope, pass_argument, inner.failed)
            elif child.name == "env":
                self._element(child, scope, lambda child, outer: self._set_variable(child, outer, inner))
        root = self._included_root(file, element)
        if root is None:
            return
        for name in self._file(root, inner):
            message = f"<include>: the file {file} needs the argument {name!r}"
            hint = f'write <arg name="{name}" value="…"/> into the <include>'
            self.diagnostics.error(INVALID_ARGUMENT, message, element.where, hint)
        for name, where in passed.items():
            if name not in inner.declared and not passes_all:
                near = did_you_mean(name, inner.declared)
                known = near or "it has " + (", ".join(inner.declared) or "none")
                message = f"the file {file} has no argument {name!r}, which roslaunch refuses; {known}"
                self.diagnostics.warning(UNKNOWN_ARGUMENT, message, where)

    def _included_root(self, file: Path, element: Params) -> Params | None:
        if len(self.unset) >= _DEEPEST:
            message = f"files include one another more than {_DEEPEST} deep, such as {file}"
            raise LaunchFault(INVALID_ELEMENT, message)
        if not self._exists(file, element, "the included file"):
            return None
        self.included += 1
        if self.included > MOST_INCLUDES:  # ten includes in each of ten files are 10 000 000 000 files
            message = f"the launch file includes more than {MOST_INCLUDES} files"
            self.diagnostics.error(INVALID_ELEMENT, message, element.where, "remove repeated includes")
            self.diagnostics.raise_if_errors()
        return self._parsed(file)

    def _source(self, path: str) -> str:
        return str(self.packages.source_of(Path(path)))

    def _exists(self, file: Path, element: Params, role: str) -> bool:
        """Check whether a file exists, and warn of a missing one."""
        if file.is_file():
            return True
        package = missing_package_of(file)
        if package and self.packages.is_reported(package, element.where):
            return False
        reason = f"its package {package!r} is not there" if package else "there is no such file"
        shown = file.name if package else file
        self.diagnostics.warning(MISSING_FILE, f"{role} {shown} is left out: {reason}", element.where)
        return False

    # ------------------------------------------------------------------ names and variables

    def _remap(self, element: Params, scope: RoslaunchScope) -> None:
        old, new = (canonical_name(self._required(element, name, scope)) for name in ("from", "to"))
        for name in (old, new):
            if not _LEGAL_NAME.fullmatch(name):
                raise LaunchFault(
                    INVALID_ELEMENT, f"found {name!r}; expected the name of a topic, service or parameter"
                )
        scope.remappings.pop(old, None)
        scope.remappings[old] = new

    def _env(self, element: Params, scope: RoslaunchScope) -> None:
        self._set_variable(element, scope, scope)

    def _set_variable(self, element: Params, scope: RoslaunchScope, target: RoslaunchScope) -> None:
        name, value = (self._required(element, key, scope) for key in ("name", "value"))
        if not name:
            raise LaunchFault(INVALID_ELEMENT, "the attribute 'name' is empty")
        target.environment[name] = value
        self._add_resource_paths([(name, value)])

    def _add_resource_paths(self, environment: Iterable[tuple[str, str]]) -> None:
        folders = environment_folders(environment)
        self.plan.resource_paths = list(dict.fromkeys((*self.plan.resource_paths, *folders)))

    # ------------------------------------------------------------------ parameters

    def _param(self, element: Params, scope: RoslaunchScope) -> None:
        name = self._required(element, "name", scope).strip()
        value = self._parameter_value(element, scope)
        if value is _LEFT_OUT:
            return
        if name.startswith("~"):
            scope.private[name[1:]] = value
        else:
            self._set_parameter(join_names(scope.namespace + "/", name), value)

    def _parameter_value(self, element: Params, scope: RoslaunchScope) -> Any:
        sources = ("value", "textfile", "binfile", "command")
        given = [name for name in sources if name in element.attributes]
        if len(given) != 1:
            found = " and ".join(map(repr, given)) or "none"
            raise LaunchFault(INVALID_ELEMENT, f"found {found}; expected one of {', '.join(map(repr, sources))}")
        text = self._required(element, given[0], scope)
        kind = element.attributes.get("type") or "auto"
        if given[0] == "value":
            return convert_text(text.strip(), kind)
        if given[0] == "command":
            try:
                words = [self._source(word) if word.startswith("/") else word for word in shlex.split(text)]
            except ValueError as error:
                raise LaunchFault(INVALID_VALUE, f"command {text!r}: {error}") from None
            output = command_output(words, element.where, self.diagnostics, self.package_paths)
            return _LEFT_OUT if output is None else convert_text(output, kind)
        text = self._source(text)
        if not self._exists(Path(text), element, "the parameter from file"):
            return _LEFT_OUT
        try:
            if given[0] == "binfile":
                return read_input(text, _LARGEST_BINARY)
            return convert_text(read_input_text(text), kind)
        except (OSError, UnicodeDecodeError) as error:
            raise LaunchFault(INVALID_VALUE, f"{text} cannot be read: {read_failure(error)}") from None

    def _rosparam(self, element: Params, scope: RoslaunchScope) -> None:
        command = self._optional(element, "command", scope) or "load"
        file = self._optional(element, "file", scope)
        namespace, name = (self._optional(element, key, scope) or "" for key in ("ns", "param"))
        target = join_names(namespace, name)
        if command not in ("load", "dump", "delete"):
            hint = did_you_mean(command, ("load", "dump", "delete"))
            raise LaunchFault(INVALID_ELEMENT, f"found command={command!r}; expected load, dump or delete", hint)
        if command == "delete" and file is not None:
            raise LaunchFault(INVALID_ELEMENT, "the command 'delete' has no attribute 'file'")
        if command == "dump":
            message = f"no parameters are written to {file}: the plan of the launch shows them"
            self.diagnostics.note(WITHOUT_EFFECT, message, element.where, "simkit launch FILE --print")
        if command != "load":  # roslaunch deletes before it sets any parameter, and here the server is empty then
            return
        data = self._rosparam_values(element, scope, file)
        if data is _LEFT_OUT:
            return
        if not target and not isinstance(data, dict):
            message = "the values have no names; name the parameter with the attribute 'param', or write NAME: VALUE"
            raise LaunchFault(INVALID_VALUE, message)
        self._set_parameter(join_names(scope.namespace + "/", target.removeprefix("~")), data)

    def _rosparam_values(self, element: Params, scope: RoslaunchScope, file: str | None) -> Any:
        text, source = element.value, "the text"
        if file:
            file = self._source(file)
            if not self._exists(Path(file), element, "the parameter file"):
                return _LEFT_OUT
            try:
                text, source = read_input_text(file), file
            except (OSError, UnicodeDecodeError) as error:
                raise LaunchFault(INVALID_VALUE, f"{file} cannot be read: {read_failure(error)}") from None
        if self._flag(element, "subst_value", scope):
            text = self._resolved(text, element, scope)
        return read_parameters(text, source)

    def _set_parameter(self, name: str, value: Any) -> None:
        for key, single in flat_parameters(name, value):
            if single is None:
                raise LaunchFault(INVALID_VALUE, f"the parameter {key} has no value; write {key.split('/')[-1]}: VALUE")
            self.plan.parameters[key] = single

    # ------------------------------------------------------------------ nodes

    def _test(self, element: Params, scope: RoslaunchScope) -> None:
        message = f"the test {element.attributes['test-name']!r} is not started: only rostest starts it"
        self.diagnostics.note(WITHOUT_EFFECT, message, element.where)

    def _machine(self, element: Params, scope: RoslaunchScope) -> None:
        message = f"machine {element.attributes['name']!r}: everything runs on this machine"
        self.diagnostics.note(WITHOUT_EFFECT, message, element.where)

    def _master(self, element: Params, scope: RoslaunchScope) -> None:
        self.diagnostics.note(WITHOUT_EFFECT, "<master> has no effect, as in roslaunch", element.where)

    def _node(self, element: Params, scope: RoslaunchScope) -> None:
        name, package, executable = (self._required(element, key, scope) for key in ("name", "pkg", "type"))
        for key, text in (("name", name), ("pkg", package), ("type", executable)):
            if not text.strip():
                raise LaunchFault(INVALID_ELEMENT, f"the attribute {key!r} is empty")
        if "/" in name:
            hint = "give the namespace with the attribute 'ns'"
            raise LaunchFault(INVALID_ELEMENT, f"found name={name!r}; the name of a node has no '/'", hint)
        inner = scope.child(self._namespace(element, scope))
        full_name = f"{inner.namespace}/{name}"
        if full_name in self.node_places:
            first = self.node_places[full_name]
            hint = 'write name="$(anon ID)" for names that differ'
            raise LaunchFault(SAME_NAME, f"there are two nodes {full_name}; the first one is in {first}", hint)
        self.node_places[full_name] = element.where
        settings = self._process_settings(element, scope, package, executable)
        self._node_children(element, inner, full_name)
        words = self._words(element, scope)
        own_name, own_namespace, remappings, private, plain = split_ros_words(words)
        self._set_parameter(full_name, private)
        self.plan.processes.append(
            LaunchedProcess(
                number=len(self.plan.processes) + 1,
                kind="node",
                package=package,
                executable=executable,
                name=own_name or name,
                namespace=own_namespace or inner.namespace,
                remappings=(*remappings, *inner.remappings.items()),
                arguments=tuple(plain),
                environment=dict(inner.environment),
                is_ros1=True,
                where=element.where,
                **settings,
            )
        )

    def _node_children(self, element: Params, inner: RoslaunchScope, full_name: str) -> None:
        """Execute the elements of a node: parameters of the node, and names and variables for it only."""
        own = replace(inner, namespace=full_name, private={})

        def set_private(child: Params, _: RoslaunchScope) -> None:
            name = self._required(child, "name", inner).strip()
            value = self._parameter_value(child, inner)
            if value is not _LEFT_OUT:
                own.private[name.lstrip("~")] = value

        handlers: dict[str, _Handler] = {
            "param": set_private,
            "rosparam": lambda child, _: self._rosparam(child, own),
            "remap": lambda child, _: self._remap(child, inner),
            "env": lambda child, _: self._env(child, inner),
        }
        for child in element.children:
            if child.name in handlers:
                self._element(child, inner, handlers[child.name])
        for name, value in (*inner.private.items(), *own.private.items()):
            self._set_parameter(f"{full_name}/{name}", value)

    def _words(self, element: Params, scope: RoslaunchScope) -> list[str]:
        text = self._optional(element, "args", scope) or ""
        try:
            return shlex.split(text)
        except ValueError as error:
            raise LaunchFault(INVALID_VALUE, f"args={text!r}: {error}") from None

    def _process_settings(
        self, element: Params, scope: RoslaunchScope, package: str, executable: str
    ) -> dict[str, Any]:
        """Return how the process of a node starts and ends, and its folder."""
        required, respawns = (self._flag(element, key, scope) for key in ("required", "respawn"))
        if required and respawns:
            raise LaunchFault(INVALID_ELEMENT, "the attributes 'required' and 'respawn' exclude each other")
        delay = self._number(element, "respawn_delay", scope)
        self._one_of(element, "output", ("log", "screen"), scope)
        prefix = self._optional(element, "launch-prefix", scope) or ""
        folder = self._one_of(element, "cwd", ("ROS_HOME", "ros_home", "node"), scope)
        return {
            "condition": StartCondition(delay=prefix_delay(prefix, element.where, self.diagnostics)),
            "respawn_delay": max(delay, _SHORTEST_RESPAWN) if respawns else None,
            "ends_run": required,
            "folder": self._program_folder(package, executable) if folder == "node" else None,
        }

    def _number(self, element: Params, name: str, scope: RoslaunchScope) -> float:
        text = self._optional(element, name, scope)
        if text is None:
            return 0.0
        value = convert_text(text, "double")
        if not 0.0 <= value < math.inf:
            raise LaunchFault(INVALID_VALUE, f"attribute {name!r}: found {text!r}; expected a number of seconds")
        return float(value)

    def _one_of(self, element: Params, name: str, allowed: tuple[str, ...], scope: RoslaunchScope) -> str | None:
        text = self._optional(element, name, scope)
        if text is not None and text not in allowed:
            shown = " or ".join(allowed)
            raise LaunchFault(INVALID_ELEMENT, f"attribute {name!r}: found {text!r}; expected {shown}")
        return text

    def _program_folder(self, package: str, executable: str) -> Path | None:
        try:
            return self.packages.workspace.executable(package, executable).file.parent
        except InputError:
            return self.packages.workspace.package(package)
