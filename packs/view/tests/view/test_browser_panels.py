"""The panels below the scene, in a real browser: each control does what it says in the page and in the simulation."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest

import simkit
from packs.view.tests.view.test_browser import TIMEOUT, Session, browser  # noqa: F401 - a fixture
from packs.view.tests.view.test_panels import MOVING
from simkit.recording import Recorder
from simkit.recording.bags.reader import open_bag_to_read
from simkit_view.view.bag_panels import BagPanels
from simkit_view.view.bag_recording import make_recording
from simkit_view.view.html_file import html_file
from simkit_view.view.live_view import LiveView
from simkit_view.view.scene_packet import make_scene_packet

pytestmark = pytest.mark.browser


@pytest.fixture
def session(browser: Any) -> Iterator[Callable[..., Session]]:  # noqa: F811 - the fixture
    with ExitStack() as stack:
        yield lambda world=MOVING, **more: Session(browser, stack, world, **more)


def opened(found: Session, tab: str) -> Session:
    """Open a tab below the scene."""
    found.until("app.state?.tick > 0")
    found.page.locator(f"#tab-{tab}").click()
    return found


def drive(found: Session, ahead: float = 0.5, turn: float = 0.4) -> None:
    found.page.evaluate(f"simkitView.send('drive', {{topic: '/cmd_vel', ahead: {ahead}, turn: {turn}}})")


def newest(found: Session, curve: str) -> float:
    return found.get(f"app.plots.store.curves.get({curve!r}).v.at(-1)")


# ---------------------------------------------------------------------- plots


def test_a_field_is_chosen_and_dragged_to_a_plot_and_lies_on_the_truth(session: Callable[..., Session]) -> None:
    found = opened(session(), "plots")
    page = found.page
    page.locator("[data-topic='/odom'] summary").click()
    page.locator("[data-field='pose.pose.position.x']").click()
    page.locator("[data-topic='truth:rover'] summary").click()
    page.locator("[data-field='rover.x']").drag_to(page.locator(".plot .area"))
    page.locator("#topic-path").fill("/scan.ranges[4]")
    page.locator("#topic-path").press("Enter")
    drive(found)
    found.until("app.plots.store.curves.get('/scan ranges[4]')?.v.length > 20")
    found.until("app.plots.store.curves.get('/odom pose.pose.position.x')?.v.at(-1) > 0.05")
    page.locator("#play").click()
    found.until("app.state.paused")
    found.until(f"Math.abs(app.plots.store.curves.get('truth rover.x').t.at(-1) - {found.sim.time}) < 1e-3")
    true = found.do(lambda: found.sim.model("rover").pose.position[0])
    assert newest(found, "truth rover.x") == pytest.approx(true, abs=1e-4)
    assert newest(found, "/odom pose.pose.position.x") == pytest.approx(newest(found, "truth rover.x"), abs=0.03)
    rates = "document.querySelector('[data-rate=\"/odom\"]').textContent"
    found.until(f"parseFloat({rates}) > 45 && parseFloat({rates}) < 55")
    assert found.errors == [] and found.outside == []
    found.picture("plots_small")


def test_a_plot_pauses_zooms_clears_and_is_saved(session: Callable[..., Session], tmp_path: Path) -> None:
    found = opened(session(), "plots")
    page = found.page
    found.until("app.plots.list.topics.length > 2")
    found.get("app.plots.choose('/odom', 'pose.pose.orientation.yaw')")
    found.get("app.plots.choose('/odom', 'twist.twist.linear.x')")
    drive(found)
    found.until("app.plots.all[0].chart?.data[0].length > 50")
    page.locator(".plot .pause").click()
    number = found.get("app.plots.all[0].chart.data[0].length")
    found.until("app.plots.store.curves.get('/odom twist.twist.linear.x').v.length > 120")
    assert found.get("app.plots.all[0].chart.data[0].length") == number
    page.locator(".plot .pause").click()
    found.until(f"app.plots.all[0].chart.data[0].length > {number}")
    box = page.locator(".plot .u-over").bounding_box()
    for act, share in ((page.mouse.move, 0.3), (None, 0), (page.mouse.move, 0.6)):
        page.mouse.down() if act is None else act(box["x"] + share * box["width"], box["y"] + 20)
    page.mouse.up()
    low, high = found.until("app.plots.all[0].zoom")
    found.until(f"Math.abs(app.plots.all[0].chart.scales.x.min - {low}) < 1e-6")
    assert found.get("app.plots.all[0].chart.scales.x.max") == pytest.approx(high)
    page.locator(".plot .u-over").dblclick()
    found.until("app.plots.all[0].zoom === null")
    with page.expect_download() as saved:
        page.locator(".plot .csv").click()
    saved.value.save_as(tmp_path / "plot.csv")
    rows = list(csv.reader(io.StringIO((tmp_path / "plot.csv").read_text())))
    assert rows[0] == ["time [s]", "/odom.pose.pose.orientation.yaw [rad]", "/odom.twist.twist.linear.x [m/s]"]
    assert len(rows) > 100 and float(rows[-1][2]) == pytest.approx(0.5, abs=0.05)
    with page.expect_download() as saved:
        page.locator(".plot .png").click()
    saved.value.save_as(tmp_path / "plot.png")
    assert (tmp_path / "plot.png").read_bytes().startswith(b"\x89PNG")
    found.get("app.send('reset')")
    found.until("app.plots.store.curves.get('/odom twist.twist.linear.x').t[0] < 0.5")
    page.locator("#play").click()
    found.until("app.state.paused")
    page.locator(".plot .clear").click()
    found.until("app.plots.store.curves.get('/odom twist.twist.linear.x').v.length < 5")
    page.reload()  # the plots are the same afterwards
    found.until(
        "app.plots?.all[0].fields.map(one => one.field).join() === 'pose.pose.orientation.yaw,twist.twist.linear.x'"
    )
    assert found.errors == []


def test_odometry_is_plotted_beside_the_truth(session: Callable[..., Session]) -> None:
    found = opened(session("turtlebot3_world", size=(1400, 860)), "plots")
    found.until("app.plots.list.topics.length > 5")
    drive(found, 0.12, 0.25)
    for topic, fields in {"/odom": ("x", "y"), "truth": ("x", "y")}.items():
        for field in fields:
            name = f"turtlebot3.{field}" if topic == "truth" else f"pose.pose.position.{field}"
            found.get(f"app.plots.choose('{topic}', '{name}')")
    found.get("app.plots.add()")
    found.get("app.plots.choose('/odom', 'pose.pose.orientation.yaw')")
    found.get("app.plots.choose('truth', 'turtlebot3.yaw')")
    found.page.locator("[data-topic='/odom'] summary").click()
    found.until("app.plots.store.curves.get('truth turtlebot3.yaw')?.v.at(-1) > 0.9")
    found.picture("view_plots")
    yaw = newest(found, "truth turtlebot3.yaw")
    assert newest(found, "/odom pose.pose.orientation.yaw") == pytest.approx(yaw, abs=0.2)
    found.page.locator("#tab-calls").click()
    found.page.locator("#call-search").fill("set_pose")
    found.page.locator("[data-call-name='/world/turtlebot3_world/set_pose']").click()
    found.page.locator(".call-form [name=name]").fill("turtlebot3", timeout=TIMEOUT)
    found.page.locator(".call-form [name=x]").first.fill("-0.5")
    found.page.locator("#call-send").click()
    found.page.locator("#call-response", has_text="success: true").wait_for(timeout=TIMEOUT)
    found.picture("view_forms")


def test_a_tab_that_is_not_shown_asks_for_nothing(session: Callable[..., Session]) -> None:
    found = opened(session(), "plots")
    found.until("app.plots.list.topics.length > 2")
    found.get("app.plots.choose('/odom', 'pose.pose.position')")
    found.until("app.plots.store.curves.size === 3")
    usual = ["lidar", "joints", "ranges", "displays", "driving"]
    wants = f"Object.keys(app.connection.wants).filter(name => !{usual}.includes(name)).sort().join()"
    assert found.get(wants) == "rates,series:/odom,topics"
    for tab, expected in {
        "console": "log",
        "calls": "calls",
        "parameters": "parameters",
        "graph": "graph,rates",
        "frames": "frames",
    }.items():
        found.page.locator(f"#tab-{tab}").click()
        assert found.get(wants) == expected
    found.page.locator("#dock-close").click()
    assert found.get(wants) == ""
    found.until_here(lambda: "/odom" not in {s.topic for s in found.sim.communication.bus.subscriptions()})


def test_a_wrong_field_says_what_is_wrong(session: Callable[..., Session]) -> None:
    found = opened(session(), "plots")
    found.until("app.plots.list.topics.length > 2")
    found.get("app.plots.choose('/odom', 'pose.pose.positon.x')")
    found.page.locator(".key.wrong", has_text="did you mean 'position'").wait_for(timeout=TIMEOUT)
    found.get("app.plots.choose('/later', 'data')")
    found.page.locator(".key.wrong", has_text="no topic '/later'").wait_for(timeout=TIMEOUT)
    later = found.sim.advertise("/later", "std_msgs/msg/Float64")
    found.until_here(lambda: later.subscribers > 0)
    later.publish({"data": 5.0})
    found.until("app.plots.store.curves.get('/later data')?.v[0] === 5")


# ---------------------------------------------------------------------- console, forms and parameters


def test_the_console_filters_by_level_and_text(session: Callable[..., Session]) -> None:
    found = opened(session(), "console")
    found.until_here(lambda: "/rosout" in {s.topic for s in found.sim.communication.bus.subscriptions()})
    for text in ("one", "two"):
        found.sim.engine.log.info("number %s", text)
    found.sim.engine.log.error("it <b>broke</b>")
    found.page.locator(".log.error .text", has_text="it <b>broke</b>").wait_for(timeout=TIMEOUT)
    assert found.page.locator(".log", has_text="number").count() == 2
    found.page.locator("#log-text").fill("TWO")
    assert found.page.locator(".log").count() == 1
    found.page.locator("#log-text").fill("")
    found.page.locator("#log-level").select_option("error")
    assert found.page.locator(".log").count() == 1
    found.page.locator("#log-clear").click()
    assert found.page.locator(".log").count() == 0


def test_a_service_is_called_from_its_form(session: Callable[..., Session]) -> None:
    found = opened(session(), "calls")
    page = found.page
    page.locator("#call-search").fill("set_pose")
    page.locator("[data-call-name='/world/yard/set_pose']").click()
    page.locator(".call-form [name=id]").fill("-3")
    page.locator("#call-send").click()
    page.locator("#call-problem", has_text="entity.id: -3 is outside 0 to").wait_for(timeout=TIMEOUT)
    page.locator(".call-form [name=id]").fill("0")
    page.locator(".call-form [name=name]").fill("stone")
    page.locator(".call-form select[name=type]").select_option("MODEL = 2")
    for axis, value in {"x": "-2.5", "y": "1", "z": "0.05"}.items():
        page.locator(f".call-form [name={axis}]").first.fill(value)
    page.locator("#call-send").click()
    page.locator("#call-response", has_text="success: true").wait_for(timeout=TIMEOUT)
    place = found.do(lambda: found.sim.model("stone").pose.position[:2])
    assert place == pytest.approx([-2.5, 1.0], abs=0.01)


def test_a_goal_shows_its_feedback_and_is_cancelled(session: Callable[..., Session]) -> None:
    found, goals = session(), []
    found.sim.act("/count", "example_interfaces/action/Fibonacci", goals.append, on_cancel=lambda goal: goal.canceled())
    opened(found, "calls").page.locator("[data-call-name='/count']").click()
    found.page.locator(".call-form [name=order]").fill("7")
    found.page.locator("#call-send").click()
    found.until_here(lambda: bool(goals))
    assert goals[0].request.order == 7
    goals[0].publish_feedback({"sequence": [0, 1, 1]})
    found.page.locator(".call pre", has_text="feedback").wait_for(timeout=TIMEOUT)
    found.page.locator(".call button").click()
    found.page.locator(".call.canceled").wait_for(timeout=TIMEOUT)


def test_sliders_and_fields_set_parameters(session: Callable[..., Session]) -> None:
    found = session()
    gain = found.sim.declare("gain", 1.0, minimum=0.0, maximum=5.0, description="gain of the controller")
    mode = found.sim.declare("mode", "slow", choices=("slow", "fast"))
    free = found.sim.declare("offset", 0.5)
    page = opened(found, "parameters").page
    page.locator("[data-parameter='/script gain'] [type=range]").fill("3.5")
    found.until_here(lambda: gain.value == pytest.approx(3.5))
    page.locator("[data-parameter='/script mode'] select").select_option("fast")
    found.until_here(lambda: mode.value == "fast")
    field = page.locator("[data-parameter='/script offset'] input")
    field.fill("-2")
    field.press("Enter")
    found.until_here(lambda: free.value == -2.0)
    page.locator("[data-parameter='/script gain'] [type=number]").fill("9")
    page.locator("[data-parameter='/script gain'] [type=number]").press("Enter")
    page.locator("#notice", has_text="from 0 to 5").wait_for(timeout=TIMEOUT)
    assert gain.value == pytest.approx(3.5)


# ---------------------------------------------------------------------- graphs, motions and pictures


def test_the_graphs_are_drawn_with_rates(session: Callable[..., Session]) -> None:
    found = opened(session(), "graph")
    found.page.locator("[data-box='topic /odom'] text", has_text="50.0 Hz").wait_for(timeout=TIMEOUT)
    found.until("document.querySelectorAll('#node-graph .edge').length > 3")
    before = found.page.locator("[data-box='topic /scan']").count()
    found.page.locator("#graph-all").check()
    found.page.locator("[data-box='topic /clock']").wait_for(timeout=TIMEOUT)
    assert before == 1
    found.page.locator("#tab-frames").click()
    found.page.locator("[data-box='base']").first.wait_for(timeout=TIMEOUT)
    assert found.errors == []


def test_the_panels_of_tiago_are_drawn(session: Callable[..., Session]) -> None:
    """A motion is played, a joint is moved, and each panel is kept as a picture."""
    found = session("tiago_table", size=(1400, 860))
    page = opened(found, "motions").page
    page.locator("[data-motion=home]").wait_for(timeout=TIMEOUT)
    found.until("document.querySelectorAll('[data-target]').length > 8")
    page.locator("[data-target=torso_lift_joint]").evaluate("e => e.closest('details').open = true")
    page.locator("[data-target=torso_lift_joint]").fill("0.2")
    page.locator("[data-scale='/torso_controller/follow_joint_trajectory']").fill("0.5")
    page.locator("[data-move='/torso_controller/follow_joint_trajectory']").click()
    page.locator(".call.executing").wait_for(timeout=TIMEOUT)
    goal = found.do(lambda: found.view.calls.goal(1).request.trajectory.points[0].time_from_start)
    assert goal.sec == 4  # 2 s at half speed
    found.picture("view_motions")
    page.locator(".call.succeeded").wait_for(timeout=4 * TIMEOUT)
    height = found.do(lambda: found.sim.joint("tiago::torso_lift_joint").position)
    assert height == pytest.approx(0.2, abs=0.02)
    for tab in ("parameters", "frames", "graph"):
        page.locator(f"#tab-{tab}").click()
        page.wait_for_timeout(1500)
        found.picture(f"view_{tab}")
    assert found.errors == [] and found.outside == []


def test_motions_of_a_paused_world_show_the_positions_of_joints(session: Callable[..., Session]) -> None:
    found = session("tiago_table", paused=True)
    found.until("document.querySelector('#joints output')?.textContent")  # the only packet with positions has arrived
    found.page.locator("#tab-motions").click()
    found.until("document.querySelectorAll('[data-target]').length > 8")
    shown = found.until("document.querySelector('.controllers output').textContent")
    name = found.get("document.querySelector('[data-target]').dataset.target")
    position = found.do(lambda: found.sim.joint(f"tiago::{name}").position)
    assert float(shown) == pytest.approx(position, abs=0.001)


def test_a_click_in_the_picture_of_a_camera_turns_the_head_there(session: Callable[..., Session]) -> None:
    found = session("tiago_table", size=(1400, 860))
    page, joint = found.page, found.sim.joint("tiago::head_1_joint")
    found.until("app.stage.draws > 1 && document.querySelector('#picture').style.cursor === 'crosshair'")
    area = page.locator("#picture").bounding_box()
    found.picture("look_before")
    page.mouse.click(area["x"] + 0.25 * area["width"], area["y"] + 0.5 * area["height"])
    page.locator("#camera-panel", has_text="/head_controller/point_head_action").wait_for(timeout=TIMEOUT)
    found.until_here(lambda: joint.position > 0.15)  # the left quarter of the picture is at the robot's left
    page.wait_for_timeout(2000)
    found.picture("look_after")
    assert found.errors == []


@pytest.mark.parametrize("theme", ["dark", "light"])
@pytest.mark.parametrize("size", [(1300, 800), (480, 800)])
def test_200_topics_and_long_names_keep_the_panels_in_the_window(
    session: Callable[..., Session], theme: str, size: tuple[int, int]
) -> None:
    found = session(theme=theme, size=size)
    for number in range(200):
        found.sim.advertise(f"/robot_{number}/a_sensor_with_a_long_name/temperature", "sensor_msgs/msg/Temperature")
    page = opened(found, "plots").page
    found.until("app.plots.list.topics.length > 200")
    for field in ("pose.pose.position", "pose.pose.orientation.yaw", "twist.twist.linear.x"):
        found.get(f"app.plots.choose('/odom', '{field}')")
    drive(found)
    found.until("app.plots.all[0].chart?.data[0].length > 40")
    outside = "[...document.querySelectorAll('#dock *')].filter(e => !e.closest('.topic-rows, #dock-tabs, svg') &&"
    outside += " e.getBoundingClientRect().right > innerWidth + 1).map(e => e.className || e.id || e.tagName)"
    names = f"{theme}_{size[0]}"
    for tab in ("plots", "console", "calls", "parameters", "graph"):
        if tab != "plots":
            page.locator(f"#tab-{tab}").click()
        page.wait_for_timeout(1200)
        assert page.evaluate(outside) == [], tab
        found.picture(f"many_{names}_{tab}")
    assert found.errors == []


def test_the_panels_work_with_the_security_policy(session: Callable[..., Session]) -> None:
    found = session(checks_policy=True)
    for tab in ("plots", "console", "calls", "motions", "parameters", "graph", "frames"):
        found.page.locator(f"#tab-{tab}").click(timeout=TIMEOUT)
    found.page.locator("#tab-plots").click()
    found.page.locator("[data-topic='/odom'] summary").click(timeout=TIMEOUT)
    found.page.locator("[data-field='pose.pose.position.x']").click()
    found.page.locator(".plot canvas").wait_for(timeout=TIMEOUT)
    assert found.errors == [] and found.outside == []


# ---------------------------------------------------------------------- recordings


@pytest.fixture(scope="module")
def bag(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("bag") / "drive.mcap"
    with simkit.load(MOVING) as sim, Recorder(sim, path, topics=["*", "/rosout"]):
        sim.publish("/cmd_vel", {"linear": {"x": 0.5}})
        sim.engine.log.warning("it moves")
        sim.run(2.0)
    return path


CURVE = "app.plots.store.curves.get"


def test_a_bag_is_plotted_beside_the_truth(browser: Any, bag: Path) -> None:  # noqa: F811 - the fixture
    with ExitStack() as stack:
        reader = stack.enter_context(open_bag_to_read(bag))
        sim = stack.enter_context(simkit.load(MOVING))
        panels = BagPanels(reader, sim)
        view = stack.enter_context(LiveView(sim, recording=make_recording(sim, reader), streams=panels.streams))
        page = stack.enter_context(browser.new_context(bypass_csp=True)).new_page()
        page.goto(view.address)

        def until(condition: str) -> Any:
            """Update the view until an expression of the page is true."""
            text = f"(() => {{ const app = window.simkitView; return {condition}; }})()"
            for _ in range(600):
                view.update()
                if found := page.evaluate(text):
                    return found
                page.wait_for_timeout(25)
            raise AssertionError(condition)

        until("app?.player !== undefined && app.state !== null")
        assert page.locator("#tab-calls").is_hidden()
        page.locator("#tab-plots").click()
        until("app.plots.list.topics.some(topic => topic.name === '/odom')")
        page.evaluate("simkitView.plots.choose('/odom', 'twist.twist.linear.x')")
        page.evaluate("simkitView.plots.choose('truth', 'rover.forward')")
        until(f"{CURVE}('/odom twist.twist.linear.x')?.v.length > 90 && {CURVE}('truth rover.forward')?.v.length > 25")
        middle = page.evaluate("simkitView.plots.store.curves.get('truth rover.forward').v[15]")
        assert middle == pytest.approx(0.5, abs=0.02)
        page.locator("#tab-console").click()
        until("app.console?.entries.some(entry => entry.text === 'it moves')")


def test_one_file_plots_without_simkit(browser: Any, bag: Path, tmp_path: Path) -> None:  # noqa: F811
    with open_bag_to_read(bag) as reader, simkit.load(MOVING) as sim:
        scene = make_scene_packet(sim, 1, {"recording": True, "seed": 0})
        text = html_file("drive", scene, make_recording(sim, reader), BagPanels(reader, sim).file_packet())
    path = tmp_path / "drive.html"
    path.write_text(text, encoding="utf-8")
    page = browser.new_page()
    requests: list[str] = []
    page.on("request", lambda request: requests.append(request.url))
    page.goto(path.as_uri())
    page.locator("#tab-plots").click(timeout=TIMEOUT)
    page.locator("[data-topic='/odom'] summary").click()
    page.locator("[data-field='pose.pose.position.x']").click()
    values = page.evaluate("simkitView.plots.store.curves.get('/odom pose.pose.position.x').v")
    assert len(values) > 90 and values[-1] - values[0] == pytest.approx(1.0, abs=0.05)
    page.evaluate("simkitView.plots.choose('truth', 'rover.x')")
    assert page.evaluate("simkitView.plots.store.curves.get('truth rover.x').v.at(-1)") == pytest.approx(1.0, abs=0.05)
    page.locator("#tab-console").click()
    assert page.locator(".log.warn .text").inner_text() == "it moves"
    assert [url for url in requests if not url.startswith(("file:", "data:", "blob:"))] == []
    page.close()
