"""Panels, bar and tour of the page in a real browser: what they show, on a desk and on a phone."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from itertools import pairwise
from typing import Any

import pytest

from packs.view.tests.view.conftest import YARD
from packs.view.tests.view.test_browser import TIMEOUT, Session, browser  # noqa: F401 - a fixture
from packs.view.tests.view.test_panels import MOVING

pytestmark = pytest.mark.browser
PHONE = (390, 844)
TABS = ("plots", "console", "calls", "motions", "parameters", "graph", "frames")
LIFT = """<sdf version='1.9'><model name='lift'><link name='foot'><inertial><mass>5</mass></inertial></link>
<link name='arm'><inertial><mass>1</mass></inertial></link><joint name='rise' type='prismatic'><parent>foot</parent>
<child>arm</child><axis><xyz>0 0 1</xyz><limit><lower>0</lower><upper>1</upper></limit></axis></joint></model></sdf>"""
HEADINGS = "[...document.querySelectorAll('#joints h4')].map(e => e.textContent)"
GROUND = """(() => { const b = app.stage.canvas.getBoundingClientRect();
  return [b.x + 0.3 * b.width, b.y + 0.8 * b.height]; })()"""


@pytest.fixture
def session(browser: Any) -> Iterator[Callable[..., Session]]:  # noqa: F811 - the fixture
    with ExitStack() as stack:
        yield lambda world=YARD, **more: Session(browser, stack, world, **more)


# ---------------------------------------------------------------------- driving


def test_the_speed_shown_is_zero_after_the_timeout_of_the_keys(session: Callable[..., Session]) -> None:
    found = session()
    speeds = found.page.locator("#speeds")
    found.until("document.getElementById('drive').hidden === false")
    found.page.locator("#canvas").press("w")
    found.until("!document.getElementById('speeds').textContent.startsWith('0.00')")
    found.until_here(lambda: found.sim.time > 10.5)
    speeds.filter(has_text="0.00 m/s").filter(has_text="stopped: no key for 10 s").wait_for(timeout=TIMEOUT)
    found.page.locator("#canvas").press("w")
    found.until("!document.getElementById('speeds').textContent.startsWith('0.00')")
    found.page.locator("#stop").click()
    found.until("document.getElementById('speeds').textContent === '0.00 m/s  0.00 m/s left  0.00 rad/s'")


def test_the_command_of_another_program_is_shown_with_its_age(session: Callable[..., Session]) -> None:
    found = session()
    speeds = found.page.locator("#speeds")
    speeds.filter(has_text="0.00 m/s").wait_for(timeout=TIMEOUT)
    found.do(lambda: found.sim.publish("/cmd_vel", {"linear": {"x": 0.02}}))
    speeds.filter(has_text="0.02 m/s").filter(has_text="sent 2 s ago").wait_for(timeout=TIMEOUT)
    found.do(lambda: found.sim.publish("/cmd_vel", {}))
    found.until("document.getElementById('speeds').textContent === '0.00 m/s  0.00 m/s left  0.00 rad/s'")


def test_a_drive_that_drops_a_command_after_its_timeout_is_shown_as_stopped(session: Callable[..., Session]) -> None:
    found = session("turtlebot2_empty")
    speeds = found.page.locator("#speeds")
    speeds.filter(has_text="0.00 m/s").wait_for(timeout=TIMEOUT)
    found.do(lambda: found.sim.publish("/mobile_base/commands/velocity", {"linear": {"x": 0.02}}))
    found.until("document.getElementById('speeds').textContent.includes('stopped: no command for 0.6 s')")
    assert speeds.inner_text().startswith("0.00 m/s")


def test_a_goal_without_a_navigator_says_what_is_missing(session: Callable[..., Session]) -> None:
    found = session()
    found.until("app.stage.draws > 1 && document.getElementById('drive').hidden === false")
    answer = found.page.locator("#pose-answer")
    found.page.locator("#go").click()
    assert "click on the ground" in answer.inner_text()
    found.page.keyboard.press("Escape")
    assert answer.inner_text() == "" and not found.get("app.aiming")
    found.page.locator("#go").click()
    found.page.mouse.click(*found.get(GROUND))
    answer.filter(has_text="no navigator subscribes to /goal_pose").filter(has_text="--nav").wait_for(timeout=TIMEOUT)
    assert "no navigator" in found.page.locator("#notice").inner_text()
    goals = found.do(lambda: found.sim.subscribe("/goal_pose"))
    found.page.locator("#go").click()
    found.page.mouse.click(*found.get(GROUND))
    answer.filter(has_text="published on /goal_pose").wait_for(timeout=TIMEOUT)
    assert found.do(lambda: goals.latest) is not None


def test_a_goal_selects_nothing_and_a_reset_removes_its_arrow(session: Callable[..., Session]) -> None:
    found = session()
    found.until("app.stage.draws > 1 && document.getElementById('drive').hidden === false")
    goals = found.do(lambda: found.sim.subscribe("/goal_pose"))
    arrows = found.get("app.stage.helpers.children.filter(child => child.visible).length")
    found.page.locator("#go").click()
    found.page.mouse.click(*found.get(GROUND))
    found.page.locator("#pose-answer", has_text="published on /goal_pose").wait_for(timeout=TIMEOUT)
    assert found.do(lambda: goals.latest) is not None
    assert found.get("app.selected") is None
    assert found.get("app.stage.helpers.children.filter(child => child.visible).length") == arrows + 1
    found.page.locator("#reset").click()
    found.until("document.getElementById('pose-answer').textContent === ''")
    assert found.get("app.stage.helpers.children.filter(child => child.visible).length") == arrows


def test_a_reset_ends_what_the_keys_began(session: Callable[..., Session]) -> None:
    found = session()
    found.until("document.getElementById('drive').hidden === false")
    found.page.locator("#canvas").press("w")
    found.until("!document.getElementById('speeds').textContent.startsWith('0.00')")
    found.page.locator("#play").click()
    found.until("app.state.paused")
    found.page.locator("#reset").click()
    found.until("app.state.tick === 0")
    found.until("document.getElementById('speeds').textContent === '0.00 m/s  0.00 m/s left  0.00 rad/s'")
    sent = found.do(lambda: found.sim.subscribe("/cmd_vel"))
    found.page.locator("#play").click()
    found.until("app.state.time > 0.5")
    assert found.do(lambda: sent.latest) is None


def test_keys_drive_after_a_box_is_checked_or_a_speed_is_chosen(session: Callable[..., Session]) -> None:
    found = session()
    found.until("app.stage.draws > 1 && document.getElementById('drive').hidden === false")
    page, speeds = found.page, found.page.locator("#speeds")
    for use in (page.locator("#layers .check input").first.click, lambda: page.locator("#speed").select_option("2 ×")):
        use()
        page.keyboard.press("ArrowUp")
        speeds.filter(has_text="0.05 m/s").wait_for(timeout=TIMEOUT)
        page.keyboard.press("s")
        speeds.filter(has_text="0.00 m/s").wait_for(timeout=TIMEOUT)
    assert found.get("document.getElementById('speed').value") == "2 ×"


def test_the_chosen_robot_stays_chosen_when_a_model_is_spawned(session: Callable[..., Session]) -> None:
    second = YARD[YARD.index('<model name="rover">') : YARD.index("</world>")].replace("rover", "second")
    found = session(YARD.replace("</world>", f"{second.replace('/cmd_vel', '/second/cmd_vel')}</world>"))
    found.until("document.getElementById('target').options.length === 2")
    found.page.locator("#target").select_option("second")
    found.page.evaluate("xml => window.simkitView.ask('spawn', { source: xml, x: 3, y: 3, z: 0.5 })", LIFT)
    found.until("app.models.has('lift')")
    found.page.evaluate("window.simkitView.ask('targets')")  # the answer to the page's own request came before
    found.until("document.getElementById('target').value === 'second'")


# ---------------------------------------------------------------------- bar and choices


@pytest.mark.parametrize("width", [910, 1000, 1100, 1200, 1300])
def test_no_text_of_the_bar_is_cut_on_a_narrow_desk(session: Callable[..., Session], width: int) -> None:
    found = session(YARD.replace('"yard"', '"simple_office_with_people"'), size=(width, 700), paused=True)
    found.until("document.getElementById('frames').textContent.includes('frames/s')")
    cut = "[...document.querySelectorAll('#toolbar *')].filter(e => e.scrollWidth > e.clientWidth + 1 && e.clientWidth)"
    assert found.get(f"{cut}.map(e => e.id)") == []
    assert found.get("document.getElementById('toolbar').scrollWidth") == width


def test_the_first_view_fits_the_window_until_somebody_moves_the_camera(session: Callable[..., Session]) -> None:
    found = session(paused=True, size=PHONE)
    found.until("app.stage.draws > 1")
    found.page.set_viewport_size({"width": 390, "height": 600})
    distance = "app.stage.camera.position.distanceTo(app.stage.controls.target)"
    found.until("Math.abs(app.stage.camera.aspect - 390 / app.stage.canvas.clientHeight) < 0.01")
    fitted = found.get(distance)
    found.get("app.views.first()")
    assert found.get(distance) == pytest.approx(fitted, rel=1e-6)
    found.get("app.stage.camera.position.multiplyScalar(2)")
    moved = found.get(distance)
    found.page.set_viewport_size({"width": 800, "height": 600})
    found.until("app.stage.camera.aspect > 1.2")
    assert found.get(distance) == pytest.approx(moved, rel=1e-3)


def test_the_quality_of_the_drawing_is_kept_over_a_reload_unless_the_address_has_another(
    session: Callable[..., Session],
) -> None:
    found = session()
    found.page.locator("#quality").select_option("fast")
    found.page.reload()
    found.until("app.stage.quality === 'fast' && document.getElementById('quality').value === 'fast'")
    found.page.goto(f"{found.view.address}&quality=full")
    found.until("app.stage.quality === 'full'")


# ---------------------------------------------------------------------- connection


def test_a_long_name_of_a_world_leaves_the_state_of_the_connection_in_the_bar(session: Callable[..., Session]) -> None:
    found = session(YARD.replace('"yard"', f'"{"yard_with_a_long_name_" * 4}"'), size=(1280, 800))
    found.until("app.state && document.getElementById('frames').textContent !== ''")
    box = found.page.locator("#link").bounding_box()
    assert box["x"] + box["width"] <= 1280


def test_a_page_without_connection_says_so_until_it_has_one(session: Callable[..., Session]) -> None:
    found = session(size=PHONE)
    notice = found.page.locator("#notice")
    assert not notice.is_visible()
    found.page.evaluate("(() => { const c = window.simkitView.connection; c.open = () => {}; c.socket.close(); })()")
    found.page.locator("#link.off").wait_for(timeout=TIMEOUT)
    notice.filter(has_text="The simulation has ended or cannot be reached").wait_for(timeout=TIMEOUT)
    box = notice.bounding_box()
    assert box["x"] >= 0
    assert box["x"] + box["width"] <= PHONE[0]
    found.page.evaluate("(() => { const c = window.simkitView.connection; delete c.open; c.open(); })()")
    found.page.locator("#link.on").wait_for(timeout=TIMEOUT)
    notice.wait_for(state="hidden", timeout=TIMEOUT)


# ---------------------------------------------------------------------- joints


def test_joints_are_in_groups_with_the_arm_first_and_the_wheels_last(session: Callable[..., Session]) -> None:
    found = session("tiago_table")
    found.until("document.querySelectorAll('#joints h4').length > 0")
    assert found.get(HEADINGS) == ["arm", "gripper", "head", "torso lift", "wheels"]
    names = found.get("[...document.querySelectorAll('[data-joint]')].map(e => e.dataset.joint)")
    assert names[:7] == [f"tiago::arm_{number}_joint" for number in range(1, 8)]
    found.until("document.querySelector('#joints output').textContent !== ''")
    texts = found.get("[...document.querySelectorAll('#joints output')].map(e => e.textContent)")
    assert all(texts) and not {"-0.0°", "-0.000 m"} & set(texts)


def test_a_reset_while_paused_leaves_positions_and_no_errors(session: Callable[..., Session]) -> None:
    """A spawned model is gone after the reset, so that the scene has fewer joints."""
    found = session()
    found.until("app.state?.tick > 0")
    found.page.evaluate("source => simkitView.send('spawn', {source, x: 1, y: 1})", LIFT)
    found.until("document.querySelector(\"[data-joint='lift::rise']\") !== null")
    found.page.locator("#play").click()
    found.until("app.state.paused")
    found.page.locator("#reset").click()
    found.until("!app.models.has('lift') && app.state.tick === 0")
    found.until("document.querySelector('#joints output').textContent === '0.0°'")
    for tab in TABS:
        found.page.locator(f"#tab-{tab}").click()
        found.page.locator(f"#tab-{tab}.on").wait_for(timeout=TIMEOUT)
    found.until("app.stats.states > 0")
    assert found.errors == []


# ---------------------------------------------------------------------- plots

TEXTS = """(() => { const plot = app.plots.all[0].chart; return plot.axes.map(axis =>
  (axis._values ?? []).filter(text => text !== '')); })()"""


def test_values_of_axes_are_multiples_of_1_2_or_5(session: Callable[..., Session]) -> None:
    found = session(MOVING)
    found.until("app.state?.tick > 0")
    found.page.locator("#tab-plots").click()
    found.until("app.plots.list.topics.length > 2")
    found.get("app.plots.choose('/odom', 'pose.pose.position.x')")
    found.page.evaluate("simkitView.send('drive', {topic: '/cmd_vel', ahead: 0.5, turn: 0.4})")
    found.until("app.plots.all[0].chart?.data[0].length > 60")
    found.page.locator(".plot .pause").click()
    for most in range(1, 25):
        ends = f"{{min: 0, max: {most}}}"
        found.get(f"['x', 'u0'].map(name => app.plots.all[0].chart.setScale(name, {ends}))")
        found.until(f"app.plots.all[0].chart.scales.x.max === {most}")
        for texts in found.get(TEXTS):
            values = [float(text) for text in texts]
            steps = [round(b - a, 9) for a, b in pairwise(values)]
            assert len(values) > 1 and len(set(steps)) == 1, texts
            assert f"{steps[0]:e}"[0] in "125", texts


# ---------------------------------------------------------------------- a phone

SMALL = """[...document.querySelectorAll('button, select, summary, .check, input:not([type=checkbox])')]
  .filter(e => e.checkVisibility() && e.getBoundingClientRect().height > 0 && e.getBoundingClientRect().height < 39.5)
  .map(e => e.id || e.textContent.slice(0, 30) || e.className)"""
INSIDE = """name => { const box = document.querySelector(name).getBoundingClientRect();
  const isInside = box.left >= 0 && box.right <= innerWidth + 0.5 && box.top >= 0 && box.bottom <= innerHeight;
  return box.width > 0 && isInside; }"""


@pytest.mark.parametrize("theme", ["dark", "light"])
def test_a_phone_reaches_everything_with_a_finger(session: Callable[..., Session], theme: str) -> None:
    found = session("tiago_table", size=PHONE, theme=theme)
    found.until("app.stage.draws > 1 && document.getElementById('drive').hidden === false")
    page = found.page
    for name in ("#play", "#step", "#reset", "#time", "#rtf", "#speed", "#viewpoint", "#tour-start", "#pad", "#stop"):
        assert page.evaluate(INSIDE, name), name
    assert "real time" in page.locator("#rtf").inner_text() and " s" in page.locator("#time").inner_text()
    assert (small := page.evaluate(SMALL)) == [], small
    found.picture(f"phone_{theme}")
    for panel in ("tree", "models", "layers", "joints"):
        page.locator(f"#{panel} > summary").click()
        assert (small := page.evaluate(SMALL)) == [], (panel, small)
    page.locator("#tree summary", has_text="table").click()
    page.locator("[data-link='table::link']").click()
    assert "table" in page.locator("#edited").inner_text()
    for tab in ("plots", "console", "calls", "parameters"):
        page.locator(f"#tab-{tab}").click()
        page.wait_for_timeout(300)
        assert (small := page.evaluate(SMALL)) == [], (tab, small)
        if tab == "calls":
            page.locator(".call-names .leaf").first.click()
            page.locator("#call-send").wait_for(timeout=TIMEOUT)
            assert page.evaluate(INSIDE, "#call-send")
    page.set_viewport_size({"width": 1280, "height": 800})
    page.locator("#left #tree").wait_for(timeout=TIMEOUT)
    assert found.errors == []


# ---------------------------------------------------------------------- the tour


def test_the_tour_has_six_steps_and_begins_only_at_the_first_visit(session: Callable[..., Session]) -> None:
    found = session(tour=True)
    page, tour = found.page, found.page.locator("#tour")
    headings = []
    for number in range(1, 7):
        tour.filter(has_text=f"{number} of 6").wait_for(timeout=TIMEOUT)
        headings.append(tour.locator("h3").inner_text())
        assert page.locator(".toured").count() == 1
        found.picture(f"tour_{number}")
        page.locator("#tour-next").click()
    assert len(set(headings)) == 6 and tour.is_hidden() and page.locator(".toured").count() == 0
    page.reload()
    found.until("app?.state && app.stage.draws > 1")
    assert tour.is_hidden()
    page.locator("#tour-start").click()
    assert tour.is_visible()
    page.locator("#canvas").press("Escape")
    assert tour.is_hidden() and found.errors == []


def test_a_tour_that_is_skipped_stays_off_for_the_pages_of_other_runs(session: Callable[..., Session]) -> None:
    found = session(tour=True, size=PHONE)
    found.page.locator("#tour-skip").click(timeout=TIMEOUT)
    other = session()
    other.page.context.clear_cookies()
    other.page.context.add_cookies(found.page.context.cookies())
    other.page.reload()
    other.until("app?.state && app.stage.draws > 1")
    assert other.view.server.port != found.view.server.port and other.page.locator("#tour").is_hidden()
    assert found.errors == [] and other.errors == []
