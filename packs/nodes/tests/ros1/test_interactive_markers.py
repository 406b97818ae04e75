"""Markers that a viewer moves, in programs of ROS 1."""

from __future__ import annotations

from typing import Any

PROGRAM = """
    import rospy
    from interactive_markers.interactive_marker_server import *
    from interactive_markers.menu_handler import *
    from visualization_msgs.msg import *

    rospy.init_node("goals")
    server = InteractiveMarkerServer("goals")
    marker = InteractiveMarker()
    marker.name = "goal"
    server.insert(marker, lambda feedback: rospy.loginfo("moved to %s", feedback.pose.position.x))
    menu = MenuHandler()
    drive = menu.insert("Drive", callback=lambda feedback: rospy.loginfo("drive"))
    menu.apply(server, "goal")
    server.applyChanges()

    def report(update):
        if update.type == update.UPDATE:
            rospy.loginfo("update %s %s", update.seq_num, [pose.pose.position.x for pose in update.poses])

    rospy.Subscriber("goals/update", InteractiveMarkerUpdate, report)
    rospy.Subscriber("goals/update_full", InteractiveMarkerInit, lambda all: rospy.loginfo("all %s", len(all.markers)))
    publisher = rospy.Publisher("goals/feedback", InteractiveMarkerFeedback, queue_size=1)
    rospy.sleep(0.2)
    feedback = InteractiveMarkerFeedback()
    feedback.marker_name = "goal"
    feedback.event_type = feedback.POSE_UPDATE
    feedback.pose.position.x = 2
    publisher.publish(feedback)
    rospy.sleep(0.1)
    feedback.event_type = feedback.MENU_SELECT
    feedback.menu_entry_id = drive
    publisher.publish(feedback)
    rospy.spin()
"""


def test_a_viewer_moves_a_marker_and_selects_an_entry_of_its_menu(sim: Any, add: Any, texts: Any) -> None:
    node = add(PROGRAM, "goals")
    sim.run(0.5)
    assert texts(node) == ["all 1", "moved to 2.0", "update 2 [2.0]", "all 1", "drive"]
