"""Convex decomposition of a mesh with CoACD (the extra `decompose`). Same mesh and settings, same pieces."""

from __future__ import annotations

import importlib.util
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Final

import numpy as np

from simkit.compiler.meshes.mesh_part import Floats, Ints

THRESHOLD: Final = 0.05
"""CoACD's concavity at which a piece counts as convex, relative to the mesh's size."""

MOST_HULLS: Final = 256
_SEED: Final = 0
_PATIENCE: Final = 600.0
_SCRIPT: Final = Path(__file__).with_name("run_coacd.py")


class DecompositionError(Exception):
    """No decomposition; the text says why, `hint` what helps."""

    def __init__(self, text: str, hint: str = "") -> None:
        super().__init__(text)
        self.hint = hint


def is_available() -> bool:
    return importlib.util.find_spec("coacd") is not None


def decompose(vertices: Floats, faces: Ints, most: int) -> list[Floats]:
    """Point sets whose hulls together make up the mesh, at most `most` of them. Raises DecompositionError."""
    if not is_available():
        raise DecompositionError(
            "convex decomposition needs CoACD, which is not installed", "pip install 'simkit-robotics[decompose]'"
        )
    with tempfile.TemporaryDirectory(prefix="simkit-") as folder:
        source, target = Path(folder) / "in.npz", Path(folder) / "out.npz"
        settings = {"threshold": THRESHOLD, "most": min(max(1, most), MOST_HULLS), "seed": _SEED}
        np.savez(source, vertices=vertices.astype(float), faces=faces.astype(np.int32), **settings)  # type: ignore[arg-type]
        _run(source, target)
        try:
            with np.load(target, allow_pickle=False) as made:
                return [np.asarray(made[f"p{i}"], float) for i in range(len(made.files))]
        except (OSError, ValueError, KeyError):
            raise DecompositionError("CoACD gave no result") from None


def _run(source: Path, target: Path) -> None:
    environment = {**os.environ, "OMP_NUM_THREADS": "1", "OMP_DYNAMIC": "false"}
    try:
        done = subprocess.run(
            [sys.executable, "-P", str(_SCRIPT), str(source), str(target)],
            env=environment,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=_PATIENCE,
            check=False,
        )
    except subprocess.TimeoutExpired:
        raise DecompositionError(f"CoACD did not end within {_PATIENCE:g} s") from None
    except OSError as problem:
        raise DecompositionError(f"CoACD could not be started: {problem.strerror}") from None
    if done.returncode:
        said = done.stderr.decode("utf-8", "replace").strip().splitlines()
        raise DecompositionError(f"CoACD failed ({said[-1][:200] if said else f'exit code {done.returncode}'})")
