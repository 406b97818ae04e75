"""Interactive markers in a real browser: dragged by their gizmo, and used by their menu."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from packs.view.tests.view.test_browser import TIMEOUT, Session, browser, session  # noqa: F401 - fixtures
from packs.view.tests.view.test_interactive_markers import SERVER, TOPIC

pytestmark = pytest.mark.browser
POINT = """(() => { const app = window.simkitView, p = app.markerHandles.proxy.position.clone();
  const scale = app.stage.camera.position.distanceTo(p) * Math.tan(Math.PI / 8) / 7 * app.markerHandles.gizmo.size * 4;
  p.x += DISTANCE * scale; p.project(app.stage.camera);
  const b = app.stage.canvas.getBoundingClientRect();
  return [b.left + (p.x + 1) / 2 * b.width, b.top + (1 - p.y) / 2 * b.height]; })()"""


def test_a_marker_is_dragged_and_its_menu_is_used(
    session: Callable[..., Session],  # noqa: F811
    tmp_path: Path,
) -> None:
    file = tmp_path / "server.py"
    file.write_text(SERVER)
    found = session()
    page = found.page
    node = found.do(lambda: found.sim.add_node(file))
    page.locator(f"[id='display-{TOPIC}']").check(timeout=TIMEOUT)
    page.locator("[data-marker='translate goal']").click(timeout=TIMEOUT)
    found.until("app.markerHandles.gizmo.object && app.stage.draws > 2")
    found.get("app.stage.draw()")
    begin, end = (page.evaluate(POINT.replace("DISTANCE", str(distance))) for distance in (0.4, 1.2))
    page.mouse.move(*begin)
    found.until("app.markerHandles.gizmo.axis === 'X'")
    page.mouse.down()
    page.mouse.move(*end, steps=6)
    page.mouse.up()
    found.until(f"app.displays.handles('{TOPIC}')[0]?.pose[0] > 1.2")  # the program has published the new pose
    assert found.get(f"app.displays.handles('{TOPIC}')[0].pose[1]") == pytest.approx(0.0, abs=1e-6)
    found.picture("interactive_marker")
    page.locator("[data-marker='menu goal']").select_option(label="go › fast")
    found.until_here(lambda: any("chosen fast of choice" in line for line in node.log))
    assert found.errors == []
