"""Gazebo's Python over simkit: what systems and scripts written for `gz.sim`, `gz.math`, `sdformat`, … import.

What enters: an import of one of Gazebo's modules, in any version and spelling. What leaves: the module of simkit with
the same names. It never goes before a real installation of Gazebo unless it is told to shadow it. A world's
`PythonSystemLoader` needs nothing else. A script says first:

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
    """Lets `gz.…`, `ignition.…` and `sdformat…` be imported from simkit for the rest of the program.

    Args:
        shadow: also where the real ones are installed.

    Returns:
        What is really installed, which goes first unless shadowed: name -> where it lies.
    """
    global _is_installed
    found = installed()
    if not _is_installed or shadow:
        import_hook.enter(shadow)
    _is_installed = True
    return found


def uninstall() -> None:
    """Takes the names away again; what was imported stays with whoever has it."""
    global _is_installed
    if _is_installed:
        import_hook.leave()
    _is_installed = False
