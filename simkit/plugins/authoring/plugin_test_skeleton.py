"""Write the test of a new plugin, and the plugin and its test as files."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from pathlib import Path

from simkit.errors import InputError
from simkit.params import Params
from simkit.plugins.authoring.element_types import Element
from simkit.plugins.authoring.new_plugins import NewPlugin
from simkit.plugins.authoring.plugin_skeleton import (
    DEEPEST,
    attribute_names,
    break_expression,
    number_text,
    plugin_text,
    quote_text,
)


def test_text(wanted: NewPlugin) -> str:
    """The test's module."""
    names = attribute_names(wanted.elements)
    first = wanted.plugins[0].params if wanted.plugins else None
    checks: list[str] = []
    for element in wanted.elements:
        for said in _expected(element, f"plugin.{names[element.name]}", first):
            checks += break_expression("    assert ", said, "    ")
    approximate = any("approx(" in line for line in checks)
    world = _world(wanted)
    head = [
        f'"""`{wanted.class_name}` reads what a world gives it, and the world runs."""',
        "",
        "from __future__ import annotations",
        "",
        "from pathlib import Path",
        "from typing import Any",
        "",
        *(["import pytest", ""] if approximate else []),
        "HERE = Path(__file__).parent",
        f'WORLD = {"r" if chr(92) in world else ""}"""{world}"""',
        "",
        "",
        f"def test_{wanted.module.replace('.', '_')}_reads_its_parameters_and_runs(simkit_world: Any) -> None:",
        "    sim = simkit_world(WORLD, plugin_paths=[HERE])",
        f'    plugin = next(p for p in sim.plugins.values() if type(p).__name__ == "{wanted.class_name}")',
        *(checks or ["    assert plugin.parent is not None"]),
        '    assert not [d for d in sim.diagnostics if d.code == "SK-PARAM-003"], "a parameter is not read"',
        "    sim.run(0.2)",
        "    assert sim.tick == round(0.2 / sim.timestep)",
        "",
    ]
    return "\n".join(head)


def _expected(element: Element, attribute: str, owner: Params | None) -> list[str]:
    """What the test expects of an attribute: what the element `owner` has, or else what the code says."""
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
            said
            for child in element.children
            for said in _expected(child, f"{attribute}[{quote_text(child.name)}]", inside)
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


def _world(wanted: NewPlugin) -> str:
    """A small world in which the plugin hangs as in the file."""
    if wanted.plugins:
        plugin = _xml(wanted.plugins[0].params, wanted.plugins[0].name, wanted.filename)
    else:
        body = "".join(f"<{e.name}>{escape(e.values[0])}</{e.name}>" for e in wanted.elements)
        plugin = f'<plugin name="{wanted.module}" filename={quote_attribute(wanted.filename)}>{body}</plugin>'
    where = {
        "world": "\n  {plugin}\n",
        "model": '\n  <model name="box">\n    <link name="link"/>\n    {plugin}\n  </model>\n',
        "visual": '\n  <model name="box"><link name="link">\n    <visual name="skin">'
        "<geometry><box><size>1 1 1</size></box></geometry>\n      {plugin}\n    </visual>\n  </link></model>\n",
        "sensor": '\n  <model name="box"><link name="link">\n    <sensor name="sensor" type="{sensor}">'
        "<update_rate>10</update_rate>{inside}\n      {plugin}\n    </sensor>\n  </link></model>\n",
    }[wanted.parent]
    body = where.replace("{sensor}", wanted.sensor).replace("{inside}", _INSIDE.get(wanted.sensor, ""))
    return f'<sdf version="1.9"><world name="w">{body.replace("{plugin}", plugin)}</world></sdf>\n'


_SCAN = "<scan><horizontal><samples>3</samples></horizontal></scan><range><min>0.1</min><max>10</max></range>"
_INSIDE = dict.fromkeys(("gpu_lidar", "gpu_ray", "lidar", "ray"), f"<lidar>{_SCAN}</lidar>")


def _xml(params: Params, name: str, filename: str) -> str:
    """A plugin's element as a file has it."""

    def one(node: Params, indent: str) -> str:
        attributes = "".join(f" {key}={quote_attribute(value)}" for key, value in node.attributes.items())
        inside = "".join(one(child, indent + "  ") for child in node.children)
        text = escape(node.value) + (f"{inside}\n{indent}" if inside else "")
        return f"\n{indent}<{node.name}{attributes}>{text}</{node.name}>"

    lines = "".join(one(child, "      ") for child in params.children if ":" not in child.name)
    return f"<plugin name={quote_attribute(name)} filename={quote_attribute(filename)}>{lines}\n    </plugin>"


def quote_attribute(text: str) -> str:
    """A text as an attribute of XML."""
    return f'"{escape(text)}"'


_FILE_EXISTS = "SK-PLUGIN-074"


def write_plugins(wanted: Sequence[NewPlugin], folder: Path, *, overwrite: bool = False) -> list[Path]:
    """Writes each plugin and its test; all or nothing.

    Returns:
        The files, in the order of writing.

    Raises:
        InputError: SK-PLUGIN-074 a file is there already.
    """
    files: dict[Path, str] = {}
    for one in wanted:
        path = folder / Path(*one.module.split(".")).with_suffix(".py")
        files[path] = plugin_text(one)
        files[folder / f"test_{one.module.replace('.', '_')}.py"] = test_text(one)
    there = [str(path) for path in files if path.exists()]
    if there and not overwrite:
        raise InputError(f"{_FILE_EXISTS} there already: {', '.join(there)}; --force replaces", _FILE_EXISTS)
    for path, text in files.items():
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        except OSError as error:
            raise InputError(f"{_FILE_EXISTS} cannot write {path}: {error.strerror}", _FILE_EXISTS) from error
    return list(files)
