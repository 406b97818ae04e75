"""Generator of the files of a new pack: each kind of content once, small, and with a test."""

from __future__ import annotations

import builtins
import keyword
import re
import sys
from collections.abc import Collection
from pathlib import Path
from typing import Final

from simkit.errors import InputError
from simkit.loaders.resources.bundled_models import bundled_names
from simkit.packs import installed_packs, pack_folders, shipped_folders
from simkit_authoring.plugin_skeleton import TEMPLATES, fill_template, write_files

_NAME: Final = re.compile(r"(?=.{1,40}$)[a-z](?:_?[a-z0-9])*")  # also the name of a package of messages
_BAD: Final = "SK-PLUGIN-077"
_WORDS: Final = frozenset((*dir(builtins), "simkit", "typer"))
"""Names that the module of the new command uses."""


def write_pack(name: str, folder: Path, *, commands: Collection[str] = (), overwrite: bool = False) -> list[Path]:
    """Write a pack with a plugin, a sensor, a message, a command, an option of a run, a code, a world and tests.

    Args:
        name: name of the pack; its package is `simkit_<name>`.
        folder: folder for the files.
        commands: names of all commands, which the pack cannot have.
        overwrite: True to replace files that exist.

    Returns:
        Written files, in the order of writing.

    Raises:
        InputError: SK-PLUGIN-077 the name cannot be that of a pack, or simkit or an installed pack has it.
            SK-PLUGIN-074 a file cannot be written, or exists already and `overwrite` is false.
    """
    area = re.sub(r"[^a-z]", "", name).upper()
    if not _NAME.fullmatch(name) or keyword.iskeyword(name):
        hint = "use lower-case letters, digits and single _ between them, with a letter first"
        raise InputError(_BAD, f"{name!r:.80} cannot be the name of a pack", help=hint)
    if any(pack.package == f"simkit_{name}" for pack in installed_packs()) or name in sys.stdlib_module_names:
        raise InputError(_BAD, f"there is a pack or module {name!r} already", help="use another name")
    codes = shipped_folders()[0] / "cli/diagnostic_codes", *map(Path, pack_folders("cli/diagnostic_codes"))
    taken = {
        f"the command `simkit {name}`": name in commands,
        f"the codes SK-{area}-NNN": any((folder / f"{area.lower()}.toml").is_file() for folder in codes),
        f"a world or model {name!r}": name in bundled_names(),
        f"{name!r} of Python or simkit": name in _WORDS,
    }
    if any(taken.values()):
        hint = f"use a name that no command, area of codes, world or model has, such as {name}_tools"
        listed = " and ".join(owner for owner, is_taken in taken.items() if is_taken)
        raise InputError(_BAD, f"a pack cannot have the name {name!r}: there is {listed} already", help=hint)
    title = "".join(part.capitalize() for part in name.split("_"))
    files = {}
    for template in sorted(path for path in (TEMPLATES / "pack").rglob("*.j2")):
        inside = template.relative_to(TEMPLATES).as_posix()
        place = inside.removeprefix("pack/").removesuffix(".j2").replace("NAME", name).replace("AREA", area.lower())
        files[folder / place] = fill_template(inside, name=name, title=title, area=area)
    return write_files(files, overwrite=overwrite)
