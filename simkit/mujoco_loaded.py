"""Whoever imports this has the engine, whatever `MUJOCO_GL` says."""

from simkit.mujoco_import import import_mujoco

import_mujoco()
