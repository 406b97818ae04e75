"""Generator of the source files of a new plugin with typed parameters, and of a test of the plugin."""

from __future__ import annotations

import keyword
import re
from collections.abc import Mapping, Sequence
from html import escape
from pathlib import Path

from simkit import Params
from simkit.errors import InputError
from simkit_authoring.new_plugins import Element, NewPlugin

_BASES = {"world": "WorldPlugin", "model": "ModelPlugin", "visual": "VisualPlugin", "sensor": "SensorPlugin"}
_PARENTS = {"world": "Simulation", "model": "Model", "visual": "Visual", "sensor": "Sensor"}
_TYPES = {"number": "float", "boolean": "bool", "text": "str", "pose": "Pose", "block": "dict[str, Any]"}
_RATES = {"update_rate", "updateRate", "updateRateHZ", "update_frequency", "rate"}
TEMPLATES = Path(__file__).with_name("templates")
_WIDEST = 118
DEEPEST = 3  # deeper blocks are not read in `load`
_NAMES_OF_PLUGIN = """
sim name scoped params where ros log source period parent_kind filenames names before_step after_step reset load
prepare close advertise listen offer act declare random get_state set_state before_step_rate after_step_rate
lets_sleep code_objects importing only_publishes drives reads_parameter_files has_hook
"""
_OWN = frozenset(_NAMES_OF_PLUGIN.split())
"""Names of attributes that the base class of plugins already has."""


def plugin_text(plugin: NewPlugin) -> str:
    """Return the source of the plugin's module."""
    base, lines = _BASES[plugin.parent], _read_statements(plugin.elements, "params", "        ")
    names = attribute_names(plugin.elements)
    numbers = [element.name for element in plugin.elements if element.kind == "number" and not element.repeated]
    rate = next((names[name] for name in numbers if name in _RATES), None)
    imports = sorted({base, "Params", *(["Pose"] if any("Pose.from_rpy(" in line for line in lines) else [])})
    return fill_template(
        "plugin.py.j2",
        plugin=plugin,
        base=base,
        handle=_PARENTS[plugin.parent],
        library=_printable(plugin.filename),
        uses=_uses(plugin),
        imports=imports,
        filename="" if _CALLED_BY_FILE.search(plugin.filename) else quote_text(plugin.filename),
        gz_names=[quote_text(name) for name in plugin.gz_names],
        statements=lines,
        rate=rate,
    )


def fill_template(template: str, /, **values: object) -> str:
    """Return the text of a file in the folder `templates`, with values for its names."""
    # imported here because only plugin authors need Jinja
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    folder = FileSystemLoader(TEMPLATES)
    environment = Environment(
        loader=folder, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True, keep_trailing_newline=True
    )
    return environment.get_template(template).render(values)


def _uses(plugin: NewPlugin) -> str:
    """Return a sentence for each file that uses the plugin, with the lines of the uses."""
    lines_by_file: dict[str, list[str]] = {}
    for use in plugin.plugins:
        if use.where.file and use.where.line:
            lines_by_file.setdefault(Path(use.where.file).name, []).append(str(use.where.line))
    sentences = [f"Named in {file}, line {', '.join(lines[:8])}." for file, lines in lines_by_file.items()]
    return "".join(f"\n\n{line}" for line in sentences[:5])


_CALLED_BY_FILE = re.compile(r"\.py$|^[\w.]+:\w+$|^$")


def _read_statements(elements: Sequence[Element], owner: str, indent: str) -> list[str]:
    """Return the statements that read the parameters, one statement for each."""
    names = attribute_names(elements)
    lines: list[str] = []
    for element in elements:
        if element.depth > DEEPEST and not element.repeated:
            lines.append(f"{indent}self.{names[element.name]}: Params = {owner}.block({quote_text(element.name)})")
            lines.append(f"{indent}self.{names[element.name]}.mark_all_read()  # to be read as it is needed")
            continue
        kind = _type(element)
        value = _read(element, owner)
        lines += break_expression(f"{indent}self.{names[element.name]}: {kind} = ", value, indent)
    return lines


def break_expression(head: str, expression: str, indent: str, tail: str = "") -> list[str]:
    """Split a long expression into lines: each item within its outermost brackets is on its own line."""
    line = f"{head}{expression}{tail}"
    parts = _within_brackets(expression) if len(line) > _WIDEST else None
    if parts is None:
        return [line]
    opening, inside, closing = parts
    lines = [head + opening]
    for part in inside:
        comma = "" if part.startswith("for ") or (len(inside) > 1 and inside[-1].startswith("for ")) else ","
        key = re.match(r'"[^"]*": ', part)
        begin = key[0] if key else ""
        lines += break_expression(f"{indent}    {begin}", part.removeprefix(begin), indent + "    ", comma)
    return [*lines, f"{indent}{closing}{tail}"]


