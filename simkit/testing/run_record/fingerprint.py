"""What the bits of a run depend on beside its world: versions, processor, system, renderer."""

from __future__ import annotations

import hashlib
import platform
from collections.abc import Mapping
from functools import cache
from importlib import import_module
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Final

from simkit.errors import RenderError
from simkit.version import __version__

RENDERER: Final = "renderer"
"""What draws pictures; it counts only where there are some."""
_INFORMATION_ONLY: Final = ("simkit code", "python")
"""What is kept for who looks for a cause, and is not expected to change any bit."""


def fingerprint(*, pictures: bool = False) -> dict[str, str]:
    """Versions, processor and system of this process.

    Args:
        pictures: whether the renderer is asked for, which opens it.

    Returns:
        Name -> value; `renderer` only where it was asked for.
    """
    found = dict(_machine_fingerprint())
    if pictures:
        found[RENDERER] = _renderer()
    return found


def fingerprint_differences(
    a: Mapping[str, str], b: Mapping[str, str], pictures: bool = False
) -> dict[str, tuple[str, str]]:
    """What of two fingerprints that bits depend on is other: name -> both values."""
    names = [n for n in dict.fromkeys((*a, *b)) if n not in _INFORMATION_ONLY and (pictures or n != RENDERER)]
    return {n: (a.get(n, ""), b.get(n, "")) for n in names if a.get(n, "") != b.get(n, "")}


@cache
def _machine_fingerprint() -> dict[str, str]:
    import mujoco
    import numpy

    return {
        "simkit": __version__,
        "simkit code": code_hash(),
        "mujoco": mujoco.__version__,
        "numpy": numpy.__version__,
        "opencv": _version("opencv-python-headless"),
        "trimesh": _version("trimesh"),
        "python": platform.python_version(),
        "processor": platform.machine(),
        "processor features": _cpu_features(),
        "system": platform.system(),
        "libc": " ".join(platform.libc_ver()).strip(),
    }


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return ""


def _cpu_features() -> str:
    """What of the processor's instructions NumPy and the mathematics library choose by: the widest of each family."""

    try:
        features = import_module("numpy._core._multiarray_umath").__cpu_features__
    except (ImportError, AttributeError):  # a NumPy that hides it
        return ""
    told = ("AVX512F", "AVX512_SKX", "AVX512_ICL", "AVX512_SPR", "AVX2", "FMA3", "ASIMD", "SVE", "VSX4", "VX")
    return " ".join(name for name in told if features.get(name))


@cache
def code_hash() -> str:
    """The first letters of a hash over simkit's own Python files."""
    root = Path(__file__).resolve().parents[2]
    digest = hashlib.sha256()
    for path in sorted(root.rglob("*.py")):
        digest.update(path.relative_to(root).as_posix().encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:12]


@cache
def _renderer() -> str:
    from simkit.sensors.cameras.rendering import gl_context

    try:
        with gl_context.current():
            pass
    except RenderError as error:
        return f"none ({error.code})"
    return gl_context.describe_renderer() or "unknown"
