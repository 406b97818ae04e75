"""Catalogue of diagnostic codes: reads them from `diagnostic_codes/<area>.toml` and formats them as text.

A pack has its own areas in the folder `cli/diagnostic_codes` of its package. It may also add codes to an area of the
core, in a file with the name of this area and without a title.

`simkit explain` prints codes. `python -m simkit.cli.diagnostic_catalogue > docs/diagnostics.md` writes the page of all
codes. A test runs every example. A code keeps its meaning for ever and is never reused.

The file of an area has a `title` for the page and a `position` on it (areas without one come last, sorted by name).
It has one table for each code, with the attributes of `Code`. A binary file of an example is `{ hex = "…" }`.
"""

from __future__ import annotations

import re
import sys
import tomllib
from collections.abc import Iterator, Mapping
from copy import deepcopy
from dataclasses import dataclass, field, fields
from functools import cache
from pathlib import Path
from types import MappingProxyType
from typing import Literal, get_args

from simkit.cli.terminal.output import JsonObject, JsonValue
from simkit.diagnostics import did_you_mean
from simkit.number_text import counted
from simkit.packs import foreign_packs, pack_folders, warn_of_pack

Kind = Literal["xml", "command", "python"]
Effect = Literal["none", "approximated", "left out"]
"""Effect of what a warning or note is about: works as in Gazebo, works differently, or does not work at all."""

_FOLDER = Path(__file__).with_name("diagnostic_codes")
_INTRODUCTION = """# Diagnostics

Every message about your input has a code, `SK-AREA-NNN`. A code keeps its meaning and is never reused.
`simkit check FILE` prints all diagnostics of a file at once. In Python they are in `sim.diagnostics`, and in the
attribute `.diagnostics` of `simkit.LoadError`. `simkit explain CODE` prints an entry of this page.

This page is generated from the tables in `simkit/cli/diagnostic_codes` (`python -m simkit.cli.diagnostic_catalogue`).
A test runs every example.

| severity | |
|---|---|
| error | the input cannot be used; exit code 2; a sensor or plugin with errors is left out instead (SK-LOAD-013) |
| warning | a part of the input has no effect, or a different effect than written; an error with `--strict` |
| note | a conversion that keeps the meaning as closely as MuJoCo can represent it |
| stop | the reason why a run ended, not a problem of a file; the row gives the exit code |

An entry also says if [`simkit check --score`](commands/check.md#score) counts something as approximated or left out.
"""
_LAST = sys.maxsize
_SEVERITIES = frozenset(("error", "warning", "note", "stop"))
_EFFECTS = frozenset(get_args(Effect))
_LANGUAGE_OF_KIND = {"xml": "xml", "command": "sh", "python": "python"}
_LANGUAGE_OF_ENDING = {
    "py": "python",
    "yaml": "yaml",
    **dict.fromkeys(("sdf", "urdf", "xacro", "xml", "config"), "xml"),
}


@dataclass(frozen=True, slots=True)
class Example:
    """Input that causes a diagnostic code.

    Attributes:
        text: for `xml`, a file for `simkit check` (SDF, URDF, ...). For `command`, a shell line that begins with
            `simkit` and runs in a folder with only `files`. For `python`, a script that runs there. The script prints
            the code, raises the error with the code, or leaves the code in a simulation called `sim`.
        kind: way of running `text`.
        files: additional files, relative path -> text or bytes.
        suffix: file name suffix of `text`, for `xml`.
    """

    text: str
    kind: Kind = "xml"
    files: Mapping[str, str | bytes] = field(default_factory=dict)
    suffix: str = ".sdf"


@dataclass(frozen=True, slots=True)
class Code:
    """One diagnostic code.

    Attributes:
        code: `SK-AREA-NNN`.
        severity: "error", "warning", "note" or "stop"; two joined by ", " if the severity depends on the case.
        meaning: general description of the problem.
        helps: remedy; may be empty.
        example: input that causes the code; None if no user input can cause it.
        without: reason for the missing example.
        effect: what a warning or note of this code means for the score of a file; empty for the usual effect of the
            severity.
        note_effect: the same for the notes of a code that has warnings too; empty for none.
    """

    code: str
    severity: str
    meaning: str
    helps: str = ""
    example: Example | None = None
    without: str = ""
    effect: Effect | Literal[""] = ""
    note_effect: Effect | Literal[""] = ""

    def effect_of(self, severity: str) -> Effect:
        """Return the effect of a diagnostic with this code; without an entry, a warning means an approximation."""
        if severity == "note" and "warning" in self.severity:
            return self.note_effect or "none"
        return self.effect or ("approximated" if severity == "warning" else "none")


