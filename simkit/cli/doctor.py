"""Command `simkit doctor`: report the installed and missing parts, with remedies."""

from __future__ import annotations

import json
import os
import platform
import re
import subprocess
import sys
from importlib.metadata import PackageNotFoundError, distribution, requires, version
from pathlib import Path

from simkit.cli.run_options import NONE_GIVEN, GivenOptions, with_run_options
from simkit.cli.terminal import options
from simkit.cli.terminal.json_report import add_to_report, report_errors_and_json
from simkit.cli.terminal.output import stdout_console
from simkit.install_command import install_command
from simkit.mujoco_import import REINSTALL
from simkit.name_conflict import find_conflict
from simkit.number_text import counted
from simkit.run_spec import JsonObject
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
_DISTRIBUTION = "simkit-robotics"
_DEVELOPMENT = ("dev", "test", "compare")  # extras that no use of simkit needs
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
import json, logging, sys, time
import simkit
from simkit.mujoco_import import import_mujoco
import_mujoco()
from simkit.sensors.cameras.overview_image import render_view
from simkit.sensors.cameras.renderer_choice import FALLBACK, UNKNOWN_REQUEST, describe_renderer
logging.disable()  # the note about the fallback is part of the result
world = ("<sdf version='1.12'><world name='w'><model name='m'><static>true</static><link name='l'><visual name='v'>"
         "<geometry><sphere><radius>1</radius></sphere></geometry></visual></link></model></world></sdf>")
try:
    with simkit.load(world, renderer=sys.argv[1]) as sim:
        times = []
        for _ in range(5):
            began = time.perf_counter()
            picture = render_view(sim, 320, 240)
            times.append(time.perf_counter() - began)
        notes = ["; ".join(filter(None, (f"{d.code} {d.message}", d.hint)))
                 for d in sim.diagnostics if d.code in (FALLBACK, UNKNOWN_REQUEST)]
        print("OK", json.dumps([describe_renderer(sim), min(times), bool(picture.max() == picture.min()), notes]))
except simkit.RenderError as error:
    print("NO", error)
"""
_USE_SOFTWARE = "    help: draw with --renderer software, or switch OpenGL off: export MUJOCO_GL=disable"


@report_errors_and_json
@with_run_options("renderer")
def doctor(
    given: GivenOptions = NONE_GIVEN,
    json_: options.Json = False,  # noqa: ARG001 (`report_errors_and_json` reads it)
) -> int:
    """Check the installation and print a remedy for each problem.

    The exit code is 1 if a required part or the renderer fails. A machine without OpenGL is a note, because the
    software renderer draws there.
    """
    requested = given.values.get("renderer", "auto")
    facts: dict[str, str] = {}
    notes = list(filter(None, [find_conflict()]))
    problems, engine = _versions(facts), _engine(facts)
    problems += engine or _renderer(facts, requested, notes)
    for name, value in facts.items():
        _line(name, value)
    folders = _folders()
    for folder in folders:
        _line(folder["variable"], folder["folder"] + ("" if folder["exists"] else " (missing)"))
    _line("installed in", _location())
    extras = _extras()
    _line("extras", ", ".join(name for name, missing in extras.items() if not missing) or "none")
    absent = [f"{name} ({', '.join(missing)})" for name, missing in extras.items() if missing]
    _line("extras without packages", ", ".join(absent) or "none")
    add_to_report(found=facts, folders=folders, installed_in=_location(), extras=extras, problems=problems, notes=notes)
    for note in notes:
        stdout_console().print(f"note: {note}")
    for problem in problems:
        stdout_console().print(problem, style="yellow")
    stdout_console().print("problems found; see the lines above" if problems else "no problems found")
    return 1 if problems else 0


def _extras() -> dict[str, list[str]]:
    """Return the packages that are missing for each extra; empty if the distribution is not installed."""
    try:
        needed = requires(_DISTRIBUTION) or []
    except PackageNotFoundError:
        return {}
    missing: dict[str, list[str]] = {}
    for requirement in needed:
        extra = re.search(r"extra == ['\"]([\w-]+)", requirement)
        name = re.match(r"[\w.-]+", requirement)
        if extra is None or name is None or extra[1] in _DEVELOPMENT:
            continue
        packages = missing.setdefault(extra[1], [])
        try:
            version(name[0])
        except PackageNotFoundError:
            packages.append(name[0])
    return dict(sorted(missing.items()))


def _line(name: str, value: str) -> None:
    stdout_console().print(f"{name:<24}{value}")


def _versions(facts: dict[str, str]) -> list[str]:
    """Add the versions to `facts`, and return the problems."""
    facts["simkit"] = __version__
    facts["python"] = f"{platform.python_version()} ({sys.executable})"
    facts["platform"] = f"{platform.system()} {platform.machine()}, {counted(os.cpu_count() or 1, 'core')}"
    problems = []
    for name in _PACKAGES:
        try:
            facts[name] = version(name)
        except PackageNotFoundError:
            facts[name] = "missing"
            problems.append(f"{name} is missing: {install_command(option='--force-reinstall')}")
    return problems


def _engine(facts: dict[str, str]) -> list[str]:
    """Report the version of MuJoCo and a damaged installation, such as a mixture of 3.x and 4.x."""
    versions: dict[str, str] = {}
    for name in ("mujoco", "mujoco-core"):
        try:
            versions[name] = version(name)
        except PackageNotFoundError:
            versions[name] = "missing"
    facts["mujoco"] = f"{versions['mujoco']} (core {versions['mujoco-core']})"
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


def _renderer(facts: dict[str, str], requested: str, notes: list[str]) -> list[str]:
    """Draw a small picture with the requested renderer; add the result to `facts` and `notes`, return the problems."""
    try:
        probe = subprocess.run(
            [sys.executable, "-P", "-c", _DRAW, requested],
            capture_output=True,
            text=True,
            check=False,
            timeout=_RENDERER_TIMEOUT,
        )
    except subprocess.TimeoutExpired:
        facts["renderer"] = "hangs"
        return [f"drawing a small picture took more than {_RENDERER_TIMEOUT:g} s\n{_USE_SOFTWARE}"]
    answer = next((line for line in probe.stdout.splitlines() if line[:3] in ("OK ", "NO ")), "")
    if answer.startswith("OK "):
        facts["renderer"], seconds, is_black, fallback = json.loads(answer[3:])
        facts["picture"] = f"320 × 240 px in {seconds * 1e3:.2g} ms"
        notes += fallback
        return [f"the renderer draws only black images: {facts['renderer']}\n{_USE_SOFTWARE}"] if is_black else []
    facts["renderer"] = "none"
    if answer:
        return [answer[3:]]
    if probe.returncode < 0:
        return [f"drawing ended the process with signal {-probe.returncode}\n{_USE_SOFTWARE}"]
    return [f"the renderer fails: {_last_line(probe.stderr)}"]


def _folders() -> list[JsonObject]:
    return [
        {"variable": name, "folder": folder, "exists": Path(folder).is_dir()}
        for name in _FOLDERS
        for folder in filter(None, os.environ.get(name, "").split(os.pathsep))
    ]


def _location() -> str:
    try:
        return str(distribution(_DISTRIBUTION).locate_file(""))
    except PackageNotFoundError:
        return "run from a checkout"


def _last_line(text: str) -> str:
    lines = [line for line in text.strip().splitlines() if line.strip()]
    return lines[-1] if lines else "no message"
