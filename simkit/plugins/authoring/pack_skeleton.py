"""Generator of the files of a new pack: each kind of content once, small, and with a test."""

from __future__ import annotations

import keyword
import re
import sys
from pathlib import Path
from typing import Final

from simkit.errors import InputError
from simkit.packs import installed_packs
from simkit.plugins.authoring.plugin_skeleton import TEMPLATES, fill_template, write_files

_NAME: Final = re.compile(r"[a-z][a-z0-9_]{0,39}")
_BAD: Final = "SK-PLUGIN-077"


def write_pack(name: str, folder: Path, *, overwrite: bool = False) -> list[Path]:
    """Write a pack with a plugin, a sensor, a command, a diagnostic code, a world and tests.

    Args:
        name: name of the pack; its package is `simkit_<name>`.
        folder: folder for the files.
        overwrite: True to replace files that exist.

    Returns:
        Written files, in the order of writing.

    Raises:
        InputError: SK-PLUGIN-077 the name cannot be that of a pack, or an installed pack has it. SK-PLUGIN-074 a file
            cannot be written, or exists already and `overwrite` is false.
    """
    area = re.sub(r"[^a-z]", "", name).upper()
    if not _NAME.fullmatch(name) or keyword.iskeyword(name):
        hint = "use lower-case letters, digits and _, with a letter first"
        raise InputError(f"{_BAD} {name!r:.80} cannot be the name of a pack\n    help: {hint}", _BAD)
    if any(pack.package == f"simkit_{name}" for pack in installed_packs()) or name in sys.stdlib_module_names:
        raise InputError(f"{_BAD} there is a pack or module {name!r} already\n    help: use another name", _BAD)
    title = "".join(part.capitalize() for part in name.split("_"))
    files = {}
    for template in sorted(path for path in (TEMPLATES / "pack").rglob("*.j2")):
        inside = template.relative_to(TEMPLATES).as_posix()
        place = inside.removeprefix("pack/").removesuffix(".j2").replace("NAME", name).replace("AREA", area.lower())
        files[folder / place] = fill_template(inside, name=name, title=title, area=area)
    return write_files(files, overwrite=overwrite)
