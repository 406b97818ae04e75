"""The first import of the engine, which must not depend on a renderer."""

from __future__ import annotations

import os


def import_engine() -> None:
    """Imports MuJoCo; where that fails for what `MUJOCO_GL` says, once more without a renderer.

    MuJoCo opens the renderer's library when it is imported: a value that it does not know, or a library that is not
    there, would end a run that draws nothing. Whoever does draw gets the reason from `simkit.sensors.rendering.gl`.
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
            import mujoco  # noqa: F401
        finally:
            os.environ["MUJOCO_GL"] = wanted
