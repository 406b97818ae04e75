"""Files of the other project `simkit` in our folder are told, with the way out.

The folder of the package is rebuilt of links here. The other project lies in it as `simkit` 0.1.8 of the package index
does: its `__init__.py` has the place of ours, and its other files lie between ours.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[1] / "simkit"
COMMAND = "from simkit.cli import main; main()"
HELP = 'pip install --force-reinstall --no-deps "simkit-robotics @ git+https://github.com/simkit-robotics/simkit"'


def install_simkit(site: Path) -> None:
    (site / "simkit").mkdir(parents=True)
    for path in PACKAGE.iterdir():
        (site / "simkit" / path.name).symlink_to(path)


def install_other(site: Path) -> None:
    files = ("__init__.py", "area_normals.py")
    for name in files:
        (site / "simkit" / name).unlink(missing_ok=True)
        (site / "simkit" / name).write_text("__version__ = '0.1.8'\n", encoding="utf-8")
    about = site / "simkit-0.1.8.dist-info"
    about.mkdir()
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: simkit\nVersion: 0.1.8\n", encoding="utf-8")
    (about / "RECORD").write_text("".join(f"simkit/{name},,\n" for name in files), encoding="utf-8")


def restore_front(site: Path) -> None:
    (site / "simkit" / "__init__.py").unlink()
    (site / "simkit" / "__init__.py").symlink_to(PACKAGE / "__init__.py")


def python(site: Path, code: str, *words: str) -> subprocess.CompletedProcess[str]:
    """Run code with the packages of this Python, and with simkit from a folder only."""
    others = [str(_without_simkit(Path(path), site)) for path in sys.path if path and Path(path).is_dir()]
    return subprocess.run(
        [sys.executable, "-S", "-P", "-c", code, *words],
        env={**os.environ, "PYTHONPATH": os.pathsep.join([str(site), *others])},
        cwd=site,
        capture_output=True,
        text=True,
        encoding="utf-8",
        check=False,
    )


def _without_simkit(folder: Path, site: Path) -> Path:
    """Return a folder of packages; if simkit is installed there, one of links to the others."""
    if not (folder / "simkit" / "__init__.py").is_file():
        return folder
    links = site.parent / f"others{abs(hash(folder))}"
    if not links.exists():
        links.mkdir()
        for path in folder.iterdir():
            if path.name != "simkit":
                (links / path.name).symlink_to(path)
    return links


@pytest.fixture
def site(tmp_path: Path) -> Path:
    install_simkit(tmp_path / "site")
    return tmp_path / "site"


def test_without_the_other_project_nothing_is_told_and_nothing_is_looked_for(site: Path) -> None:
    found = python(site, "import sys, simkit.errors\nprint('importlib.metadata' in sys.modules)")
    assert (found.returncode, found.stdout, found.stderr) == (0, "False\n", "")
    found = python(site, "from simkit.name_conflict import find_conflict\nprint(find_conflict())")
    assert (found.returncode, found.stdout, found.stderr) == (0, "\n", "")


@pytest.mark.parametrize("words", [("doctor",), ("check", "empty")])
def test_a_command_tells_that_the_other_project_has_replaced_the_first_file(site: Path, words: tuple[str, ...]) -> None:
    install_other(site)
    found = python(site, COMMAND, *words)
    assert found.returncode == 1
    assert found.stderr.startswith(
        "error: SK-CORE-007 another project, the distribution simkit 0.1.8 for computer animation, has 2 files in "
    )
    assert "its __init__.py has replaced that of simkit" in found.stderr
    assert f"help: pip uninstall simkit, then {HELP}" in found.stderr


def test_an_import_of_a_module_tells_it(site: Path) -> None:
    install_other(site)
    found = python(site, "import simkit.live")
    assert "ImportError: SK-CORE-007 another project, the distribution simkit 0.1.8" in found.stderr


def test_doctor_tells_files_beside_ours(site: Path) -> None:
    install_other(site)
    restore_front(site)
    found = python(site, COMMAND, "doctor")
    assert "SK-CORE-007 another project, the distribution simkit 0.1.8" in found.stdout.replace("\n", " ")
    assert "they use the same import name" in found.stdout.replace("\n", " ")


def test_a_name_of_the_other_project_is_told(site: Path) -> None:
    install_other(site)
    restore_front(site)
    found = python(site, "import simkit\nsimkit.arap_energy")
    assert "AttributeError: module 'simkit' has no attribute 'arap_energy'\nSK-CORE-007 another project" in found.stderr


def test_a_missing_first_file_is_told(site: Path) -> None:
    """`pip uninstall simkit` removes it, although it is ours by then."""
    (site / "simkit" / "__init__.py").unlink()
    found = python(site, COMMAND, "check", "empty")
    assert found.returncode == 1
    assert "__init__.py is missing, or is a file of another project\n    help: pip install --force" in found.stderr
