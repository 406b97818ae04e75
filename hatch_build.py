"""Hooks of the build: the packs in `packs/` become packages and entry points of simkit's wheel.

`pyproject.toml` declares the folders of the packs (`[tool.simkit]`), and the file `pack.toml` in each folder names its
package. With `SIMKIT_PACKS=none`, the wheel has the core alone.
"""

from __future__ import annotations

import ast
import json
import os
import tempfile
import tomllib
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface
from hatchling.metadata.plugin.interface import MetadataHookInterface

_VARIABLE = "SIMKIT_PACKS"
_GROUP = "simkit.packs"
_PYTEST = "pytest11"
_NAMES = {"plugins": ("filenames", "names", "entities", "hooks", "factories"), "sensors": ("kinds",)}
"""Class attributes with the names by which plugins and sensors are found, by the folder of the classes."""


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


def left_out_names(root: Path) -> dict[str, dict[str, str]]:
    """Return the pack of each name: of its plugins and sensors by class attribute, of its commands and demo steps.

    The core alone uses them in its messages.
    """
    found: dict[str, dict[str, str]] = {
        attribute: {} for attribute in (*_NAMES["plugins"], *_NAMES["sensors"], "commands", "demo_steps")
    }
    for toml in sorted((root / "packs").glob("*/pack.toml")):
        table = tomllib.loads(toml.read_text(encoding="utf-8"))
        for folder, attributes in _NAMES.items():
            for file in sorted((toml.parent / table["package"] / folder).rglob("*.py")):
                for attribute, name in _class_names(ast.parse(file.read_text(encoding="utf-8")), attributes):
                    found[attribute][name] = table["name"]
        for file in sorted((toml.parent / table["package"] / "cli").glob("[a-z]*.py")):
            found["commands"][file.stem] = table["name"]
        for file in sorted((toml.parent / table["package"] / "cli" / "demo_steps").glob("*/step.toml")):
            found["demo_steps"][file.parent.name] = table["name"]
    return found


def _class_names(tree: ast.Module, attributes: Sequence[str]) -> Iterator[tuple[str, str]]:
    """Yield attribute and text of each name that the classes of a module assign to these attributes as literals."""
    for cls in (node for node in tree.body if isinstance(node, ast.ClassDef)):
        for statement in (node for node in cls.body if isinstance(node, ast.Assign)):
            names = (node.id for node in statement.targets if isinstance(node, ast.Name))
            for target in (name for name in names if name in attributes):
                texts = (node.value for node in ast.walk(statement.value) if isinstance(node, ast.Constant))
                yield from ((target, text) for text in texts if isinstance(text, str))


class PackEntryPoints(MetadataHookInterface):
    """Hook that adds one entry point for each pack, and one for the pytest plugin of a pack."""

    def update(self, metadata: dict[str, Any]) -> None:
        """Add the entry points to those in the hook's table in `pyproject.toml`."""
        folders = declared_packs(Path(self.root))
        points = {name: folder.name for name, folder in folders.items()}
        groups = {**self.config["entry-points"], **({_GROUP: points} if points else {})}
        of_packs = [folder.name for folder in folders.values() if (folder / "pytest_plugin.py").is_file()]
        groups[_PYTEST] = {**groups.get(_PYTEST, {}), **{package: f"{package}.pytest_plugin" for package in of_packs}}
        metadata["entry-points"] = {group: names for group, names in groups.items() if names}


class PackPackages(BuildHookInterface[Any]):
    """Hook that adds the packages of the packs to the wheel, or their folders to the path of an editable install."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Add files to the build."""
        folders = declared_packs(Path(self.root)).values()
        if not folders:
            self._made = tempfile.TemporaryDirectory()
            file = Path(self._made.name, "left_out_packs.json")
            file.write_text(json.dumps(left_out_names(Path(self.root)), indent=1), encoding="utf-8")
            build_data["force_include"][str(file)] = f"simkit/{file.name}"
        elif version != "editable":
            build_data["force_include"].update({str(folder): folder.name for folder in folders})
        else:
            self._made = tempfile.TemporaryDirectory()
            file = Path(self._made.name, "packs.pth")
            file.write_text("".join(f"{folder.parent}\n" for folder in folders), encoding="utf-8")
            build_data["force_include_editable"][str(file)] = "_simkit_packs.pth"
