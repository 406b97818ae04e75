"""A damaged installation of MuJoCo is one clear error with the repair, and files of the user disturb no import."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import mujoco
import pytest

from simkit import mujoco_import
from simkit.errors import InstallationError

ROOT = Path(__file__).resolve().parents[1]
REPAIR = "python -m pip install --force-reinstall 'mujoco>=4.0,<5'"
STUBS = {
    "missing": ("raise ModuleNotFoundError(\"No module named 'mujoco'\", name='mujoco')", "MuJoCo is not installed"),
    "old": ("__version__ = '3.3.2'", "MuJoCo 3.3.2 is installed, but simkit needs mujoco>=4.0,<5"),
    "mixed": ("raise ImportError('generic_type: type \"MjModel\" is already registered')", "MuJoCo cannot be imported"),
    "incomplete": ("__version__ = '4.0.0'", "MuJoCo cannot be imported"),
    "unloadable": (
        "raise OSError('libmujoco.so.3.3.2: cannot open shared object file')",
        "(libmujoco.so.3.3.2: cannot",
    ),
}


def run(*words: str, cwd: Path, stub: Path | None = None) -> subprocess.CompletedProcess[str]:
    path = os.pathsep.join([*([str(stub)] if stub else []), str(ROOT), *sys.path])
    environment = {**os.environ, "PYTHONPATH": path}
    environment.pop("PYTHONSAFEPATH", None)
    return subprocess.run(
        [sys.executable, *words], cwd=cwd, env=environment, capture_output=True, text=True, check=False, timeout=100
    )


def package(folder: Path, text: str) -> Path:
    """Write a package `mujoco` and return its parent."""
    (folder / "site" / "mujoco").mkdir(parents=True)
    (folder / "site" / "mujoco" / "__init__.py").write_text(text)
    return folder / "site"


@pytest.mark.parametrize("name", STUBS)
def test_a_command_without_a_sound_engine_prints_the_repair(name: str, tmp_path: Path) -> None:
    text, reason = STUBS[name]
    found = run("-m", "simkit", "check", "turtlebot3_empty", cwd=tmp_path, stub=package(tmp_path, text))
    assert found.returncode == 1 and found.stdout == ""
    first, second = found.stderr.splitlines()
    assert first.startswith("error: SK-CORE-005") and reason in first and second == f"    help: {REPAIR}"


def test_too_few_file_handles_are_no_reason_to_reinstall(tmp_path: Path) -> None:
    stub = package(tmp_path, "import errno, os\nraise OSError(errno.EMFILE, os.strerror(errno.EMFILE))")
    found = run("-m", "simkit", "check", "turtlebot3_empty", cwd=tmp_path, stub=stub)
    assert found.returncode == 1 and found.stderr.endswith("help: allow more open files: ulimit -n 1024\n")


def test_loading_and_importing_a_command_raise_the_same_error(tmp_path: Path) -> None:
    stub = package(tmp_path, STUBS["old"][0])
    program = (
        "import simkit\ntry: simkit.load('turtlebot3_empty')\nexcept simkit.SimkitError as error: print(error.code)"
    )
    assert run("-c", program, cwd=tmp_path, stub=stub).stdout == "SK-CORE-005\n"
    golden = run("-m", "simkit", "golden", "check", ".", cwd=tmp_path, stub=stub)
    assert (
        golden.returncode == 1 and golden.stderr.startswith("error: SK-CORE-005") and "Traceback" not in golden.stderr
    )


def test_doctor_reports_a_damaged_engine_with_its_other_results(tmp_path: Path) -> None:
    found = run("-m", "simkit", "doctor", cwd=tmp_path, stub=package(tmp_path, STUBS["mixed"][0]))
    assert found.returncode == 1 and found.stderr == ""
    lines = found.stdout.splitlines()
    assert any(line.startswith("numpy ") for line in lines) and lines[-2:] == [
        f"    help: {REPAIR}",
        "problems found; see the lines above",
    ]


@pytest.fixture
def installed(tmp_path: Path) -> Path:
    """Return the package folder of an installation in a folder of its own, with a list of its libraries."""
    folder = tmp_path / "mujoco"
    (folder / "plugin").mkdir(parents=True)
    for name in ("libmujoco.so.4.0.0", "_structs.so", "plugin/libsensor.so"):
        (folder / name).touch()
    record = tmp_path / "mujoco_core-4.0.0.dist-info"
    record.mkdir()
    names = ("mujoco/__init__.py", "mujoco/libmujoco.so.4.0.0", "mujoco/_structs.so", "mujoco/plugin/libsensor.so")
    (record / "RECORD").write_text("".join(f"{name},sha256=x,1\n" for name in names))
    return folder


def test_a_sound_installation_has_no_damage(installed: Path) -> None:
    assert mujoco_import._damage(installed, "4.0.0") is None
    assert mujoco_import._damage(Path(mujoco.__file__).parent, mujoco.__version__) is None


@pytest.mark.parametrize(
    "left", ["mujoco/libmujoco.so.3.3.2", "mujoco-3.3.2.dist-info", "mujoco/libmujoco.3.2.1.dylib"]
)
def test_files_of_an_older_version_are_named_and_removed_by_the_repair(left: str, installed: Path) -> None:
    (installed.parent / left).mkdir()
    found = mujoco_import._damage(installed, "4.0.0")
    assert isinstance(found, InstallationError) and Path(left).name in str(found)
    remedy = str(found).partition("help: ")[2]
    assert remedy.startswith(f"rm -r '{installed}' ") and remedy.endswith(f" && {REPAIR}")


def test_a_missing_plugin_folder_is_damage(installed: Path) -> None:
    shutil.rmtree(installed / "plugin")
    assert "mujoco/plugin/libsensor.so is missing" in str(mujoco_import._damage(installed, "4.0.0"))


def test_files_named_as_modules_of_the_standard_library_disturb_nothing(tmp_path: Path) -> None:
    for name in ("types", "random", "enum", "signal", "copy", "json", "ctypes"):
        (tmp_path / f"{name}.py").write_text(f"raise SystemExit('the module {name} of the user')")
    found = run("-m", "simkit", "run", "turtlebot3_empty", "--duration", "0.1", "-q", cwd=tmp_path)
    assert found.returncode == 0 and "of the user" not in found.stdout + found.stderr


def test_the_requirement_is_that_of_the_package() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert mujoco_import.REQUIREMENT in project["dependencies"]


def test_the_window_library_is_loaded_at_its_first_use(tmp_path: Path) -> None:
    pytest.importorskip("glfw")
    code = """
import sys
from simkit.mujoco_import import import_mujoco
import_mujoco()
import glfw, mujoco
assert "glfw.library" not in sys.modules and not hasattr(glfw, "__wrapped__")
from glfw import get_version_string, init
assert "glfw.library" in sys.modules and get_version_string()[:2] == b"3." and init is glfw.init
"""
    done = run("-c", code, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
