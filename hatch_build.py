"""Hooks of the build: the packs in `packs/` become packages and entry points of simkit's wheel.

`pyproject.toml` declares the folders of the packs (`[tool.simkit]`), and the file `pack.toml` in each folder names its
package. With `SIMKIT_PACKS=none`, the wheel has the core alone.
"""

from __future__ import annotations

import os
import tempfile
import tomllib
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface
from hatchling.metadata.plugin.interface import MetadataHookInterface

_VARIABLE = "SIMKIT_PACKS"
_GROUP = "simkit.packs"


def declared_packs(root: Path) -> dict[str, Path]:
    """Return the folder of the package of each pack by the name of its entry point.

    Raises:
        ValueError: a declared pack is missing, a pack is not declared, or the environment variable has another value.
    """
    choice = os.environ.get(_VARIABLE, "all")
    if choice not in ("all", "none"):
        raise ValueError(f"{_VARIABLE}={choice}: expected all or none")
    declared = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["simkit"]["packs"]
    present = sorted(file.parent.name for file in (root / "packs").glob("*/pack.toml"))
    if choice == "none":
        return {}
    if sorted(declared) != present:
        raise ValueError(f"pyproject.toml declares the packs {sorted(declared)}; the folder packs has {present}")
    found = {}
    for folder in present:
        table = tomllib.loads((root / "packs" / folder / "pack.toml").read_text(encoding="utf-8"))
        package = root / "packs" / folder / table["package"]
        if not (package / "__init__.py").is_file():
            raise ValueError(f"packs/{folder}/pack.toml names the package {table['package']}, which is missing")
        found[table["name"]] = package
    return found


class PackEntryPoints(MetadataHookInterface):
    """Hook that adds one entry point for each pack."""

    def update(self, metadata: dict[str, Any]) -> None:
        """Add the entry points to those in the hook's table in `pyproject.toml`."""
        points = {name: folder.name for name, folder in declared_packs(Path(self.root)).items()}
        metadata["entry-points"] = {**self.config["entry-points"], **({_GROUP: points} if points else {})}


class PackPackages(BuildHookInterface[Any]):
    """Hook that adds the packages of the packs to the wheel, or their folders to the path of an editable install."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Add files to the build."""
        folders = declared_packs(Path(self.root)).values()
        if version != "editable":
            build_data["force_include"].update({str(folder): folder.name for folder in folders})
        elif folders:
            self._made = tempfile.TemporaryDirectory()
            file = Path(self._made.name, "packs.pth")
            file.write_text("".join(f"{folder.parent}\n" for folder in folders), encoding="utf-8")
            build_data["force_include_editable"][str(file)] = "_simkit_packs.pth"
