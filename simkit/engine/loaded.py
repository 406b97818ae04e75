"""Whoever imports this has the engine, whatever `MUJOCO_GL` says."""

from simkit.engine import import_engine

import_engine()