def _within_brackets(expression: str) -> tuple[str, list[str], str] | None:
    """Split an expression into the text up to its first bracket, the items within, and the closing bracket.

    Return None if the expression does not end with the matching bracket.
    """
    first = re.search(r"[\[({]", expression)
    if first is None or expression[-1] not in "])}":
        return None
    parts, depth, begin, quote = [], 0, first.end(), ""
    for i in range(first.end(), len(expression) - 1):
        letter = expression[i]
        if quote:
            quote = "" if letter == quote and expression[i - 1] != chr(92) else quote
        elif letter in "\"'":
            quote = letter
        elif letter in "[({":
            depth += 1
        elif letter in "])}":
            depth -= 1
        elif depth == 0 and (letter == "," or expression.startswith(" for ", i)):
            parts.append(expression[begin:i].strip())
            begin = i + 1
        if depth < 0:
            return None  # the last bracket does not match the first bracket, as in f(x)[0]
    parts.append(expression[begin:-1].strip())
    return expression[: first.end()], [part for part in parts if part], expression[-1]


def _type(element: Element) -> str:
    kind = _TYPES.get(element.kind, "tuple[float, ...]")
    return f"list[{kind}]" if element.repeated else kind


def _read(element: Element, owner: str) -> str:
    """Return the expression that reads an element, or all elements of a repeated name, from the variable `owner`."""
    name = quote_text(element.name)
    if element.kind == "block":
        if element.repeated:
            return f"[{_as_dict(element, 'item')} for item in {owner}.all({name})]"
        return _as_dict(element, f"{owner}.block({name})")
    if element.repeated:
        return f"[{_read_one(element, 'item')} for item in {owner}.each({name})]"
    return _read_one(element, owner)


def _as_dict(element: Element, block: str) -> str:
    entries = []
    for child in element.children:
        if child.name.startswith("@"):
            read = f"{block}.attribute({quote_text(child.name[1:])}, {quote_text(child.values[0])})"
        else:
            read = _read(child, block)
        entries.append(f"{quote_text(child.name)}: {read}")
    if element.values:
        entries.append(f'"": {block}.value')
    return "{" + ", ".join(entries) + "}"


def _read_one(element: Element, owner: str) -> str:
    """Return the expression that reads a single element; its default is the first value in the file."""
    name, value = quote_text(element.name), element.values[0]
    if element.kind == "boolean":
        return f"{owner}.boolean({name}, {value.lower() in ('true', '1')})"
    if element.kind == "number":
        endless = ", finite=False" if "inf" in value.lower() else ""
        return f"{owner}.number({name}, {number_text(value)}{endless})"
    if element.kind == "pose":
        return f"{owner}.pose({name}, Pose.from_rpy({', '.join(map(number_text, value.split()))}))"
    if element.kind == "vector":
        return f"{owner}.vector({name}, {element.size}, ({', '.join(map(number_text, value.split()))}))"
    return f"{owner}.text({name}, {quote_text(value)})"


def number_text(text: str) -> str:
    """Return a number from a file in Python syntax."""
    number = float(text)
    return f'float("{number}")' if number in (float("inf"), float("-inf")) else repr(number)


