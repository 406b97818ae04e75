"""Expansion of a xacro file into plain `Params`, in which every element keeps its original file and line."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Mapping
from pathlib import Path
from xml.dom import minidom

from simkit.diagnostics import NOWHERE, Diagnostics, Where, did_you_mean
from simkit.loaders.resources.uri_resolver import Resolver
from simkit.loaders.resources.xml_reader import Document
from simkit.loaders.xacro.dom import place_of, to_document, to_params
from simkit.loaders.xacro.expansion_limits import MAX_FILES_DEEP, BoundError, Budget, ExpansionError
from simkit.loaders.xacro.expression import Evaluator, Function, Names, Value
from simkit.loaders.xacro.expression_functions import DIRECT_NAMES, math_functions, python_functions, tokenize
from simkit.loaders.xacro.file_access import FileAccess, MissingError
from simkit.loaders.xacro.isolated_xacro import MACRO_ARGUMENT, XacroModule, import_private_xacro

MAX_EXPANDED = 50_000
MAX_COPIED = 300_000
_ROS_VARIABLES = {"ROS_VERSION": "2", "ROS_PYTHON_VERSION": "3", "ROS_DISTRO": "jazzy"}
_CALL = 5  # cost of a macro call, counted in elements
_TOKEN = re.compile(r"(?P<escaped>\$\$+[{(])|(?P<expression>\$\{[^}]*\})|(?P<command>\$\([^)]*\))|[^$]+|\$[^{($]+|\$$")


def expand(
    document: Document, resolver: Resolver, arguments: Mapping[str, str], diagnostics: Diagnostics
) -> Document | None:
    """Expand a file; return None, with an error recorded, if it cannot be expanded.

    Args:
        document: the parsed file.
        resolver: finds packages and included files.
        arguments: values of the file's `<xacro:arg>`.
        diagnostics: receives the problems; xacro stops at the first error.
    """
    try:
        engine = import_private_xacro()
    except ImportError as error:
        message = f"the file is xacro, but {error.name or error} is not installed"
        diagnostics.error("SK-XACRO-006", message, document.root.where, "pip install xacro")
        return None
    return _Expansion(engine, document, resolver, arguments, diagnostics).run()


class _Expansion:
    """One expansion of one file."""

    def __init__(
        self,
        engine: XacroModule,
        document: Document,
        resolver: Resolver,
        arguments: Mapping[str, str],
        diagnostics: Diagnostics,
    ) -> None:
        self.engine, self.document, self.diagnostics = engine, document, diagnostics
        self.where = document.root.where
        self.files = FileAccess(resolver, diagnostics, lambda: self.where)
        self.unset_variables: set[str] = set()
        self.budget = Budget()
        self.given = {str(k): str(v) for k, v in arguments.items()}
        self.arguments: dict[str, str] = dict(self.given)
        self.declared: set[str] = set()
        self.used: set[str] = set()  # arguments that a $(arg ...) has read, also without an <xacro:arg>
        self.expanded = self.copied = 0
        self.sizes: dict[int, int] = {}
        self.calls: list[tuple[str, Where]] = []
        self.folder = document.folder or resolver.base
        self.has_left_out = False

    # ------------------------------------------------------------------ the run

    def run(self) -> Document | None:
        engine, top = self.engine, to_document(self.document.root)
        self._replace()
        engine.filestack = [str(self.document.path or (self.folder or Path.cwd()) / "text.xacro")]
        engine.macrostack = []
        try:
            engine.eval_all(top.documentElement, engine.Table(), engine.Table(self._global_names()))
        except RecursionError:
            self._fail("SK-XACRO-003", "the expansion is nested too deeply; a macro or an include calls itself")
            return None
        except MissingError as error:
            self._fail("SK-XACRO-002", str(error), error.hint)
            return None
        except BoundError as error:
            self._fail("SK-XACRO-003", f"expansion stopped: {error}")
            return None
        except Exception as error:  # noqa: BLE001 - xacro raises any exception of Python; only here the place is known
            inner = _inner_error(error)
            if isinstance(inner, (MissingError, BoundError)):
                code = "SK-XACRO-002" if isinstance(inner, MissingError) else "SK-XACRO-003"
                self._fail(code, str(inner), getattr(inner, "hint", ""))
            else:
                self._fail("SK-XACRO-001", " ".join(str(error).split()) or type(error).__name__, self._hint(error))
            return None
        self._report_unknown_arguments()
        arguments = {name: self.arguments.get(name, "") for name in sorted(self.declared)}
        root = to_params(top.documentElement, self.diagnostics)
        return Document(root, self.document.path, self.document.text, arguments)

    def _fail(self, code: str, message: str, hint: str = "") -> None:
        """Record one error at the element that is being expanded, with the macro calls that led there."""
        trail = "".join(f"; in <xacro:{name}> of {where}" for name, where in reversed(self.calls[-4:]))
        self.diagnostics.error(code, f"xacro: {message}{trail}", self.where, hint)

    def _hint(self, error: Exception) -> str:
        text = str(error)
        missing = re.search(r"name '(\w+)' is not defined", text)
        if missing:
            return did_you_mean(missing.group(1), self._known)
        unknown = re.search(r"unknown macro name: xacro:([\w.]+)", text)
        if unknown:
            return did_you_mean(unknown.group(1), [*self._macros, *_ELEMENT_NAMES])
        return ""

    def _report_unknown_arguments(self) -> None:
        for name in self.given:
            if name not in self.declared and name not in self.used:
                known = ", ".join(sorted(self.declared)) or "none"
                message = (
                    f"the file has no argument {name!r}, so its value does not change the robot; known are {known}"
                )
                hint = did_you_mean(name, self.declared)
                self.diagnostics.warning("SK-XACRO-004", message, self.document.root.where, hint)

    # ------------------------------------------------------------------ replacements of xacro's own functions

    def _replace(self) -> None:
        engine = self.engine
        self._known: set[str] = set()
        self._macros: set[str] = set()
        engine.re_macro_arg = MACRO_ARGUMENT
        engine.warning = engine.message = engine.error = lambda *args, **_: self._report_message(args)
        engine.print_location = lambda *_: None
        engine.eval_text = self._text
        engine.parse = self._parse
        engine.get_include_files = self._include_files
        engine.substitution_args_context = {"arg": self.arguments}
        for name in ("check_attrs", "reqd_attrs"):
            setattr(engine, name, self._with_place(getattr(engine, name)))
        self._count_work(engine.eval_all, engine.handle_macro_call)

    def _with_place(self, original: Callable[..., list[object]]) -> Callable[..., list[object]]:
        def call(tag: minidom.Element, *args: object) -> list[object]:
            self.where = place_of(tag) if place_of(tag) is not NOWHERE else self.where
            answer = original(tag, *args)
            if tag.tagName == "xacro:arg":
                self.declared.add(str(answer[0]))
            elif tag.tagName == "xacro:macro":
                self._macros.add(str(answer[0]))
            return answer

        return call

    def _count_work(self, eval_all: Callable[..., None], handle_macro_call: Callable[..., bool]) -> None:
        """Replace two functions of xacro by functions that also count elements and store the current file and line."""

        def visit(node: minidom.Element, macros: Names, symbols: Names) -> None:
            self._enter_element(node, 1)
            eval_all(node, macros, symbols)

        def call(node: minidom.Element, macros: Names, symbols: Names) -> bool:
            if not node.tagName.startswith("xacro:"):
                return False
            self._enter_element(node, _CALL)
            if self._leave_out_call(node, macros, symbols):
                return True
            if node.tagName != "xacro:call":
                self._count_body(node.tagName[6:], macros, symbols)
            self.calls.append((node.tagName[6:], self.where))
            done = bool(handle_macro_call(node, macros, symbols))
            self.calls.pop()
            return done

        self.engine.eval_all = visit
        self.engine.handle_macro_call = call

    def _enter_element(self, node: minidom.Element, elements: int) -> None:
        where = place_of(node)
        self.where = self.where if where is NOWHERE else where
        self.expanded += elements
        if self.expanded > MAX_EXPANDED:
            raise BoundError(f"it creates more than {MAX_EXPANDED} elements")

    def _count_body(self, name: str, macros: Names, symbols: Names) -> None:
        """Count a macro's body, which xacro copies as a whole at every call, even if conditions remove parts of it."""
        try:
            _, _, macro = self.engine.resolve_macro(name, macros, symbols)
        except KeyError:
            return
        if id(macro.body) not in self.sizes:
            self.sizes[id(macro.body)] = len(macro.body.getElementsByTagName("*"))
        self.copied += self.sizes[id(macro.body)]
        if self.copied > MAX_COPIED:
            raise BoundError(f"macros copy more than {MAX_COPIED} elements")

    def _leave_out_call(self, node: minidom.Element, macros: Names, symbols: Names) -> bool:
        """Remove the call of a macro that is unknown because a file was left out; return True if it was removed."""
        name = node.tagName[6:]
        if not self.has_left_out or name in _ELEMENT_NAMES:
            return False
        try:
            self.engine.resolve_macro(name, macros, symbols)
        except KeyError:
            self._leave_out(f"<{node.tagName}> is left out: no macro has this name, and a file is left out")
            if node.parentNode is not None:
                node.parentNode.removeChild(node)
            return True
        return False

    def _leave_out(self, message: str, hint: str = "") -> None:
        self.has_left_out = True
        self.diagnostics.warning("SK-XACRO-008", f"xacro: {message}", self.where, hint)

    def _report_message(self, args: tuple[object, ...]) -> None:
        """Record a message of the file, or of xacro about the file, as a warning."""
        self.diagnostics.warning("SK-XACRO-005", "xacro: " + " ".join(map(str, args)), self.where)

    # ------------------------------------------------------------------ files

    def _current_folder(self) -> Path | None:
        """Return the folder of the file that is being expanded."""
        return Path(self.engine.filestack[-1]).parent

    def _include_files(self, spec: str, symbols: Names) -> list[str]:
        text = str(self._text(spec, symbols))
        if re.search(r"[*?\[]", text):
            return self.files.find_pattern(text, self._current_folder())
        return [text]

    def _parse(self, _text: object, filename: str) -> minidom.Document:
        if len(self.engine.filestack) > MAX_FILES_DEEP:
            raise BoundError(f"files include one another more than {MAX_FILES_DEEP} deep: {filename}")
        self.engine.filestack.pop()
        try:
            path = self.files.find_file(filename, self._current_folder())
        except MissingError as error:
            if self.files.resolver.missing_includes:
                self.engine.filestack.append(filename)
                self._leave_out(f"an included file is left out: {error}", error.hint)
                return minidom.parseString("<robot/>")
            raise self.engine.XacroException(str(error), exc=_MissingFile(error)) from error
        self.engine.filestack.append(str(path))
        root = self.files.read_xml(path)
        if not root.name:
            raise ExpansionError(f"{path} is empty")
        return to_document(root)

    def _yaml(self, filename: str) -> Value:
        path = self.files.find_file(str(filename), self._current_folder())
        evaluator = Evaluator({}, self.budget)
        content = self.files.read_yaml(path, evaluator.run, self.budget)
        return self.engine.YamlListWrapper.wrap(content)

    # ------------------------------------------------------------------ texts

    def _text(self, text: str, symbols: Names) -> Value:
        """Replace `${...}` and `$(...)` in a text; a text that is one expression keeps the type of its value."""
        if "$" not in text:
            return text
        results: list[Value] = []
        position = 0
        while position < len(text):
            token = _TOKEN.match(text, position)
            if token is None:
                raise ExpansionError(f"invalid text: {text[position : position + 60]}")
            position = token.end()
            if token.lastgroup == "expression":
                results.append(self._expression(token.group()[2:-1], symbols))
            elif token.lastgroup == "command":
                results.append(self._command(str(self._text(token.group()[2:-1], symbols)), symbols))
            elif token.lastgroup == "escaped":
                results.append(token.group()[1:])
            else:
                results.append(token.group())
        if len(results) == 1:
            return self.budget.value(results[0])
        self.budget.weigh(results)
        joined = "".join(map(str, results)).replace("file://package://", "package://")
        return self.budget.value(joined)

    def _expression(self, text: str, symbols: Names) -> Value:
        inner = str(self._text(text, symbols))
        try:
            return Evaluator(symbols, self.budget).run(inner)
        except (BoundError, MissingError):
            raise
        except ExpansionError as error:
            self._known |= _table_names(symbols)
            where = "" if "when evaluating" in str(error) else f", when evaluating ${{{inner}}}"
            raise ExpansionError(f"{error}{where}") from None

    def _environment_variable(self, name: str) -> str:
        """Return an environment variable; on a machine without ROS, a variable that every ROS installation sets."""
        value = self._variable(name)
        if value is not None:
            return value
        if name not in _ROS_VARIABLES:
            raise ExpansionError(f"the environment variable {name} is not set")
        value = _ROS_VARIABLES[name]
        if name not in self.unset_variables:
            self.unset_variables.add(name)
            self._report_message((f"the environment variable {name} is not set; {value} is used",))
        return value

    def _variable(self, name: str) -> str | None:
        """Return an environment variable; note that the file depends on it, unless every ROS installation sets it."""
        if name in os.environ and name not in _ROS_VARIABLES:
            self.files.resolver.variables_read.setdefault(name, self.where)
        return os.environ.get(name)

    def _command(self, text: str, symbols: Names | None) -> Value:
        words = text.split()
        name, rest = (words[0], words[1:]) if words else ("", [])
        if name == "find" and len(rest) == 1:
            return self.files.package_folder(rest[0], self._current_folder())
        if name == "arg" and len(rest) == 1:
            return self._argument(rest[0])
        if name == "env" and len(rest) == 1:
            return self._environment_variable(rest[0])
        if name == "optenv" and rest:
            value = self._variable(rest[0])
            return " ".join(rest[1:]) if value is None else value
        if name in ("dirname", "cwd") and not rest:
            return str(self._current_folder() if name == "dirname" else Path.cwd())
        if name == "eval" and rest:
            self.used.update(known for known in self.arguments if re.search(rf"\b{re.escape(known)}\b", text))
            return Evaluator({**_literals(self.arguments), **self._global_names()}, self.budget).run(text[4:])
        known = ("find", "arg", "env", "optenv", "dirname", "cwd", "eval")
        raise ExpansionError(f"unknown substitution $({text}); known are {', '.join(known)}")

    def _argument(self, name: str) -> str:
        if name not in self.arguments:
            known = ", ".join(sorted(self.arguments)) or "none"
            remedy = f"set it with --xacro-arg {name}=VALUE (Python: xacro_args)"
            raise ExpansionError(f"the argument {name!r} has no value (arguments with values: {known}); {remedy}")
        self.used.add(name)
        return self.arguments[name]

    def _global_names(self) -> dict[str, Value]:
        """Return xacro's own names, which every expression can use."""
        evaluator = Evaluator({}, self.budget)
        space = self.engine.NameSpace
        python, mathematics = python_functions(evaluator), math_functions()
        spaces = {"python": space(), "math": space(), "xacro": space()}
        functions = {
            "load_yaml": Function(self._yaml),
            "abs_filename": Function(lambda spec: str((self._current_folder() or Path.cwd()) / str(spec))),
            "dotify": Function(self.engine.YamlDictWrapper),
            "arg": Function(self._argument),
            "tokenize": Function(tokenize),
            "fatal": Function(self._fatal),
            "print_location": Function(lambda: ""),
        }
        for function_name in ("message", "warning", "error"):
            functions[function_name] = Function(self._print_message)
        for name, table in (("python", python), ("math", mathematics), ("xacro", functions)):
            dict.update(spaces[name], table)
        direct = {name: python[name] for name in DIRECT_NAMES}
        commands = {
            "find": Function(lambda name: self.files.package_folder(str(name), self._current_folder())),
            "env": Function(lambda name: self._command(f"env {name}", None)),
            "optenv": Function(self._optional_variable),
        }
        shared = {name: functions[name] for name in ("load_yaml", "abs_filename", "dotify", "arg")}
        return {**mathematics, **direct, **shared, **commands, **spaces, "true": True, "false": False}

    def _optional_variable(self, name: object, default: Value = "") -> Value:
        value = self._variable(str(name))
        return default if value is None else value

    def _print_message(self, *args: object, **_: object) -> str:
        self._report_message(args)
        return ""

    def _fatal(self, *args: object) -> None:
        raise ExpansionError(" ".join(map(str, args)))


