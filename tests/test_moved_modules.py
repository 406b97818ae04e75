"""Modules by the names that they had in the core."""

from __future__ import annotations

import importlib
import subprocess
import sys
from pathlib import Path

import pytest

from simkit.deprecation import SimkitDeprecationWarning, removal_version

ROOT = Path(__file__).resolve().parents[1]
FILES = sorted(ROOT.glob("packs/*/simkit_*/moved_modules.txt"))
NAMES = [line.split() for file in FILES for line in file.read_text(encoding="utf-8").splitlines()]


@pytest.mark.parametrize(("old", "new", "since"), NAMES)
def test_an_old_name_has_the_same_classes_and_a_warning(
    old: str, new: str, since: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name, _, _ in NAMES:
        monkeypatch.delitem(sys.modules, name, raising=False)
    expected = f"^{old} is deprecated since simkit {since} and will be removed in {removal_version(since)}: use {new}$"
    with pytest.warns(SimkitDeprecationWarning, match=expected) as warned:
        found = importlib.import_module(old)
    assert warned[0].filename == importlib.__file__  # `importlib.import_module`: the caller, as for an `import`
    names = vars(importlib.import_module(new))
    assert {name for name in names if not name.startswith("__")} <= set(vars(found))
    assert all(vars(found)[name] is value for name, value in names.items() if isinstance(value, type))
    for name, _, _ in NAMES:
        sys.modules.pop(name, None)


def test_a_module_that_never_was_is_not_found() -> None:
    with pytest.raises(ModuleNotFoundError, match=r"No module named 'simkit\.plugins\.world\.map_sever'"):
        importlib.import_module("simkit.plugins.world.map_sever")


@pytest.mark.needs_packs
def test_a_moved_module_runs_as_a_program_by_its_old_name() -> None:
    ended = subprocess.run(
        [sys.executable, "-m", "simkit.testing.certify"], capture_output=True, text=True, check=False
    )
    assert ended.returncode == 1 and "missing 2 required positional arguments: 'request' and 'result'" in ended.stderr