@dataclass(frozen=True, slots=True)
class Area:
    """Area of codes: the middle part of their names, its title and position on the page, and its codes by name."""

    name: str
    title: str
    position: int
    codes: Mapping[str, Code]


def catalogue(prefix: str = "SK-") -> Mapping[str, Code]:
    """Return the codes whose names begin with `prefix`, in order. Only the files of their areas are read."""
    area, dash, _ = prefix.removeprefix("SK-").partition("-")
    names = [name for name in _area_names() if (name == area if dash else name.startswith(area))]
    codes = (code for name in names for code in _area(name).codes.values() if code.code.startswith(prefix))
    return MappingProxyType({code.code: code for code in sorted(codes, key=lambda code: code.code)})


def effect_of(code: str, severity: str) -> Effect:
    """Return the effect of a diagnostic on the score of a file; see `Code.effect_of`."""
    known = _area(code.split("-")[1]).codes.get(code) if code.split("-")[1] in _area_files() else None
    return "none" if known is None else known.effect_of(severity)


def code_text(code: Code) -> str:
    """Format one code as plain text: severity, meaning, remedy and an example."""
    lines = [f"{code.code} ({code.severity})", f"  {code.meaning}"]
    if code.helps:
        lines.append(f"  help: {code.helps}")
    if scored := _score_text(code):
        lines.append(f"  {scored}")
    if code.example is None:
        if code.without:
            lines.append(f"  no example: {code.without}")
        return "\n".join(lines)
    for title, text in _example_files(code.example):
        lines += ["", f"  {title}", *(f"    {line}" for line in text.rstrip("\n").splitlines())]
    return "\n".join(lines)


def page() -> str:
    """Format all codes as one page of Markdown."""
    areas = sorted(map(_area, _area_names()), key=lambda area: (area.position, area.name))
    return "\n".join([_INTRODUCTION, *("\n".join(_section(area)) for area in areas)])


def _area_names() -> list[str]:
    return sorted(_area_files())


@cache
def _area_files() -> dict[str, list[Path]]:
    """Return the files of each area by its name: first that of the core."""
    files: dict[str, list[Path]] = {}
    for folder in (_FOLDER, *map(Path, pack_folders("cli/diagnostic_codes"))):
        for path in folder.glob("*.toml"):
            files.setdefault(path.stem.upper(), []).append(path)
    return files


@cache
def _area(name: str) -> Area:
    """Read the files of one area. Packs cannot replace a code of the core.

    A fault in a file of a pack of others causes a warning; the codes with faults are left out.
    """
    title, position, codes = "", _LAST, dict[str, Code]()
    for path in _area_files()[name]:
        package = _foreign_package(path)
        if package is None:
            table = tomllib.loads(path.read_text(encoding="utf-8"))
        else:
            table = _checked_table(path, package, has_title=bool(title))
        title, position = title or table.pop("title", name), table.pop("position", position)
        codes = {**{code: _code(code, entry) for code, entry in table.items()}, **codes}
    return Area(name, title, position, dict(sorted(codes.items())))


def _foreign_package(path: Path) -> str | None:
    """Return the package of the pack of others that has a file; None for a file of simkit."""
    return next((pack.package for pack in foreign_packs() if path.is_relative_to(pack.folder)), None)


def _checked_table(path: Path, package: str, *, has_title: bool) -> JsonObject:
    """Read a file of a pack of others, and leave out, with a warning, what is wrong in it."""
    try:
        text = path.read_text(encoding="utf-8")
        table = tomllib.loads(text)
    except (OSError, ValueError) as error:
        warn_of_pack(package, f"{path}: {error}")
        return {}
    heads = {"title": str, "position": int}
    faults = {key: "" if isinstance(table[key], kind) else "wrong type" for key, kind in heads.items() if key in table}
    if "title" not in table and not has_title:
        warn_of_pack(package, f'{path}: the area has no title; write title = "..." in the first line')
    faults |= {name: _fault_of_code(name, path, entry) for name, entry in table.items() if name not in heads}
    lines = text.splitlines()
    for name, fault in faults.items():
        if fault:
            starts = (number for number, line in enumerate(lines, 1) if line.startswith((f"[{name}]", name)))
            warn_of_pack(package, f"{path}:{next(starts, 1)}: {name}: {fault}; it is left out")
            del table[name]
    return table


