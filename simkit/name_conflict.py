"""Detection of another project's files in simkit's folder.

The package index has a distribution `simkit` for computer animation, which uses the same import name. If both are
installed in one environment, its `simkit/__init__.py` replaces the one of this project, or is replaced by it.
"""

from __future__ import annotations

import sys
from importlib.metadata import Distribution, PackageNotFoundError, distribution
from pathlib import Path
from typing import Final

from simkit.install_command import install_command

CODE: Final = "SK-CORE-007"
_OTHER: Final = "simkit"  # the distribution of this project is `simkit-robotics`
_FOLDER: Final = Path(__file__).parent


def find_conflict() -> str:
    """Return the problem and its remedy, with a diagnostic code; empty if the folder has only files of this project."""
    other = _other_distribution()
    shared = _shared_files(other) if other is not None else []
    is_replaced = not hasattr(sys.modules["simkit"], "_DISTRIBUTION")
    if not is_replaced and not shared:
        return ""
    problem = f"{_FOLDER / '__init__.py'} is missing, or is a file of another project"
    if other is not None and shared:
        effect = "its __init__.py has replaced that of simkit" if is_replaced else "they use the same import name"
        problem = (
            f"another project, the distribution {_OTHER} {other.version} for computer animation, has {len(shared)}"
            f" files in {_FOLDER}; {effect}"
        )
    repair = install_command(option="--force-reinstall --no-deps")
    uninstall = f"pip uninstall {_OTHER}, then " if shared else ""
    return f"{CODE} {problem}\n    help: {uninstall}{repair}; install the other project in an environment of its own"


def conflict_error() -> ImportError:
    """Return the error for an import that fails because the package's own `__init__.py` is missing or replaced."""
    return ImportError(find_conflict(), name="simkit", path=str(_FOLDER))


def _other_distribution() -> Distribution | None:
    try:
        return distribution(_OTHER)
    except PackageNotFoundError:
        return None


def _shared_files(other: Distribution) -> list[Path]:
    """Return the files of a distribution that lie in the folder of this package."""
    folder = _FOLDER.resolve()
    files = [Path(str(other.locate_file(file))) for file in other.files or ()]
    return [file for file in files if folder in file.resolve().parents and file.exists()]
