"""Run part `--view`: show the run in a viewer window."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Annotated, ClassVar

from simkit import RunSpec
from simkit.cli.run_verdict import RunVerdict
from simkit.extend import OpenRun, RunPart, option


@dataclass
class ViewerWindow(RunPart):
    """Window of MuJoCo's viewer; the run ends when the user closes it."""

    place: ClassVar[int] = 20

    view: Annotated[bool, option("Show the run in a viewer window.", None, "--view")] = False

    @property
    def is_watched(self) -> bool:
        """True with the window."""
        return self.view

    @contextmanager
    def around_run(self, spec: RunSpec, verdict: RunVerdict) -> Iterator[None]:
        """Check whether a window can open."""
        if self.view:
            from simkit_view.viewer import check_possible

            check_possible()
        yield

    @contextmanager
    def around_loop(self, run: OpenRun) -> Iterator[None]:
        """Open the window, and close it after the loop."""
        if not self.view:
            yield
            return
        from simkit_view.viewer import Viewer

        with Viewer(run.sim) as viewer:
            run.loop.watchers.append(viewer.update)
            run.loop.early_ends.append(lambda: "" if viewer.is_open() else "the viewer's")
            yield
