"""Examples that need an extra say so in one line: after a plain `pip install .` none ends with a traceback."""

from __future__ import annotations

import ast
import re
import runpy
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = [ROOT / "examples", *sorted(ROOT.glob("packs/*/examples"))]
OF_EXTRAS = ("matplotlib", "pvlib", "gymnasium")
CORE = {"simkit", "numpy", "cv2", "PIL", "scipy"}
BY_ITS_WORLD = "solar_tracker/day.py"  # its world has simkit's plugin of the sun


def imports(script: Path) -> set[str]:
    """Return the packages that a script imports, without those of Python and without files beside the script."""
    names = set()
    for node in ast.walk(ast.parse(script.read_text("utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name.partition(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            names.add((node.module or "").partition(".")[0])
    return {name for name in names - sys.stdlib_module_names if not (script.parent / f"{name}.py").exists()}


SCRIPTS = {path.relative_to(folder).as_posix(): path for folder in FOLDERS for path in sorted(folder.glob("**/*.py"))}
NEEDING = [
    name
    for name, script in SCRIPTS.items()
    if imports(script) - CORE or script.parent.name == "sensors" or name == BY_ITS_WORLD
]


@pytest.fixture
def without_extras(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    for name in OF_EXTRAS:
        monkeypatch.setitem(sys.modules, name, None)
    for name in ("plots", "moves"):  # modules of the examples, which another test may have imported
        monkeypatch.delitem(sys.modules, name, raising=False)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_the_list_of_packages_of_extras_is_whole() -> None:
    assert set().union(*(imports(script) for script in SCRIPTS.values())) <= CORE | set(OF_EXTRAS)


@pytest.mark.parametrize("name", NEEDING)
def test_an_example_names_the_extra_that_is_missing(
    name: str, without_extras: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The argument asks for a picture, where an example draws only a picture that is asked for."""
    script = SCRIPTS[name]
    arguments = [] if name in (BY_ITS_WORLD, "train_turtlebot3.py") else ["out.png"]
    monkeypatch.setattr(sys, "argv", [str(script), *arguments])
    monkeypatch.syspath_prepend(str(script.parent))
    with pytest.raises(SystemExit) as ended:
        runpy.run_path(str(script), run_name="__main__")
    install = r'pip install (matplotlib|"simkit-robotics\[(\w+)\] @ git\+https://.*")'
    told = re.fullmatch(rf".* needs? .*: {install}", str(ended.value.code))
    assert told is not None
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]["optional-dependencies"]
    assert told[1] == "matplotlib" or told[2] in extras
    assert list(without_extras.iterdir()) == []