class _MissingFile(OSError):
    """Error for a missing include; xacro accepts this type of error if the include is `optional`."""

    def __init__(self, error: MissingError) -> None:
        super().__init__(str(error))
        self.error = error


def _inner_error(error: BaseException) -> BaseException:
    """Return simkit's own error if an exception of xacro contains one, else the inner or the given exception."""
    inner: object = getattr(error, "exc", None)
    if isinstance(inner, _MissingFile):
        return inner.error
    return inner if isinstance(inner, BaseException) else error


def _table_names(symbols: object) -> set[str]:
    """Return the names in a table of xacro and in its parent tables."""
    names: set[str] = set()
    while isinstance(symbols, dict):
        names |= {str(k) for k in dict.keys(symbols)}
        symbols = getattr(symbols, "parent", None)
    return names


def _literals(arguments: Mapping[str, str]) -> dict[str, Value]:
    """Convert arguments to numbers and booleans if possible, for `$(eval ...)`."""
    values: dict[str, Value] = {}
    for name, text in arguments.items():
        value: Value = text
        for read in (int, float):
            try:
                value = read(text)
                break
            except ValueError:
                continue
        values[name] = {"true": True, "false": False}.get(str(text).lower(), value)
    return values


_ELEMENT_NAMES = ("include", "property", "macro", "arg", "if", "unless", "insert_block", "call", "element", "attribute")
