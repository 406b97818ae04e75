"""The catalogue as text: the page `docs/diagnostics.md`, and one code at a time for the terminal."""

from __future__ import annotations

from collections.abc import Iterator

from simkit.codes import Code, Example, catalogue

_INTRODUCTION = """# Diagnostics

Everything simkit has to say about your input carries a code, `SK-AREA-NNN`. A code keeps its meaning and is never given
to another. `simkit check FILE` prints all of a file's at once; in Python `sim.diagnostics` holds them, and
`simkit.LoadError` carries them in `.diagnostics`. `simkit explain CODE` prints what stands here.

This page is written from the code (`python -m simkit.codes`), and a test runs every example.

| severity | |
|---|---|
| error | the input cannot be used; exit code 2 |
| warning | something has no effect here, or another one than written; an error with `--strict` |
| note | a standing conversion that keeps the meaning as closely as the engine can |
| stop | no report on a file but the reason why a run ended; its exit code is in the row |
"""
_TITLES = {
    "LOAD": "Files",
    "URI": "Where files are looked for",
    "XML": "XML",
    "XACRO": "xacro",
    "SDF": "SDF",
    "URDF": "URDF",
    "MJCF": "MJCF",
    "PARAM": "Parameters of sensors and plugins",
    "SENSOR": "Sensors",
    "PLUGIN": "Plugins",
    "JOINT": "Joints",
    "INERTIA": "Inertia",
    "MESH": "Meshes and other shapes",
    "PHYS": "Physics",
    "LINT": "Physics lint",
    "NAME": "Names while it runs",
    "MSG": "Messages",
    "TOPIC": "Topics",
    "RENDER": "Pictures",
    "BAG": "Recordings",
    "WRITE": "Writing files",
    "GOLDEN": "Regression",
    "CLI": "The command line",
    "CORE": "simkit itself",
    "INPUT": "Other input",
}
_LANGUAGE = {"xml": "xml", "command": "sh", "python": "python"}


def page() -> str:
    """The whole page as Markdown."""
    areas = sorted({code.area for code in catalogue().values()}, key=_order)
    return "\n".join([_INTRODUCTION, *("\n".join(_section(area)) for area in areas)])


def explain(code: Code) -> str:
    """One code in plain text: severity, meaning, what helps, and an example."""
    lines = [f"{code.code} ({code.severity})", f"  {code.meaning}"]
    if code.helps:
        lines.append(f"  help: {code.helps}")
    if code.example is None:
        lines.append(f"  no example: {code.without}")
        return "\n".join(lines)
    for title, text in example_files(code.example):
        lines += ["", f"  {title}", *(f"    {line}" for line in text.rstrip("\n").splitlines())]
    return "\n".join(lines)


def example_files(example: Example) -> list[tuple[str, str]]:
    """A title and a text for each part of an example, what is run last."""
    parts = [
        (f"{name}:", content if isinstance(content, str) else f"({len(content)} bytes)")
        for name, content in example.files.items()
    ]
    title = {"xml": f"example{example.suffix}:", "command": "then:", "python": "in Python:"}[example.kind]
    return [*parts, (title, example.text)]


def _order(area: str) -> tuple[int, str]:
    titles = list(_TITLES)
    return (titles.index(area) if area in titles else len(titles), area)


def _section(area: str) -> Iterator[str]:
    codes = [code for code in catalogue().values() if code.area == area]
    yield f"## {_TITLES.get(area, area)}\n"
    yield "| code | severity | meaning | what helps |\n|---|---|---|---|"
    for code in codes:
        yield f"| [`{code.code}`](#{code.code.lower()}) | {code.severity} | {code.meaning} | {code.helps} |"
    yield ""
    for code in codes:
        yield from _entry(code)


def _entry(code: Code) -> Iterator[str]:
    yield f"### {code.code}\n"
    yield f"{code.severity}: {code.meaning}." + (f" What helps: {code.helps}." if code.helps else "") + "\n"
    if code.example is None:
        yield f"No example: {code.without}.\n"
        return
    parts = example_files(code.example)
    for position, (title, text) in enumerate(parts):
        is_last = position == len(parts) - 1
        if len(parts) > 1 and (not is_last or code.example.kind == "xml"):
            yield f"`{title.rstrip(':')}`\n"
        language = _LANGUAGE[code.example.kind] if is_last else _language_of(title)
        yield f"```{language}\n{text.rstrip()}\n```\n"


def _language_of(title: str) -> str:
    ending = title.rstrip(":").rpartition(".")[2]
    known = {"sdf": "xml", "urdf": "xml", "xacro": "xml", "xml": "xml", "config": "xml", "py": "python", "yaml": "yaml"}
    return known.get(ending, "text")
