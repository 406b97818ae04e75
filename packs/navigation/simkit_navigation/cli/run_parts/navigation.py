"""Run part `--nav` and `--slam`: navigate with the servers of Nav2, and make a map, without a launch file."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, ClassVar

from simkit.cli.run_part import fill_in_value
from simkit.errors import InputError
from simkit.extend import RunPart, option
from simkit.run_files import model_and_file

if TYPE_CHECKING:
    from simkit import RunSpec

_NAV_HELP = "Navigate with Nav2's servers on a map, or on the true map; goals: /navigate_to_pose, /goal_pose."
_SLAM_HELP = "Make the map with slam_toolbox while the robot moves."
_TRUE_MAP = "true"


@dataclass
class Navigation(RunPart):
    """Navigation and mapping of a run."""

    place: ClassVar[int] = 60

    nav: Annotated[str | None, option(_NAV_HELP, "[MAP.yaml]", "--nav")] = None
    slam: Annotated[bool, option(_SLAM_HELP, None, "--slam")] = False

    @classmethod
    def complete_words(cls, words: list[str]) -> list[str]:
        """Give `--nav` without a file the value of the true map."""
        return fill_in_value(words, "--nav", _TRUE_MAP, lambda word: word.endswith((".yaml", ".yml")))

    def extended(self, spec: RunSpec) -> RunSpec:
        """Return the run with the nodes that navigate or make a map.

        Raises:
            InputError: SK-CLI-060 the map is not there, or both a map and `--slam` are given.
        """
        if self.nav is None and not self.slam:
            return spec
        from simkit_navigation.navigation_nodes import MAP_MODEL, navigation_nodes

        has_file = self.nav not in (None, _TRUE_MAP)
        if has_file and self.slam:
            raise InputError(
                "SK-NAV-020", f"found --nav {self.nav} and --slam", help="--slam makes the map: use --nav alone"
            )
        if has_file and not Path(str(self.nav)).is_file():
            problem = f"there is no map {self.nav}"
            raise InputError("SK-NAV-020", problem, help="simkit map WORLD -o NAME writes the true map of a world")
        files = [file for model, file in map(model_and_file, spec.options.get("params_files", ())) if not model]
        nodes = navigation_nodes(
            self.nav if has_file else None,
            navigates=self.nav is not None,
            makes_map=self.slam,
            params_files=files,
        )
        spec = replace(spec, nodes=(*spec.nodes, *nodes))
        if self.nav == _TRUE_MAP and not self.slam:
            spec = replace(spec, spawn=(*spec.spawn, {"model": MAP_MODEL}))
        return spec
