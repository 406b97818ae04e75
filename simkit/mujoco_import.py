"""The first import of the engine, which must not depend on a renderer."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import mujoco as mujoco


def import_mujoco() -> None:
    """Imports MuJoCo; where that fails for what `MUJOCO_GL` says, once more without a renderer.

    MuJoCo opens the renderer's library when it is imported: a value that it does not know, or a library that is not
    there, would end a run that draws nothing. Whoever does draw gets the reason from
    `simkit.sensors.cameras.rendering.gl_context`.

    Its warnings then go neither to the terminal nor to a log file in the working folder, unless somebody else hears
    them already: those of a simulation are among its diagnostics.
    """
    try:
        import mujoco
    except Exception:
        # drivers fail in their own ways: RuntimeError, ImportError, AttributeError
        wanted = os.environ.get("MUJOCO_GL")
        if not wanted:
            raise
        os.environ["MUJOCO_GL"] = "disable"
        try:
            import mujoco
        finally:
            os.environ["MUJOCO_GL"] = wanted
    if mujoco.get_mju_user_warning() is None:
        mujoco.set_mju_user_warning(ignore_warning)


def ignore_warning(_text: str) -> None:
    """Drops it."""


def __getattr__(name: str) -> Any:
    """Gives `mujoco` to whoever imports it from here, so that its first import is the one above."""
    if name != "mujoco":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    import_mujoco()
    import mujoco

    return mujoco
