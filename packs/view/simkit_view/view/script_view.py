"""Live view of a simulation that a script steps."""

from __future__ import annotations

import json
import secrets
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Final

from simkit_view.view.live_view import LiveView

if TYPE_CHECKING:
    from simkit import Simulation

_LONG, _SHORT = 0.02, 0.008  # [s] of wall time above which slices are halved, and below which they are doubled
_PAUSE_POLL: Final = 0.02  # [s] of wall time between two looks at a pause that a page has requested


# Behind a proxy the browser cannot reach this machine. A Jupyter server with jupyter-server-proxy passes the page on at
# `proxy/PORT/` below its own address, so the script first asks there for a small file of the page.
_FRAME: Final = """<iframe id="{name}" width="100%" height="640" style="border:0" title="simkit"></iframe><script>
(async () => {{
  const page = {address}, config = document.getElementById('jupyter-config-data');
  const base = config ? JSON.parse(config.textContent).baseUrl : document.body.dataset.baseUrl;
  const passed = base && new URL(`${{base}}proxy/${{new URL(page).port}}/`, location.href);
  const answer = passed && await fetch(new URL('icon.svg', passed)).catch(() => null);
  document.getElementById('{name}').src = answer?.ok ? new URL(new URL(page).search, passed) : page;
}})();
</script>"""


class PageAddress(str):
    """Address of a page; a notebook shows the page, also behind jupyter-server-proxy."""

    __slots__ = ()

    def _repr_html_(self) -> str:
        return _FRAME.format(name=f"simkit-{secrets.token_hex(4)}", address=json.dumps(str(self)))


class ScriptView:
    """Live view that is updated while a script steps the simulation.

    A pause of the script itself does not stop its steps, as without a view. A pause that a page requests does: `step`
    and `run` then wait until a page resumes.

    Args:
        sim: simulation to show.
        port: port; 0 for a free one.
    """

    def __init__(self, sim: Simulation, port: int = 0) -> None:
        self._sim, self._view = sim, LiveView(sim, port=port)
        self._slice = 1

    @property
    def address(self) -> str:
        """Address of the page."""
        return PageAddress(self._view.address)

    def advance(self, target: int, advance: Callable[[int], None]) -> None:
        """Call `advance` up to the tick `target`, in slices of about 10 ms, and update the page in between."""
        sim, view = self._sim, self._view
        end = sim.engine.steps + target - sim.tick
        view.update()
        while (left := end - sim.engine.steps) > 0:
            if view.is_held and sim.paused:
                time.sleep(_PAUSE_POLL)
                view.update()
                continue
            stop = sim.tick + min(self._slice, left)
            until = sim.control.pausing.until
            if view.is_held and until is not None:
                stop = max(min(stop, until), sim.tick + 1)
            due = view.driving.next_tick
            if due is not None:
                stop = min(stop, max(due, sim.tick + 1))
            begun = time.perf_counter()
            advance(stop)
            elapsed = time.perf_counter() - begun
            if elapsed > _LONG:
                self._slice = max(1, self._slice // 2)
            elif elapsed < _SHORT:
                self._slice = min(2 * self._slice, 1 << 20)
            view.update()
            view.driving.send_due()

    def close(self) -> None:
        """Close the page."""
        self._view.close()
