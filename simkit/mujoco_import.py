"""First import of MuJoCo, which must not depend on a renderer."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import mujoco as mujoco


def import_mujoco() -> None:
    """Import MuJoCo; retry without a renderer if the import fails because of `MUJOCO_GL`.

    MuJoCo opens the library of the renderer when it is imported. An unknown value or a missing library would end a run
    that draws nothing. A run that draws gets the reason from `simkit.sensors.cameras.rendering.gl_context`.

    The engine's warnings are then written neither to the terminal nor to a log file in the working directory, unless
    another warning callback is already installed. The warnings of a simulation are among its diagnostics.
    """
    try:
        import mujoco
    except Exception:
        # the exception depends on the driver: RuntimeError, ImportError, AttributeError
        renderer = os.environ.get("MUJOCO_GL")
        if not renderer:
            raise
        os.environ["MUJOCO_GL"] = "disable"
        try:
            import mujoco
        finally:
            os.environ["MUJOCO_GL"] = renderer
    if mujoco.get_mju_user_warning() is None:
        mujoco.set_mju_user_warning(ignore_warning)


def ignore_warning(_text: str) -> None:
    """Ignore a warning of the engine."""


def __getattr__(name: str) -> Any:
    """Return `mujoco`, so that `from simkit.mujoco_import import mujoco` uses the import above."""
    if name != "mujoco":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    import_mujoco()
    import mujoco

    return mujoco
