"""Users' names of packs and of folders above the runtime: the only module of the core that names packs.

Each name has its type for editors and mypy. Its module is imported on first use. Without its pack, the error says which
pack is missing.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any, Final

from simkit.errors import InputError
from simkit.install_command import install_command

if TYPE_CHECKING:
    from simkit_identification.comparison.compare import compare as compare
    from simkit_identification.fitting.fit import fit as fit
    from simkit_launch.launch import launch as launch
    from simkit_learning.gym import Batched as Batched
    from simkit_learning.gym import EnvironmentSpec as EnvironmentSpec
    from simkit_learning.gym import JointVelocities as JointVelocities
    from simkit_learning.gym import Observation as Observation
    from simkit_learning.gym import SimulationEnv as SimulationEnv
    from simkit_learning.gym import make as make
    from simkit_learning.gym import make_vec as make_vec
    from simkit_learning.sweeps.sweep import sweep as sweep
    from simkit_nodes.programs import NodeProgram as NodeProgram

MODULES: Final[dict[str, str]] = {
    "sim.add_node": "simkit_nodes.lock_step",
    "sim.run_until": "simkit.testing.conditions.opened_condition",
    "sim.set_ros_parameters": "simkit_nodes.lock_step",
    "sim.view": "simkit_view.view.script_view",
    "simkit.compare": "simkit_identification.comparison.compare",
    "simkit.fit": "simkit_identification.fitting.fit",
    "simkit.gym": "simkit_learning.gym",
    "simkit.launch": "simkit_launch.launch",
    "simkit.sweep": "simkit_learning.sweeps.sweep",
}
"""Module of a pack, or of a folder above the runtime, by the user's name that needs it."""


def pack_module(name: str) -> Any:
    """Import and return the module of a pack that a user's name needs, such as `simkit.sweep`.

    Raises:
        InputError: SK-INPUT-004 the pack is not installed.
    """
    module = MODULES[name]
    package = module.partition(".")[0]
    try:
        return import_module(module)
    except ModuleNotFoundError as error:
        if error.name != package:
            raise
        text = f"{name} needs the pack {package.removeprefix('simkit_')}, which is not installed"
        help_ = f"install simkit with its packs: {install_command()}"
        raise InputError("SK-INPUT-004", text, help=help_) from None


def __getattr__(name: str) -> Any:
    if f"simkit.{name}" not in MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module = pack_module(f"simkit.{name}")
    return getattr(module, name, module)