def attribute_names(elements: Sequence[Element]) -> dict[str, str]:
    """Return the attribute name for each element: a Python name that the base class of plugins does not use."""
    names: dict[str, str] = {}
    for element in elements:
        name = re.sub(r"\W+", "_", re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", element.name)).lower().strip("_") or "value"
        if name[0].isdigit():
            name = f"value_{name}"
        if name in _OWN or name == "parent" or keyword.iskeyword(name):
            name += "_value"
        while name in names.values():
            name += "_2"
        names[element.name] = name
    return names


def quote_text(text: str) -> str:
    """Return a text as a Python literal, in double quotes if the text contains none."""
    shown = repr(text)
    return f'"{text}"' if shown == f"'{text}'" and '"' not in text else shown


def _printable(text: str) -> str:
    return text.replace("\\", "/").replace('"', "'")


def test_text(plugin: NewPlugin) -> str:
    """Return the source of the test's module."""
    names = attribute_names(plugin.elements)
    first = plugin.plugins[0].params if plugin.plugins else None
    checks: list[str] = []
    for element in plugin.elements:
        for condition in _expected(element, f"plugin.{names[element.name]}", first):
            checks += break_expression("    assert ", condition, "    ")
    is_approximate = any("approx(" in line for line in checks)
    return fill_template(
        "plugin_test.py.j2", plugin=plugin, world=_world(plugin), checks=checks, is_approximate=is_approximate
    )


def _expected(element: Element, attribute: str, owner: Params | None) -> list[str]:
    """Return the conditions that the test asserts on an attribute.

    The expected values are those in `owner`, or the defaults of the generated code if `owner` does not have them.
    """
    if element.name.startswith("@"):
        text = owner.attributes.get(element.name[1:]) if owner else None
        return [f"{attribute} == {quote_text(element.values[0] if text is None else text)}"]
    here = [c for c in owner.children if c.name == element.name] if owner else []
    if element.repeated:
        count = len(here) if owner else len(element.values)
        if element.kind == "text" and count:
            return [f"{attribute} == [{', '.join(quote_text(c.value.strip()) for c in here)}]"]
        return [f"len({attribute}) == {count}"]
    if element.depth > DEEPEST and attribute.count("[") == 0:
        return [f"{attribute}.children"]
    if element.kind == "block":
        inside = here[0] if here else None
        return [
            condition
            for child in element.children
            for condition in _expected(child, f"{attribute}[{quote_text(child.name)}]", inside)
        ]
    return [_equal(element, attribute, here[0].value.strip() if here else element.values[0])]


def _equal(element: Element, attribute: str, text: str) -> str:
    if element.kind == "boolean":
        return attribute if text.lower() in ("true", "1") else f"not {attribute}"
    if element.kind == "number":
        return f"{attribute} == {number_text(text)}"
    if element.kind == "vector":
        return f"{attribute} == ({', '.join(map(number_text, text.split()))})"
    if element.kind == "pose":
        return f"{attribute}.position == pytest.approx(({', '.join(map(number_text, text.split()[:3]))}))"
    return f"{attribute} == {quote_text(text)}"


def _world(plugin: NewPlugin) -> str:
    """Return the SDF text of a small world with the plugin attached to the same kind of entity as in the file."""
    if plugin.plugins:
        element = _xml(plugin.plugins[0].params, plugin.plugins[0].name, plugin.filename)
    else:
        body = "".join(f"<{e.name}>{escape(e.values[0])}</{e.name}>" for e in plugin.elements)
        element = f'<plugin name="{plugin.module}" filename={quote_attribute(plugin.filename)}>{body}</plugin>'
    return fill_template("plugin_world.sdf.j2", plugin=plugin, element=element)


def _xml(params: Params, name: str, filename: str) -> str:
    """Return the `<plugin>` element as XML."""

    def element_xml(node: Params, indent: str) -> str:
        attributes = "".join(f" {key}={quote_attribute(value)}" for key, value in node.attributes.items())
        inside = "".join(element_xml(child, indent + "  ") for child in node.children)
        text = escape(node.value) + (f"{inside}\n{indent}" if inside else "")
        return f"\n{indent}<{node.name}{attributes}>{text}</{node.name}>"

    lines = "".join(element_xml(child, "      ") for child in params.children if ":" not in child.name)
    return f"<plugin name={quote_attribute(name)} filename={quote_attribute(filename)}>{lines}\n    </plugin>"


def quote_attribute(text: str) -> str:
    """Return a text as an XML attribute value in quotes."""
    return f'"{escape(text)}"'


_FILE_EXISTS = "SK-PLUGIN-074"


def write_plugins(plugins: Sequence[NewPlugin], folder: Path, *, overwrite: bool = False) -> list[Path]:
    """Write the source file and the test file of each plugin.

    Returns:
        Written files, in the order of writing.

    Raises:
        InputError: SK-PLUGIN-074 a file cannot be written, or exists already and `overwrite` is false. If a file exists
            already, no file is written.
    """
    files: dict[Path, str] = {}
    for plugin in plugins:
        path = folder / Path(*plugin.module.split(".")).with_suffix(".py")
        files[path] = plugin_text(plugin)
        files[folder / f"test_{plugin.module.replace('.', '_')}.py"] = test_text(plugin)
    return write_files(files, overwrite=overwrite)


def write_files(files: Mapping[Path, str], *, overwrite: bool = False) -> list[Path]:
    """Write new source files.

    Returns:
        Written files, in the order of writing.

    Raises:
        InputError: SK-PLUGIN-074 a file cannot be written, or exists already and `overwrite` is false. If a file exists
            already, no file is written.
    """
    existing = [str(path) for path in files if path.exists()]
    if existing and not overwrite:
        raise InputError(_FILE_EXISTS, f"already exists: {', '.join(existing)}; --force replaces")
    for path, text in files.items():
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        except OSError as error:
            raise InputError(_FILE_EXISTS, f"cannot write {path}: {error.strerror}") from error
    return list(files)
