"""Users' names and extenders' names: what documents, examples, labs and packs may import from simkit."""

from __future__ import annotations

import ast
import importlib
import re
import subprocess
import sys
import types
from collections.abc import Iterator
from pathlib import Path

import pytest

import simkit
import simkit.extend
import simkit.recording
import simkit.testing

ROOT = Path(__file__).resolve().parents[1]
BY_THEIR_NAMES = {
    "input_file",
    "install_command",
    "lifecycle",
    "loaders.resources.bundled_models",
    "msgs.goal_status",
    "sensors",
    "sensors.presets",
    "yaml_reader",
}
"""Public modules that are not attributes of simkit after `import simkit`."""

PUBLIC_MODULES = {f"simkit.{name}" for name in (*simkit._PUBLIC_MODULES, *BY_THEIR_NAMES)}

PRIVATE_IMPORTS = {
    "actors": 8,
    "authoring": 19,
    "control": 24,
    "fuel": 18,
    "gz_python": 14,
    "identification": 20,
    "launch": 29,
    "learning": 45,
    "motion": 15,
    "navigation": 20,
    "nodes": 30,
    "open_rmf": 5,
    "realism": 18,
    "robots": 21,
    "ros": 9,
    "special_cameras": 18,
    "terminal": 13,
    "verification": 65,
    "view": 45,
    "water_and_air": 23,
}
"""Number of private modules of the core that each pack imports. A number may only shrink."""

DOCUMENTS = [
    *(ROOT / "docs").rglob("*.md"),
    *(ROOT / "packs").glob("*/README.md"),
    *(ROOT / "packs").glob("*/docs/**/*.md"),
    ROOT / "README.md",
]
SCRIPTS = [*(ROOT / "examples").rglob("*.py"), *(ROOT / "labs").rglob("*.py"), *ROOT.glob("packs/*/examples/**/*.py")]


def imported(source: str) -> Iterator[tuple[str, str]]:
    """Yield the module and the name of each import from simkit's core; the name is empty for `import module`."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] == "simkit":
            yield from ((node.module or "", alias.name) for alias in node.names)
        elif isinstance(node, ast.Import):
            yield from ((alias.name, "") for alias in node.names if alias.name.split(".")[0] == "simkit")


def is_public(module: str, name: str) -> bool:
    if module == "simkit":
        return not name or name in simkit.__all__ or f"simkit.{name}" in PUBLIC_MODULES
    return module in PUBLIC_MODULES


def code_in(document: Path) -> Iterator[str]:
    """Yield the blocks of Python code in a Markdown document."""
    for block in re.findall(r"^```(?:python|py)[^\n]*\n(.*?)^```", document.read_text(encoding="utf-8"), re.M | re.S):
        try:
            ast.parse(block)
        except SyntaxError:
            continue  # a part of a file, with dots
        yield block


@pytest.mark.parametrize("path", sorted({*DOCUMENTS, *SCRIPTS}), ids=lambda path: path.relative_to(ROOT).as_posix())
def test_documents_examples_and_labs_import_only_public_names(path: Path) -> None:
    sources = code_in(path) if path.suffix == ".md" else [path.read_text(encoding="utf-8")]
    names = {name for source in sources for name in imported(source)}
    assert not {name for name in names if not is_public(*name)}


@pytest.mark.parametrize("module", [simkit, simkit.extend, simkit.testing, simkit.recording], ids=lambda m: m.__name__)
def test_public_names_exist_and_have_types_for_editors(module: types.ModuleType) -> None:
    """A name is in `__all__`, in the imports for type checkers, and in the table of modules."""
    tree = ast.parse(Path(module.__file__ or "").read_text(encoding="utf-8"))
    block = next(n for n in tree.body if isinstance(n, ast.If) and "TYPE_CHECKING" in ast.unparse(n.test))
    homes = {alias.name: n.module for n in block.body if isinstance(n, ast.ImportFrom) for alias in n.names}
    lazy = {name: home for home, names in module._MODULES.items() for name in names}
    assert lazy.items() <= homes.items()
    assert set(module.__all__) - {"__version__"} == set(lazy)
    assert all(hasattr(module, name) for name in module.__all__)


def test_modules_for_users_are_attributes_of_simkit() -> None:
    for name in simkit._PUBLIC_MODULES:
        assert getattr(simkit, name) is importlib.import_module(f"simkit.{name}")


def test_at_most_76_names_are_for_extensions_and_a_page_explains_them() -> None:
    page = (ROOT / "docs" / "extend.md").read_text(encoding="utf-8")
    explained = {name for row in re.findall(r"^\| (`.*?) \|", page, re.M) for name in re.findall(r"`(\w+)`", row)}
    assert len(simkit.extend.__all__) <= 76
    assert set(simkit.extend.__all__) <= explained


def test_the_map_of_rooms_in_the_documents_is_that_of_the_code() -> None:
    """The numbers of lines may be older."""
    drawn = subprocess.run([sys.executable, "docs/room_map.py"], cwd=ROOT, capture_output=True, text=True, check=True)
    stored = (ROOT / "docs" / "images" / "rooms.svg").read_text(encoding="utf-8")
    numbers = re.compile(r"[\d,]+ (?=lines|small)")
    assert numbers.sub("", drawn.stdout) == numbers.sub("", stored)


def test_packs_import_ever_fewer_private_modules_of_the_core() -> None:
    private: dict[str, set[str]] = {}
    for file in ROOT.glob("packs/*/simkit_*/**/*.py"):
        names = imported(file.read_text(encoding="utf-8"))
        private.setdefault(file.relative_to(ROOT).parts[1], set()).update(
            module for module, name in names if not is_public(module, name)
        )
    assert {pack: len(modules) for pack, modules in private.items() if modules} == PRIVATE_IMPORTS
