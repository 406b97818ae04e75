"""The import table of the rooms: who may know whom. One way through the house, from the loaders to the sinks."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[1] / "simkit"

SMALL_WORDS = frozenset({"apart", "pose", "params", "diagnostics", "errors", "msgs", "registry"})
ROOMS: dict[str, frozenset[str]] = {
    "scene": frozenset(),
    "engine": frozenset(),
    "loaders": frozenset({"scene"}),
    "compiler": frozenset({"engine", "scene"}),
    "runtime": frozenset({"compiler", "engine", "scene"}),
    "earth": frozenset({"scene"}),
    "sensors": frozenset({"runtime", "compiler", "scene", "earth"}),
    "gzpython": frozenset({"runtime", "scene", "earth"}),
    "plugins": frozenset({"runtime", "compiler", "scene", "earth", "gzpython", "sinks"}),
    "control": frozenset({"plugins", "runtime", "compiler", "scene"}),
    "motion": frozenset({"control", "plugins", "runtime", "compiler", "scene"}),
    "authoring": frozenset({"plugins", "gzpython", "sensors", "runtime", "scene"}),
    "pytest_plugin": frozenset({"golden", "runtime", "scenario"}),
    "conditions": frozenset({"runtime", "scenario"}),
    "scenario": frozenset({"build", "conditions", "runtime", "sinks"}),
    "golden": frozenset({"compiler", "conditions", "engine", "runtime", "scenario", "scene", "sensors", "sinks"}),
    "certify": frozenset({"engine", "golden", "runtime", "scenario", "sinks"}),
    "bundle": frozenset(
        {"build", "engine", "golden", "loaders", "runtime", "scenario", "scene", "sinks", "spawning", "vendor"}
        | {"conditions", "writers"}
    ),
    "exercise": frozenset({"build", "conditions", "plugins", "runtime", "scenario", "scene", "sinks"}),
    "parts": frozenset({"control", "motion", "plugins", "sensors", "runtime", "scene"}),
    "sinks": frozenset({"runtime", "writers"}),
    "live": frozenset({"runtime"}),
    "fix_inertia": frozenset({"loaders", "compiler", "scene"}),
    "lint": frozenset({"runtime", "compiler", "scene"}),
    "overrides": frozenset({"scene"}),
    "spawning": frozenset({"loaders", "scene"}),
    "vendor": frozenset({"loaders", "scene", "writers"}),
    "writers": frozenset({"scene", "compiler"}),
    "description": frozenset({"scene", "loaders", "sensors"}),
    "bench": frozenset({"build", "runtime", "compiler", "sensors", "plugins"}),
    "cli": frozenset(
        {
            "authoring",
            "bundle",
            "certify",
            "conditions",
            "control",
            "exercise",
            "golden",
            "runtime",
            "scenario",
            "live",
            "motion",
            "build",
            "fix_inertia",
            "description",
            "bench",
            "engine",
            "overrides",
            "sinks",
            "vendor",
        }
        | {"writers"}
    ),
}
KNOWS_ALL = frozenset({"build"})
FRONT_DOOR = frozenset({"__init__", "__main__"})


def room_of(path: Path) -> str:
    """The folder or module directly under `simkit/` that a file belongs to."""
    first = path.relative_to(PACKAGE).parts[0]
    return first.removesuffix(".py")


def imported_rooms(path: Path) -> list[tuple[int, str]]:
    """(line, room) for each import from simkit in a file, those inside functions and for type checking included."""
    found = []
    here = ("simkit", *path.relative_to(PACKAGE).with_suffix("").parts)
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"), str(path))):
        names: list[str] = []
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            base = node.module or ""
            if node.level:
                base = ".".join([*here[: -node.level], *([base] if base else [])])
            names = [f"{base}.{alias.name}" for alias in node.names]
        for name in names:
            parts = name.split(".")
            if parts[0] == "simkit" and len(parts) > 1 and _is_module(parts[1]):
                found.append((node.lineno, parts[1]))
    return found


def _is_module(name: str) -> bool:
    return (PACKAGE / name).is_dir() or (PACKAGE / f"{name}.py").is_file()


FILES = sorted(p for p in PACKAGE.rglob("*.py"))


@pytest.mark.parametrize("path", FILES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_a_file_imports_only_from_the_rooms_its_own_may_know(path: Path) -> None:
    room = room_of(path)
    if room in KNOWS_ALL | FRONT_DOOR:
        return
    if room in SMALL_WORDS:
        allowed = SMALL_WORDS
    else:
        assert room in ROOMS, f"simkit/{room} is no room of the table; give it a row"
        allowed = ROOMS[room] | SMALL_WORDS | {room}
    wrong = [f"line {line}: {other}" for line, other in imported_rooms(path) if other not in allowed]
    assert not wrong, f"simkit/{path.relative_to(PACKAGE)} may import {sorted(allowed)}, but: " + "; ".join(wrong)


def test_only_loaders_read_xml() -> None:
    """XML ends at the loaders; a mesh file that happens to be XML is the mesh reader's."""
    readers = {p.relative_to(PACKAGE).as_posix() for p in FILES if _imports(p, {"lxml", "xml"})}
    assert {r for r in readers if not r.startswith("loaders/")} <= {"compiler/meshes/collada.py"}


def test_only_the_compiler_and_what_stands_on_it_knows_the_engine() -> None:
    """Scene, loaders, messages and the small words work without MuJoCo."""
    mjcf_parser = PACKAGE / "loaders" / "mjcf" / "engine.py"  # only MuJoCo can say what an MJCF file means
    users = {room_of(p) for p in FILES if p != mjcf_parser and _imports(p, {"mujoco"})}
    assert not users & ({"scene", "loaders"} | SMALL_WORDS)


def _imports(path: Path, packages: set[str]) -> bool:
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import) and any(a.name.split(".")[0] in packages for a in node.names):
            return True
        if isinstance(node, ast.ImportFrom) and not node.level and (node.module or "").split(".")[0] in packages:
            return True
    return False