def _fault_of_code(name: str, path: Path, entry: JsonValue) -> str:
    """Return what is wrong in the table of a code of a pack of others; empty if nothing is."""
    if not re.fullmatch(rf"SK-{path.stem.upper()}-\d{{3}}", name):
        return f"expected a code SK-{path.stem.upper()}-NNN"
    if not isinstance(entry, dict):
        return "expected a table"
    known = {each.name for each in fields(Code)} - {"code"}
    for key, value in entry.items():
        if key not in known:
            return f"unknown key {key!r}; {did_you_mean(key, known) or 'known: ' + ', '.join(sorted(known))}"
        if not isinstance(value, dict if key == "example" else str):
            return f"{key!r} has the wrong type"
    missing = [key for key in ("severity", "meaning") if key not in entry]
    if missing:
        return f"{missing[0]!r} is missing"
    for key in ("effect", "note_effect"):
        if entry.get(key, "none") not in _EFFECTS:
            return f"{key} {entry[key]!r}; expected {', '.join(sorted(_EFFECTS))}"
    wrong = set(entry["severity"].split(", ")) - _SEVERITIES
    if wrong:
        return f"severity {sorted(wrong)[0]!r}; expected {', '.join(sorted(_SEVERITIES))}"
    try:
        example = _code(name, deepcopy(entry)).example
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        return f"example: {type(error).__name__}: {error}"
    if example is not None and (example.kind not in _LANGUAGE_OF_KIND or not isinstance(example.text, str)):
        return f"example: kind {example.kind!r}; expected {', '.join(_LANGUAGE_OF_KIND)} and a text"
    return ""


def _code(name: str, entry: JsonObject) -> Code:
    """Build a code from its table."""
    example = entry.pop("example", None)
    return Code(name, **entry, example=None if example is None else _example(example))


def _example(entry: JsonObject) -> Example:
    """Build an example from its table."""
    files = {
        name: content if isinstance(content, str) else bytes.fromhex(content["hex"])
        for name, content in entry.pop("files", {}).items()
    }
    return Example(**entry, files=files)


def _example_files(example: Example) -> list[tuple[str, str]]:
    """Return a title and a text for each file of an example; the file that the example runs comes last."""
    files = [
        (f"{name}:", content if isinstance(content, str) else f"({counted(len(content), 'byte')})")
        for name, content in example.files.items()
    ]
    title = {"xml": f"example{example.suffix}:", "command": "then:", "python": "in Python:"}[example.kind]
    return [*files, (title, example.text)]


def _score_text(code: Code) -> str:
    """Return how a score counts what the warnings and notes of a code are about; empty if it does not count."""
    effects = {severity: code.effect_of(severity) for severity in ("warning", "note") if severity in code.severity}
    counted = dict.fromkeys(effect for effect in effects.values() if effect != "none")
    return f"score: {', '.join(counted)}" if counted else ""


def _section(area: Area) -> Iterator[str]:
    """Yield the lines of one area: a table of its codes, then each code with its example."""
    yield f"## {area.title}\n"
    yield "| code | severity | meaning | what helps |\n|---|---|---|---|"
    for code in area.codes.values():
        yield f"| [`{code.code}`](#{code.code.lower()}) | {code.severity} | {code.meaning} | {code.helps} |"
    yield ""
    for code in area.codes.values():
        yield from _entry(code)


def _entry(code: Code) -> Iterator[str]:
    """Yield the lines of one code."""
    yield f"### {code.code}\n"
    scored = f" {text[:1].upper()}{text[1:]}." if (text := _score_text(code)) else ""
    yield f"{code.severity}: {code.meaning}." + (f" What helps: {code.helps}." if code.helps else "") + f"{scored}\n"
    if code.example is None:
        if code.without:
            yield f"No example: {code.without}.\n"
        return
    files = _example_files(code.example)
    for position, (title, text) in enumerate(files):
        is_last = position == len(files) - 1
        name = title.removesuffix(":")
        if len(files) > 1 and (not is_last or code.example.kind == "xml"):
            yield f"`{name}`\n"
        ending = name.rpartition(".")[2]
        language = _LANGUAGE_OF_KIND[code.example.kind] if is_last else _LANGUAGE_OF_ENDING.get(ending, "text")
        yield f"```{language}\n{text.rstrip()}\n```\n"


if __name__ == "__main__":
    sys.stdout.write(page())
