"""Models in a real browser: spawned by a click on the ground, dragged by the gizmo, deleted."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from packs.view.tests.view.test_browser import Session, browser, session  # noqa: F401 - fixtures

pytestmark = pytest.mark.browser


def test_a_model_is_placed_dragged_turned_and_deleted(session: Callable[..., Session]) -> None:  # noqa: F811
    found = session()
    page, sim = found.page, found.sim
    found.until("app.stage.draws > 1 && document.querySelectorAll('#spawn-model option').length > 3")
    box = page.locator("#canvas").bounding_box()
    place = box["x"] + 0.3 * box["width"], box["y"] + 0.75 * box["height"]
    x, y = found.get(f"(() => {{ const p = app.pickAt({place[0]}, {place[1]}).point; return [p.x, p.y]; }})()")
    page.locator("#spawn-model").select_option("turtlebot3_burger")
    page.locator("#spawn").click()
    page.mouse.click(*place)
    found.until("app.selected?.startsWith('turtlebot3_burger::')")
    burger = sim.model("turtlebot3_burger")
    assert found.do(lambda: burger.pose.position[:2]) == pytest.approx((x, y), abs=0.05)
    found.until("app.models.has('turtlebot3_burger')")

    page.locator("#move-model").click()
    found.until("app.modelEditor.edited === 'turtlebot3_burger' && app.modelEditor.gizmo.object")
    found.get("app.stage.draw()")
    arrow = """(() => { const app = window.simkitView, { gizmo, proxy } = app.modelEditor, p = proxy.position.clone();
      const scale = app.stage.camera.position.distanceTo(p) * Math.tan(Math.PI / 8) / 7 * gizmo.size * 4;
      p.x += DISTANCE * scale; p.project(app.stage.camera);
      const b = app.stage.canvas.getBoundingClientRect();
      return [b.left + (p.x + 1) / 2 * b.width, b.top + (1 - p.y) / 2 * b.height]; })()"""
    begin, end = (page.evaluate(arrow.replace("DISTANCE", str(distance))) for distance in (0.4, 1.4))
    page.mouse.move(*begin)
    found.until("app.modelEditor.gizmo.axis === 'X'")
    page.mouse.down()
    page.mouse.move(*end, steps=6)
    page.mouse.up()
    found.until_here(lambda: burger.pose.position[0] > x + 0.1)
    assert found.do(lambda: burger.pose.position[1]) == pytest.approx(y, abs=0.05)
    found.picture("gizmo")

    page.locator("#turn-model").click()
    found.until("app.modelEditor.gizmo.mode === 'rotate' && app.modelEditor.edited")
    page.locator("#delete-model").click()
    found.until("!app.models.has('turtlebot3_burger') && app.selected === null")
    assert "turtlebot3_burger" not in sim.models
    assert found.errors == []


def test_a_model_that_is_spawned_while_the_page_loads_a_scene_appears(
    session: Callable[..., Session],  # noqa: F811
) -> None:
    found = session()
    found.until("app.state?.tick > 0")
    found.page.locator("#play").click()
    found.until("app.state.paused")

    def answer_late(route: Any) -> None:
        response, before = route.fetch(), found.view.revision
        if "second" not in found.sim.models:  # after the first scene has been sent, and before the page has it
            found.do(lambda: found.sim.spawn(BALL, "second"))
            while found.view.revision == before:
                pass
        route.fulfill(response=response)

    found.page.route("**/scene?*", answer_late)
    found.do(lambda: found.sim.spawn(BALL, "first"))
    found.until("app.models.has('first') && app.models.has('second')")


BALL = """<sdf version="1.9"><model name="ball"><pose>4 4 1 0 0 0</pose><link name="l"><visual name="v"><geometry>
<sphere><radius>0.1</radius></sphere></geometry></visual></link></model></sdf>"""
