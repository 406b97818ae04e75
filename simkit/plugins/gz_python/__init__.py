"""Gazebo's Python modules on top of simkit: systems and scripts import `gz.sim`, `gz.math`, `sdformat`, … from here.

The input is an import of one of Gazebo's modules, in any version and spelling. The result is the module of simkit with
the same names. A real installation of Gazebo has priority unless `shadow` is set. A world's `PythonSystemLoader` needs
no further setup. A script begins with:

    import simkit.plugins.gz_python

    simkit.plugins.gz_python.install()
    from gz.sim8 import TestFixture
"""

from __future__ import annotations

from simkit.plugins.gz_python import import_hook
from simkit.plugins.gz_python.import_hook import importable, installed

__all__ = ["importable", "install", "installed", "uninstall"]

_is_installed = False


def install(shadow: bool = False) -> dict[str, str]:
    """Make `gz.…`, `ignition.…` and `sdformat…` importable from simkit for the rest of the program.

    Args:
        shadow: import simkit's modules even if real ones are installed.

    Returns:
        Location of each really installed module by name; these modules have priority unless shadowed.
    """
    global _is_installed
    found = installed()
    if not _is_installed or shadow:
        import_hook.enter(shadow)
    _is_installed = True
    return found


def uninstall() -> None:
    """Remove the names again; modules that were imported keep working."""
    global _is_installed
    if _is_installed:
        import_hook.leave()
    _is_installed = False
