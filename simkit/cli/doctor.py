"""Command `simkit doctor`: report the installed and missing parts, with remedies."""

from __future__ import annotations

import os
import platform
import subprocess
import sys
from importlib.metadata import PackageNotFoundError, distribution, version
from pathlib import Path

from simkit.cli.terminal.output import report_errors, stdout_console
from simkit.version import __version__

_PACKAGES = (
    "numpy",
    "lxml",
    "trimesh",
    "opencv-python-headless",
    "rosbags",
    "mcap",
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
_REINSTALL = "pip uninstall -y mujoco mujoco-core && pip install 'mujoco>=4.0,<5'"
_RENDERER_TIMEOUT = 60.0  # [s]

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


@report_errors
def doctor() -> int:
    """Check the installation and print a remedy for each problem."""
    broken = _versions() + _engine()
    unusable = _renderer()
    _folders()
    for problem in (*broken, *unusable):
        stdout_console().print(problem, style="yellow")
    stdout_console().print("no problems found" if not (broken or unusable) else "problems found; see the lines above")
    return 1 if broken else 0


def _line(name: str, value: str) -> None:
    stdout_console().print(f"{name:<24}{value}")


def _versions() -> list[str]:
    _line("simkit", __version__)
    _line("python", f"{platform.python_version()} ({sys.executable})")
    _line("platform", f"{platform.system()} {platform.machine()}, {os.cpu_count()} cores")
    problems = []
    for name in _PACKAGES:
        try:
            _line(name, version(name))
        except PackageNotFoundError:
            _line(name, "missing")
            problems.append(f"{name} is missing: pip install --force-reinstall simkit-robotics")
    return problems


def _engine() -> list[str]:
    """Report the version of MuJoCo, and mixtures of 3.x and 4.x that an in-place upgrade can leave."""
    found: dict[str, str] = {}
    for name in ("mujoco", "mujoco-core"):
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            found[name] = ""
    _line("mujoco", f"{found['mujoco'] or 'missing'} (core {found['mujoco-core'] or 'missing'})")
    problems = []
    if not found["mujoco"] or not found["mujoco-core"] or found["mujoco"] != found["mujoco-core"]:
        problems.append(
            f"mujoco and mujoco-core are missing or have different versions, as after an upgrade from 3.x: {_REINSTALL}"
        )
    elif not found["mujoco"].startswith("4."):
        problems.append(f"simkit needs mujoco 4: {_REINSTALL}")
    probe = subprocess.run(
        [sys.executable, "-P", "-c", "import mujoco; print(mujoco.__version__)"],
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "MUJOCO_GL": "disable"},  # a missing renderer is not a fault of the engine
    )
    if probe.returncode:
        problems.append(f"mujoco cannot be imported ({_last_line(probe.stderr)}): {_REINSTALL}")
    return problems


def _renderer() -> list[str]:
    try:
        probe = subprocess.run(
            [sys.executable, "-P", "-c", _DRAW], capture_output=True, text=True, check=False, timeout=_RENDERER_TIMEOUT
        )
    except subprocess.TimeoutExpired:
        _line("renderer", "hangs")
        return [
            f"rendering a small image took more than {_RENDERER_TIMEOUT:g} s; cameras and --picture do not work here"
        ]
    answer = next((line for line in probe.stdout.splitlines() if line.startswith("OK ")), None)
    if answer is None:
        reason = (
            _last_line(probe.stderr) if probe.returncode >= 0 else f"the driver crashed with signal {-probe.returncode}"
        )
        _line("renderer", "none (only cameras and --picture need one)")
        return [f"no renderer: {reason}"]
    _line("renderer", answer.removeprefix("OK ").removesuffix(" black").strip())
    return ["the renderer draws only black images"] if answer.endswith(" black") else []


def _folders() -> None:
    for name in _FOLDERS:
        for folder in filter(None, os.environ.get(name, "").split(os.pathsep)):
            _line(name, folder if Path(folder).is_dir() else f"{folder} (missing)")
    try:
        location = str(distribution("simkit-robotics").locate_file(""))
    except PackageNotFoundError:
        location = "run from a checkout"
    _line("installed in", location)


def _last_line(text: str) -> str:
    lines = [line for line in text.strip().splitlines() if line.strip()]
    return lines[-1] if lines else "no message"
