"""Markers that people move in programs: `interactive_markers` of ROS 2 and ROS 1."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from textwrap import dedent

import simkit

ROS_2 = dedent(
    """
    import rclpy
    from interactive_markers import InteractiveMarkerServer, MenuHandler
    from visualization_msgs.msg import InteractiveMarker
    rclpy.init()
    node = rclpy.create_node("a")
    log = node.get_logger().info
    server = InteractiveMarkerServer(node, "boxes")
    marker = InteractiveMarker(name="box")
    marker.header.frame_id = "map"
    server.insert(marker, feedback_callback=lambda f: log(f"moved to {f.pose.position.x}"))
    menu = MenuHandler()
    top = menu.insert("colour")
    red = menu.insert("red", parent=top, callback=lambda f: log(f"chosen {menu.getTitle(f.menu_entry_id)}"))
    menu.setCheckState(red, MenuHandler.CHECKED)
    menu.apply(server, "box")
    server.applyChanges()
    rclpy.spin(node)
    """
)
ROS_1 = dedent(
    """
    import rospy
    from interactive_markers.interactive_marker_server import *
    from interactive_markers.menu_handler import *
    rospy.init_node("a")
    server = InteractiveMarkerServer("boxes")
    marker = InteractiveMarker(name="box")
    marker.header.frame_id = "map"
    server.insert(marker, lambda f: rospy.loginfo("moved to %s", f.pose.position.x))
    menu = MenuHandler()
    top = menu.insert("colour")
    red = menu.insert("red", parent=top, callback=lambda f: rospy.loginfo("chosen %s", menu.getTitle(f.menu_entry_id)))
    menu.setCheckState(red, MenuHandler.CHECKED)
    menu.apply(server, "box")
    server.applyChanges()
    rospy.spin()
    """
)


def run_server(sim: simkit.Simulation, file: Path, text: str) -> list[str]:
    """Run a server, send it feedback of two clients, and return the texts of its log."""
    file.write_text(text)
    node = sim.add_node(file)
    updates = sim.subscribe("/boxes/update")
    feedback = sim.advertise("/boxes/feedback", "visualization_msgs/msg/InteractiveMarkerFeedback")
    sim.run(0.1)
    moved = {"marker_name": "box", "event_type": 1, "pose": {"position": {"x": 2.0}}}
    for message in (
        {**moved, "client_id": "rviz"},
        {**moved, "client_id": "other"},  # too soon after the first client
        {"marker_name": "box", "client_id": "rviz", "event_type": 2, "menu_entry_id": 2},
    ):
        feedback.publish(message)
        sim.run(0.1)
    assert node.error is None, "\n".join(node.log)
    poses = [pose.pose.position.x for update in updates.messages for pose in update.poses]
    assert poses == [2.0]
    return [line.split("]: ", 1)[1] for line in node.log if "]: " in line]


def test_a_marker_is_moved_and_its_menu_is_used(sim: simkit.Simulation, tmp_path: Path) -> None:
    assert run_server(sim, tmp_path / "server.py", ROS_2) == ["moved to 2.0", "chosen red"]
    response = []
    sim.call("/boxes/get_interactive_markers", on_done=lambda call: response.append(call.response))
    sim.run(0.05)
    (marker,) = response[0].markers
    assert (marker.name, marker.pose.position.x) == ("box", 2.0)
    assert [(entry.title, entry.parent_id) for entry in marker.menu_entries] == [("colour", 0), ("[x] red", 1)]


def test_a_program_of_ros_1_has_the_same(sim: simkit.Simulation, tmp_path: Path) -> None:
    everything = sim.subscribe("/boxes/update_full")
    assert run_server(sim, tmp_path / "server.py", ROS_1) == ["moved to 2.0", "chosen red"]
    assert everything.messages[-1].markers[0].pose.position.x == 2.0


def test_changes_wait_until_they_are_applied(run_program: Callable[..., list[str]]) -> None:
    texts = run_program(
        """
        import rclpy
        from geometry_msgs.msg import Pose
        from interactive_markers.interactive_marker_server import InteractiveMarkerServer
        from visualization_msgs.msg import InteractiveMarker, InteractiveMarkerUpdate
        rclpy.init()
        node = rclpy.create_node("a")
        server = InteractiveMarkerServer(node, "boxes")
        def heard(update):
            node.get_logger().info(
                f"{update.seq_num} {[m.name for m in update.markers]} {[p.name for p in update.poses]} {update.erases}")
        node.create_subscription(InteractiveMarkerUpdate, "boxes/update", heard, 10)
        pose = Pose()
        pose.position.x = 3.0
        for _ in range(3):
            rclpy.spin_once(node, timeout_sec=0.1)
        results = [server.setPose("box", pose)]
        server.insert(InteractiveMarker(name="box"))
        server.applyChanges()
        results += [server.setPose("box", pose), server.get("box").pose.position.x]
        server.applyChanges()
        results += [server.erase("box"), server.erase("other"), server.get("box")]
        server.applyChanges()
        server.applyChanges()
        for _ in range(5):
            rclpy.spin_once(node, timeout_sec=0.1)
        node.get_logger().info(str(results))
        """
    )
    assert texts == [
        "1 ['box'] [] []",
        "2 [] ['box'] []",
        "3 [] [] ['box']",
        "[False, True, 3.0, True, False, None]",
    ]
