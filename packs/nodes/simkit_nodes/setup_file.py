"""Arguments of `setup` in a package's `setup.py` and `setup.cfg`, read without running them."""

from __future__ import annotations

import ast
import configparser
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from simkit.input_file import read_input

_LARGEST: Final = 1_000_000  # [bytes]
_SETUP_FUNCTIONS: Final = ("setup", "generate_distutils_setup")


class _UnknownValueError(Exception):
    """Value of an expression that only Python can compute."""


def setup_arguments(package: Path) -> dict[str, Any]:
    """Return the arguments of `setup` that can be computed from the text of `setup.py` alone, by name.

    Texts, numbers, lists, tuples, dictionaries, names of such values, sums of them, formatted texts and `os.path.join`
    are computed. Values that need more are left out.

    Args:
        package: folder of the package.
    """
    try:
        tree = ast.parse(_text(package / "setup.py", package))
    except (OSError, SyntaxError, ValueError):
        return {}
    names: dict[str, Any] = {}
    arguments: dict[str, Any] = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.Assign) and len(node.targets) == 1 and isinstance(node.targets[0], ast.Name):
            _store(names, node.targets[0].id, node.value, names)
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and _function_name(node.func) in _SETUP_FUNCTIONS:
            for keyword in node.keywords:
                if keyword.arg is not None:
                    _store(arguments, keyword.arg, keyword.value, names)
    return arguments


def console_scripts(package: Path) -> dict[str, str]:
    """Return `module:function` of each script that `setup.py` and `setup.cfg` of a package install, by name."""
    entries = setup_arguments(package).get("entry_points", {})
    lines: object = entries
    if isinstance(entries, str):
        lines = _ini(entries).get("console_scripts", {})
    elif isinstance(entries, Mapping):
        lines = entries.get("console_scripts", [])
    scripts = _scripts_of(lines)
    try:
        settings = _ini(_text(package / "setup.cfg", package))
    except (OSError, ValueError):
        settings = {}
    in_settings = settings.get("options.entry_points", {}).get("console_scripts", "")
    return scripts | _scripts_of(in_settings.splitlines())


def scripts_of_ini(text: str) -> dict[str, str]:
    """Return `module:function` of each console script of an `entry_points.txt`, by name."""
    return _scripts_of(_ini(text).get("console_scripts", {}))


def _scripts_of(lines: object) -> dict[str, str]:
    if isinstance(lines, Mapping):
        return {str(name).strip(): str(target).strip() for name, target in lines.items()}
    if isinstance(lines, str):
        lines = lines.splitlines()
    texts = (
        [line for line in lines if isinstance(line, str) and "=" in line] if isinstance(lines, (list, tuple)) else []
    )
    pairs = (text.partition("=") for text in texts)
    return {name.strip(): target.partition("[")[0].strip() for name, _, target in pairs}


def _ini(text: str) -> dict[str, dict[str, str]]:
    parser = configparser.RawConfigParser(delimiters=("=",))
    parser.optionxform = str  # type: ignore[assignment,method-assign]
    try:
        parser.read_string(text)
    except configparser.Error:
        return {}
    return {section: dict(parser[section]) for section in parser.sections()}


def _text(file: Path, package: Path) -> str:
    return read_input(file, _LARGEST, inside=package).decode(errors="replace")


def _function_name(function: ast.expr) -> str:
    return function.id if isinstance(function, ast.Name) else getattr(function, "attr", "")


def _store(values: dict[str, Any], name: str, node: ast.expr, names: Mapping[str, Any]) -> None:
    try:
        values[name] = _value(node, names)
    except _UnknownValueError:
        return


def _value(node: ast.expr, names: Mapping[str, Any]) -> Any:
    """Return the value of an expression.

    Raises:
        _UnknownValueError: only Python can compute it.
    """
    match node:
        case ast.Constant(value=value):
            return value
        case ast.Name(id=name) if name in names:
            return names[name]
        case ast.List(elts=items) | ast.Tuple(elts=items):
            return [value for item in items for value in _known(item, names)]
        case ast.Dict(keys=keys, values=values):
            pairs = [(_known(key, names), _known(value, names)) for key, value in zip(keys, values, strict=True) if key]
            return {key[0]: value[0] for key, value in pairs if key and value}
        case ast.JoinedStr(values=parts):
            return "".join(str(_value(part, names)) for part in parts)
        case ast.FormattedValue(value=value, format_spec=None):
            return _value(value, names)
        case ast.BinOp(left=left, op=ast.Add(), right=right):
            return _sum(_value(left, names), _value(right, names))
        case ast.BinOp(left=left, op=ast.Mod(), right=right):
            return _formatted(_value(left, names), _value(right, names))
        case ast.Call(func=ast.Attribute(attr="format", value=text), args=args, keywords=keywords):
            named = {keyword.arg: _value(keyword.value, names) for keyword in keywords if keyword.arg}
            return _checked_text(_value(text, names)).format(*(_value(arg, names) for arg in args), **named)
        case ast.Call(func=ast.Attribute(attr="join", value=ast.Attribute(attr="path")), args=args, keywords=[]):
            return "/".join(_checked_text(_value(arg, names)) for arg in args)
        case ast.ListComp(elt=item, generators=[ast.comprehension(target=ast.Name(id=name), iter=iterable, ifs=[])]):
            return [_value(item, {**names, name: value}) for value in list(_value(iterable, names))]
    raise _UnknownValueError


def _known(node: ast.expr | None, names: Mapping[str, Any]) -> list[Any]:
    """Return the value of an expression in a list, which is empty if only Python can compute it."""
    try:
        if isinstance(node, ast.Starred):
            return list(_value(node.value, names))
        return [] if node is None else [_value(node, names)]
    except _UnknownValueError:
        return []


def _sum(left: Any, right: Any) -> Any:
    if type(left) is not type(right) or not isinstance(left, (str, list)):
        raise _UnknownValueError
    return left + right


def _formatted(text: Any, values: Any) -> str:
    try:
        return str(_checked_text(text) % (tuple(values) if isinstance(values, list) else values))
    except (TypeError, ValueError):
        raise _UnknownValueError from None


def _checked_text(value: Any) -> str:
    if not isinstance(value, str):
        raise _UnknownValueError
    return value
