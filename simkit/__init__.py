"""simkit: load Gazebo worlds and robots, step them with MuJoCo, and exchange ROS 2 messages.

import simkit

with simkit.load("turtlebot3_world", seed=0) as sim:
    scans = sim.subscribe("/scan")
    sim.publish("/cmd_vel", {"linear": {"x": 0.2}})
    sim.run(2.0)
    print(scans.latest.ranges.min())
"""

from __future__ import annotations

import importlib
import os

from simkit.early_interrupts import install_in_command

install_in_command()  # before the other imports of this file

from simkit import moved_modules  # noqa: E402
from simkit.garbage_collection import no_collection  # noqa: E402
from simkit.version import __version__  # noqa: E402

TYPE_CHECKING = False  # `typing` takes 3 ms
if TYPE_CHECKING:
    from simkit import (  # noqa: F401
        elementary_functions,
        errors,
        extend,
        float_sum,
        gym,
        linear_algebra,
        live,
        matrix_decompositions,
        msgs,
        pose,
        progress,
        recording,
        testing,
    )
    from simkit.build import check, describe, load
    from simkit.deferred_response import DeferredResponse
    from simkit.diagnostics import Diagnostic
    from simkit.errors import (
        InputError,
        LoadError,
        MessageError,
        PluginError,
        RenderError,
        SimkitError,
        SimulationDiverged,
    )
    from simkit.facade import compare, fit, launch, sweep
    from simkit.params import Params
    from simkit.plugins.base import ModelPlugin, Plugin, SensorPlugin, VisualPlugin, WorldPlugin
    from simkit.pose import Pose
    from simkit.recording.export.data_frames import to_dataframe
    from simkit.run_spec import Check, RunSpec
    from simkit.runtime import Joint, Light, Link, Model, Publisher, Simulation, Subscription, Visual
    from simkit.runtime.world_variation import apply_overrides
    from simkit.sensors.cameras.overview_image import render_view


__all__ = [
    "Check",
    "DeferredResponse",
    "Diagnostic",
    "InputError",
    "Joint",
    "Light",
    "Link",
    "LoadError",
    "MessageError",
    "Model",
    "ModelPlugin",
    "Params",
    "Plugin",
    "PluginError",
    "Pose",
    "Publisher",
    "RenderError",
    "RunSpec",
    "SensorPlugin",
    "SimkitError",
    "Simulation",
    "SimulationDiverged",
    "Subscription",
    "Visual",
    "VisualPlugin",
    "WorldPlugin",
    "__version__",
    "apply_overrides",
    "check",
    "compare",
    "describe",
    "fit",
    "launch",
    "load",
    "render_view",
    "sweep",
    "to_dataframe",
]

# Lazy imports: MuJoCo takes most of the import time and NumPy most of the rest. Test runs that open no world do not pay
# for either (`simkit.pytest_plugin`).
_MODULES = {
    "simkit.build": ("load", "describe", "check"),
    "simkit.runtime": ("Joint", "Light", "Link", "Model", "Publisher", "Simulation", "Subscription", "Visual"),
    "simkit.diagnostics": ("Diagnostic",),
    "simkit.errors": (
        "InputError",
        "LoadError",
        "MessageError",
        "PluginError",
        "RenderError",
        "SimkitError",
        "SimulationDiverged",
    ),
    "simkit.params": ("Params",),
    "simkit.pose": ("Pose",),
    "simkit.recording.export.data_frames": ("to_dataframe",),
    "simkit.run_spec": ("Check", "RunSpec"),
    "simkit.facade": ("compare", "fit", "launch", "sweep"),
    "simkit.plugins.base": ("Plugin", "WorldPlugin", "ModelPlugin", "SensorPlugin", "VisualPlugin"),
    "simkit.deferred_response": ("DeferredResponse",),
    "simkit.runtime.world_variation": ("apply_overrides",),
    "simkit.sensors.cameras.overview_image": ("render_view",),
}
_LAZY = {name: module for module, names in _MODULES.items() for name in names}
_PUBLIC_MODULES = (
    "elementary_functions",
    "errors",
    "extend",
    "float_sum",
    "gym",
    "linear_algebra",
    "live",
    "matrix_decompositions",
    "msgs",
    "pose",
    "progress",
    "recording",
    "testing",
)

moved_modules.install()

# `simkit.errors` checks for this name: another project with the same import name may have replaced this file.
_DISTRIBUTION = "simkit-robotics"


if not TYPE_CHECKING:  # hidden from type checkers, so that they report unknown names

    def __getattr__(name: str) -> object:
        if name in _PUBLIC_MODULES:
            return importlib.import_module(f"simkit.{name}")
        if name not in _LAZY:
            raise AttributeError(f"module 'simkit' has no attribute {name!r}{_conflict_text()}")

        try:
            with no_collection():
                value = getattr(importlib.import_module(_LAZY[name]), name)
        except ImportError as error:
            if text := _conflict_text():
                error.add_note(text.strip())
            raise
        globals()[name] = value
        return value


def _conflict_text() -> str:
    """Return a text about another project's files in this folder; empty without such files."""
    if not os.path.exists(os.path.join(os.path.dirname(__file__), "area_normals.py")):  # noqa: PTH110, PTH118, PTH120
        return ""
    text: str = importlib.import_module("simkit.name_conflict").find_conflict()
    return f"\n{text}" if text else ""


def __dir__() -> list[str]:
    return sorted({*__all__, *_PUBLIC_MODULES})
