"""Run part `--nav` and `--slam`: navigate with the servers of Nav2, and make a map, without a launch file."""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

from simkit.cli.run_part import fill_in_value
from simkit.extend import RunPart, option
from simkit.run_files import model_and_file

if TYPE_CHECKING:
    from collections.abc import Sequence

    from simkit import RunSpec, Simulation

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
        """Return the run with the true map of the world, if it is needed.

        Raises:
            InputError: SK-NAV-020 the map is not there or not valid, or both a map and `--slam` are given.
        """
        if not self.adds_nodes:
            return spec
        from simkit_navigation.navigation_nodes import MAP_MODEL, check_map

        check_map(self._map, makes_map=self.slam)
        if self.nav != _TRUE_MAP or self.slam:
            return spec
        return replace(spec, spawn=(*spec.spawn, {"model": MAP_MODEL}))

    def added_nodes(self, spec: RunSpec, sim: Simulation) -> Sequence[dict[str, Any]]:
        """Return the nodes that navigate or make a map."""
        if not self.adds_nodes:
            return ()
        from simkit_navigation.navigation_nodes import (
            navigation_nodes,
            report_missing_topics,
            report_other_namespaces,
            topics_of_robot,
        )

        report_missing_topics(sim, sim.engine.reports, navigates=self.nav is not None)
        given = spec.options.get("params_files", ())
        given = [given] if isinstance(given, (str, os.PathLike)) else given
        files = [file for model, file in map(model_and_file, given) if not model]
        report_other_namespaces(files, sim.engine.reports)
        return navigation_nodes(
            self._map,
            navigates=self.nav is not None,
            makes_map=self.slam,
            params_files=files,
            remap=topics_of_robot(sim),
        )

    @property
    def adds_nodes(self) -> bool:
        return self.nav is not None or self.slam

    @property
    def _map(self) -> str | None:
        return None if self.nav == _TRUE_MAP else self.nav
