"""Interactive markers of a program: what a page gets of them, and the feedback that it sends."""

from __future__ import annotations

from pathlib import Path
from textwrap import dedent
from typing import Any

import pytest

from packs.view.tests.view.conftest import Stage

SERVER = dedent(
    """
    import rclpy
    from interactive_markers import InteractiveMarkerServer, MenuHandler
    from visualization_msgs.msg import InteractiveMarker, InteractiveMarkerControl, Marker
    rclpy.init()
    node = rclpy.create_node("a")
    log = node.get_logger().info
    server = InteractiveMarkerServer(node, "boxes")

    def take(feedback):
        if feedback.event_type == feedback.POSE_UPDATE:
            log(f"moved to {feedback.pose.position.x:.2f} {feedback.pose.position.y:.2f} in {feedback.header.frame_id}")
        elif feedback.event_type == feedback.MENU_SELECT:
            log(f"chosen {menu.getTitle(feedback.menu_entry_id)} of {feedback.control_name}")

    marker = InteractiveMarker(name="goal", description="goal of the robot", scale=0.5)
    marker.header.frame_id = "map"
    marker.pose.position.x = 1.0
    cube = Marker(type=Marker.CUBE)
    cube.scale.x = cube.scale.y = cube.scale.z = 0.2
    cube.color.r = cube.color.a = 1.0
    plane = InteractiveMarkerControl(name="plane", interaction_mode=InteractiveMarkerControl.MOVE_PLANE)
    plane.orientation.w, plane.orientation.y = 0.7071, 0.7071  # the x axis points up or down
    plane.markers.append(cube)
    turn = InteractiveMarkerControl(name="turn", interaction_mode=InteractiveMarkerControl.ROTATE_AXIS)
    turn.orientation = plane.orientation
    choice = InteractiveMarkerControl(name="choice", interaction_mode=InteractiveMarkerControl.MENU)
    marker.controls += [plane, turn, choice]
    server.insert(marker, feedback_callback=take)
    menu = MenuHandler()
    top = menu.insert("go")
    menu.insert("fast", parent=top, callback=take)
    menu.apply(server, "goal")
    server.applyChanges()
    rclpy.spin(node)
    """
)
TOPIC = "/boxes/update"


def handles(packet: tuple[dict[str, Any], Any]) -> list[dict[str, Any]]:
    return [handle for group in packet[0]["groups"] for handle in group["handles"]]


def test_a_marker_that_was_there_before_the_page_is_drawn_moved_and_its_menu_used(stage: Stage, tmp_path: Path) -> None:
    sim, file = stage.sim, tmp_path / "server.py"
    file.write_text(SERVER)
    node = sim.add_node(file)
    sim.run(0.1)
    page = stage.page()
    page.want(**{f"display:{TOPIC}": {}})

    def first() -> Any:
        sim.step(5)
        return handles(page.packets[f"display:{TOPIC}"])

    (handle,) = page.until(first)
    assert handle["name"] == "goal" and handle["description"] == "goal of the robot"
    assert (handle["move"], handle["turn"]) == ([True, True, False], [False, False, True])
    assert handle["pose"][:3] == pytest.approx([1.0, 0.0, 0.0])
    (entry,) = [number for number, _, title in handle["menu"] if title == "fast"]

    moved = {"topic": TOPIC, "name": "goal", "event": "pose_update", "pose": [2.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0]}
    assert page.ask("marker", **moved)["ok"] == "/boxes/feedback"

    def is_moved() -> bool:
        sim.step(5)
        (found,) = handles(page.packets[f"display:{TOPIC}"])
        return found["pose"][0] > 1.9

    page.until(is_moved)
    assert page.packets[f"display:{TOPIC}"][1]["g0.cube"][0, :2] == pytest.approx([2.0, 1.0])
    page.ask("marker", **{**moved, "event": "menu_select", "entry": entry})
    sim.run(0.05)
    assert [line.rpartition(": ")[2] for line in node.log] == ["moved to 2.00 1.00 in map", "chosen fast of choice"]


def test_events_of_unknown_markers_and_topics_are_refused(stage: Stage) -> None:
    page, pose = stage.page(), [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]
    answer = page.ask("marker", topic="/none/update", name="a", event="pose_update", pose=pose)
    assert "does not show interactive markers of '/none/update'" in answer["error"]
    updates = stage.sim.advertise(TOPIC, "visualization_msgs/msg/InteractiveMarkerUpdate")
    page.want(**{f"display:{TOPIC}": {}})
    page.until(lambda: stage.sim.communication.bus.wanted(TOPIC))
    updates.publish({"markers": [{"name": "lost", "header": {"frame_id": "nowhere"}}]})
    page.until(lambda: page.packets[f"display:{TOPIC}"][0]["problems"] == ["the frame 'nowhere' is unknown"])
    for event, name, problem in (("jump", "lost", "pose_update"), ("mouse_up", "lost", "no marker 'lost'")):
        assert problem in page.ask("marker", topic=TOPIC, name=name, event=event, pose=pose)["error"]
