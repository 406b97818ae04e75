"""New plugins and their tests as files."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from simkit.authoring.new import Wanted
from simkit.authoring.skeleton import plugin_text
from simkit.authoring.skeleton_test import test_text
from simkit.errors import InputError

_THERE = "SK-PLUGIN-074"


def write(wanted: Sequence[Wanted], folder: Path, *, overwrite: bool = False) -> list[Path]:
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
        raise InputError(f"{_THERE} there already: {', '.join(there)}; --force replaces", _THERE)
    for path, text in files.items():
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        except OSError as error:
            raise InputError(f"{_THERE} cannot write {path}: {error.strerror}", _THERE) from error
    return list(files)
