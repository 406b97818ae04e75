"""Command `simkit doctor`: report the installed and missing parts, with remedies."""

from __future__ import annotations

import os
import platform
import subprocess
import sys
from importlib.metadata import PackageNotFoundError, distribution, version
from pathlib import Path
from typing import Any

from simkit.cli.terminal import options
from simkit.cli.terminal.json_report import add_to_report, report_errors_and_json
from simkit.cli.terminal.output import stdout_console
from simkit.install_command import install_command
from simkit.mujoco_import import REINSTALL
from simkit.name_conflict import find_conflict
from simkit.version import __version__

_PACKAGES = (
    "numpy",
    "lxml",
    "trimesh",
    "opencv-python-headless",
    "rosbags",
    "typer",
    "rich",
    "PyYAML",
    "Jinja2",
    "PyOpenGL",
)
_FOLDERS = (
    "SIMKIT_RESOURCE_PATH",
    "GZ_SIM_RESOURCE_PATH",
    "SDF_PATH",
    "GAZEBO_MODEL_PATH",
    "ROS_PACKAGE_PATH",
    "AMENT_PREFIX_PATH",
    "SIMKIT_SAVE_PATH",
)
_RENDERER_TIMEOUT = 60.0  # [s]

_IMPORT_ENGINE = """
import sys
from simkit.errors import InstallationError
from simkit.mujoco_import import import_mujoco
try:
    import_mujoco()
except InstallationError as error:
    print(error)
    sys.exit(1)
"""

# Graphics drivers can crash the process; in a separate process, the crash is one more result of the check.
_DRAW = """
import simkit
from simkit.mujoco_import import import_mujoco
import_mujoco()
from simkit.sensors.cameras.rendering.gl_context import describe_renderer
from simkit.sensors.cameras.rendering.overview_image import render_view
world = ("<sdf version='1.12'><world name='w'><model name='m'><static>true</static><link name='l'><visual name='v'>"
         "<geometry><sphere><radius>1</radius></sphere></geometry></visual></link></model></world></sdf>")
with simkit.load(world) as sim:
    picture = render_view(sim, 64, 48)
print("OK", describe_renderer() or "renderer", "black" if picture.max() == picture.min() else "")
"""


@report_errors_and_json
def doctor(json_: options.Json = False) -> int:  # noqa: ARG001 (`report_errors_and_json` reads it)
    """Check the installation and print a remedy for each problem."""
    found: dict[str, str] = {}
    missing, engine = _versions(found), _engine(found)
    broken = missing + engine
    unusable = [] if engine else _renderer(found)
    unusable += list(filter(None, [find_conflict()]))
    for name, value in found.items():
        _line(name, value)
    folders = _folders()
    for folder in folders:
        _line(folder["variable"], folder["folder"] + ("" if folder["exists"] else " (missing)"))
    _line("installed in", _location())
    add_to_report(found=found, folders=folders, installed_in=_location(), problems=[*broken, *unusable])
    for problem in (*broken, *unusable):
        stdout_console().print(problem, style="yellow")
    stdout_console().print("no problems found" if not (broken or unusable) else "problems found; see the lines above")
    return 1 if broken else 0


def _line(name: str, value: str) -> None:
    stdout_console().print(f"{name:<24}{value}")


def _versions(found: dict[str, str]) -> list[str]:
    """Add the versions to `found`, and return the problems."""
    found["simkit"] = __version__
    found["python"] = f"{platform.python_version()} ({sys.executable})"
    found["platform"] = f"{platform.system()} {platform.machine()}, {os.cpu_count()} cores"
    problems = []
    for name in _PACKAGES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            found[name] = "missing"
            problems.append(f"{name} is missing: {install_command(option='--force-reinstall')}")
    return problems


def _engine(found: dict[str, str]) -> list[str]:
    """Report the version of MuJoCo and a damaged installation, such as a mixture of 3.x and 4.x."""
    versions: dict[str, str] = {}
    for name in ("mujoco", "mujoco-core"):
        try:
            versions[name] = version(name)
        except PackageNotFoundError:
            versions[name] = "missing"
    found["mujoco"] = f"{versions['mujoco']} (core {versions['mujoco-core']})"
    probe = subprocess.run(
        [sys.executable, "-P", "-c", _IMPORT_ENGINE],
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "MUJOCO_GL": "disable"},  # a missing renderer is not a fault of the engine
    )
    if not probe.returncode:
        return []
    if "SK-CORE-005" in probe.stdout:
        return [probe.stdout[probe.stdout.index("SK-CORE-005") :].strip()]
    reason = f"signal {-probe.returncode}" if probe.returncode < 0 else _last_line(probe.stderr)
    return [f"SK-CORE-005 MuJoCo cannot be imported ({reason})\n    help: {REINSTALL}"]


def _renderer(found: dict[str, str]) -> list[str]:
    try:
        probe = subprocess.run(
            [sys.executable, "-P", "-c", _DRAW], capture_output=True, text=True, check=False, timeout=_RENDERER_TIMEOUT
        )
    except subprocess.TimeoutExpired:
        found["renderer"] = "hangs"
        return [
            f"rendering a small image took more than {_RENDERER_TIMEOUT:g} s; cameras and --picture do not work here"
        ]
    answer = next((line for line in probe.stdout.splitlines() if line.startswith("OK ")), None)
    if answer is None:
        reason = (
            _last_line(probe.stderr) if probe.returncode >= 0 else f"the driver crashed with signal {-probe.returncode}"
        )
        found["renderer"] = "none (only cameras and --picture need one)"
        return [f"no renderer: {reason}"]
    found["renderer"] = answer.removeprefix("OK ").removesuffix(" black").strip()
    return ["the renderer draws only black images"] if answer.endswith(" black") else []


def _folders() -> list[dict[str, Any]]:
    return [
        {"variable": name, "folder": folder, "exists": Path(folder).is_dir()}
        for name in _FOLDERS
        for folder in filter(None, os.environ.get(name, "").split(os.pathsep))
    ]


def _location() -> str:
    try:
        return str(distribution("simkit-robotics").locate_file(""))
    except PackageNotFoundError:
        return "run from a checkout"


def _last_line(text: str) -> str:
    lines = [line for line in text.strip().splitlines() if line.strip()]
    return lines[-1] if lines else "no message"
