"""Replacement of Gazebo's Python modules `gz.sim`, `gz.math`, `sdformat`, … for systems and scripts that run in simkit.

An import of a Gazebo module, in any version and spelling, returns simkit's module with the same classes and functions.
If Gazebo itself is installed, its modules are imported instead, except with `shadow`. Systems that a world loads with
`PythonSystemLoader` need no further setup. A script begins with:

    import simkit_gz_python

    simkit_gz_python.install()
    from gz.sim8 import TestFixture
"""

from __future__ import annotations

from simkit_gz_python import import_hook
from simkit_gz_python.import_hook import importable, installed

__all__ = ["importable", "install", "installed", "uninstall"]

_is_installed = False


def install(shadow: bool = False) -> dict[str, str]:
    """Make `gz.…`, `ignition.…` and `sdformat…` importable until the program ends or calls `uninstall`.

    Args:
        shadow: import simkit's modules even if real ones are installed.

    Returns:
        File of each installed module of the real Gazebo, by module name. Without `shadow`, these modules are imported.
    """
    global _is_installed
    real_modules = installed()
    if not _is_installed or shadow:
        import_hook.enter(shadow)
    _is_installed = True
    return real_modules


def uninstall() -> None:
    """Stop replacing Gazebo's modules; modules that a program has already imported keep working."""
    global _is_installed
    if _is_installed:
        import_hook.leave()
    _is_installed = False
