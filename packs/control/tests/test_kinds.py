"""Controllers are found by the names in their files, also those in other packs."""

from __future__ import annotations

from simkit.registry import Kinds
from simkit_control.plugins.ros2_control.controller_manager import controller_kinds


def test_every_controller_is_found_by_the_names_in_its_file() -> None:
    full = controller_kinds()
    assert isinstance(full, Kinds)
    fresh = Kinds(full._package, full._group, full._base, full._names, full._attributes, full._spell)
    assert {name: fresh[name] for name in full} == dict(full)
    assert set(fresh.written) == set(full)


def test_controllers_come_from_several_packs() -> None:
    assert {cls.__module__.split(".")[0] for cls in controller_kinds().values()} == {"simkit_control", "simkit_robots"}
