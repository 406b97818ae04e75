"""Names of all interfaces that programs can use."""

from __future__ import annotations

from collections.abc import Iterable

from simkit.msgs.interface_definitions import interface_names
from simkit_nodes.host import current_program
from simkit_nodes.interfaces.workspaces import names_in, package_is_known

__all__ = [
    "get_action_interfaces",
    "get_interface_packages",
    "get_interfaces",
    "get_message_interfaces",
    "get_service_interfaces",
]

_KINDS = ("msg", "srv", "action")


def get_interfaces(package_names: Iterable[str] = ()) -> dict[str, list[str]]:
    """Return the names `KIND/NAME` of the interfaces of packages, by package; of all packages by default.

    Raises:
        LookupError: a package is unknown.
    """
    return _names(package_names, _KINDS)


def get_message_interfaces(package_names: Iterable[str] = ()) -> dict[str, list[str]]:
    """Return the names `msg/NAME` of the messages of packages, by package; see `get_interfaces`."""
    return _names(package_names, ("msg",))


def get_service_interfaces(package_names: Iterable[str] = ()) -> dict[str, list[str]]:
    """Return the names `srv/NAME` of the services of packages, by package; see `get_interfaces`."""
    return _names(package_names, ("srv",))


def get_action_interfaces(package_names: Iterable[str] = ()) -> dict[str, list[str]]:
    """Return the names `action/NAME` of the actions of packages, by package; see `get_interfaces`."""
    return _names(package_names, ("action",))


def get_interface_packages() -> dict[str, str]:
    """Return the folder of each package with interfaces, by name; an empty text for those that simkit brings."""
    folders = current_program().workspace.packages()
    return {name: str(folders.get(name, "")) for name in _packages()}


def _packages() -> list[str]:
    current_program().workspace.add_interfaces()
    shipped = {name.partition("/")[0] for kind in _KINDS for name in interface_names(kind)}
    return sorted({*shipped, *filter(package_is_known, current_program().workspace.packages())})


def _names(packages: Iterable[str], kinds: tuple[str, ...]) -> dict[str, list[str]]:
    known = _packages()
    wanted = list(packages)
    for package in wanted:
        if package not in known:
            raise LookupError(f"Unknown package '{package}'")
    names = {package: [name.partition("/")[2] for name in names_in(package, kinds)] for package in wanted or known}
    return {package: listed for package, listed in names.items() if listed}
