"""Tests: libraries for programs of ROS 1 beside `rospy`, `tf` and `actionlib`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest


def test_a_time_synchronizer_calls_its_function_with_messages_of_the_same_stamp(sim: Any, add: Any, texts: Any) -> None:
    node = add(
        """
        import message_filters, rospy
        from geometry_msgs.msg import PointStamped
        def both(a, b):
            rospy.loginfo("%s %s %s", a.header.stamp.to_sec(), a.point.x, b.point.x)
        rospy.init_node("a")
        inputs = [message_filters.Subscriber(topic, PointStamped) for topic in ("left", "right")]
        message_filters.TimeSynchronizer(inputs, 10).registerCallback(both)
        near = message_filters.ApproximateTimeSynchronizer(inputs, 10, 0.2)
        near.registerCallback(lambda a, b: rospy.loginfo("near %s %s", a.point.x, b.point.x))
        cache = message_filters.Cache(inputs[0], 5)
        publishers = [rospy.Publisher(topic, PointStamped, queue_size=1) for topic in ("left", "right")]
        rospy.sleep(0.1)
        for number, (publisher, stamp) in enumerate([(0, 1), (1, 1), (0, 2), (1, 2.1)]):
            message = PointStamped()
            message.header.stamp, message.point.x = rospy.Time.from_sec(stamp), number
            publishers[publisher].publish(message)
            rospy.sleep(0.1)
        rospy.loginfo("%s", cache.getElemBeforeTime(rospy.Time(1.5)).point.x)
        """
    )
    sim.run(1.0)
    assert node.error is None
    assert texts(node) == ["1.0 0.0 1.0", "near 0.0 1.0", "near 2.0 3.0", "0.0"]


def test_point_clouds_are_written_and_read(sim: Any, add: Any, texts: Any) -> None:
    node = add(
        """
        import rospy
        import sensor_msgs.point_cloud2 as pc2
        from sensor_msgs.msg import PointCloud2
        from std_msgs.msg import Header
        def heard(cloud):
            rospy.loginfo("%s", list(pc2.read_points(cloud, ("x", "z"), skip_nans=True)))
            rospy.loginfo("%s", pc2.read_points_list(cloud)[1].y)
        rospy.init_node("a")
        rospy.Subscriber("cloud", PointCloud2, heard)
        publisher = rospy.Publisher("cloud", PointCloud2, queue_size=1)
        rospy.sleep(0.1)
        publisher.publish(pc2.create_cloud_xyz32(Header(), [(1, 2, 3), (4, 5, 6), (float("nan"), 0, 0)]))
        rospy.spin()
        """
    )
    sim.run(0.2)
    assert node.error is None
    assert texts(node) == ["[(1.0, 3.0), (4.0, 6.0)]", "5.0"]


def test_images_are_converted(sim: Any, add: Any, texts: Any) -> None:
    pytest.importorskip("cv2")
    node = add(
        """
        import numpy, rospy
        from cv_bridge import CvBridge, CvBridgeError
        from sensor_msgs.msg import Image
        def heard(message):
            rospy.loginfo("%s %s", message.encoding, CvBridge().imgmsg_to_cv2(message, "bgr8")[0, 0])
        rospy.init_node("a")
        rospy.Subscriber("image", Image, heard)
        publisher = rospy.Publisher("image", Image, queue_size=1)
        rospy.sleep(0.1)
        picture = numpy.full((2, 3, 3), (1, 2, 3), numpy.uint8)
        publisher.publish(CvBridge().cv2_to_imgmsg(picture, "rgb8"))
        rospy.spin()
        """
    )
    sim.run(0.2)
    assert node.error is None
    assert texts(node) == ["rgb8 [3 2 1]"]


def test_parameters_come_from_a_yaml_file(sim: Any, add: Any, texts: Any, tmp_path: Path) -> None:
    (tmp_path / "robot.yaml").write_text("speed: 0.5\ngains: {p: 1, i: 2}\n")
    node = add(
        """
        import os, rosparam, rospy
        rospy.init_node("a")
        for values, namespace in rosparam.load_file(os.path.join(os.path.dirname(__file__), "robot.yaml")):
            rosparam.upload_params(namespace + "robot", values)
        rospy.loginfo("%s %s", rospy.get_param("robot/gains/i"), rosparam.list_params("/robot"))
        """
    )
    sim.run(0.01)
    assert texts(node) == ["2 ['/robot/gains/i', '/robot/gains/p', '/robot/speed']"]


def test_packages_of_the_workspace_are_found_by_name(sim: Any, tmp_path: Path) -> None:
    package = tmp_path / "src" / "my_robot"
    (package / "scripts").mkdir(parents=True)
    (package / "package.xml").write_text("<package format='2'><name>my_robot</name></package>")
    file = package / "scripts" / "node.py"
    file.write_text(
        "import roslib, roslib.packages, rospkg, rospy\n"
        "roslib.load_manifest('my_robot')\n"
        "rospy.init_node('a')\n"
        "assert rospkg.RosPack().get_path('my_robot') == roslib.packages.get_pkg_dir('my_robot')\n"
        "rospy.loginfo(rospkg.RosPack().get_path('my_robot'))\n"
        "try:\n"
        "    rospkg.RosPack().get_path('other')\n"
        "except rospkg.ResourceNotFound as error:\n"
        "    rospy.loginfo('%s', error)\n"
    )
    node = sim.add_node(file)
    sim.run(0.01)
    assert [line.split("]: ")[1] for line in node.log] == [str(package), "other"]


def test_topics_services_and_nodes_are_found_by_name(sim: Any, add: Any, texts: Any) -> None:
    node = add(
        """
        import rosgraph, roslib.message, rosnode, rospy, rosservice, rostopic
        from std_msgs.msg import String
        from std_srvs.srv import Empty
        rospy.init_node("a")
        rospy.Publisher("chatter", String, queue_size=1)
        rospy.Service("work", Empty, lambda request: [])
        rospy.sleep(0.1)
        rospy.loginfo("%s %s", rostopic.get_topic_type("chatter")[0], rostopic.get_topic_class("chatter")[0] is String)
        rospy.loginfo("%s", rosservice.get_service_class_by_name("work") is Empty)
        rospy.loginfo("%s %s", "/a" in rosnode.get_node_names(), "/work" in rosservice.get_service_list())
        state = rosgraph.Master("/a").getSystemState()
        rospy.loginfo("%s", [nodes for topic, nodes in state[0] if topic == "/chatter"])
        rospy.loginfo("%s", roslib.message.get_message_class("std_msgs/Nothing"))
        """
    )
    sim.run(0.2)
    assert node.error is None
    assert texts(node) == ["std_msgs/String True", "True", "True True", "[['/a']]", "None"]


def test_messages_have_the_fields_of_ros_1(sim: Any, add: Any, texts: Any) -> None:
    node = add(
        """
        import io, rospy, genpy
        from sensor_msgs.msg import CameraInfo, LaserScan
        rospy.init_node("a")
        rospy.Subscriber("info", CameraInfo, lambda m: rospy.loginfo("%s %s", m.K[0], m.header.stamp.secs))
        publisher = rospy.Publisher("info", CameraInfo, queue_size=1)
        rospy.sleep(0.1)
        info = CameraInfo(K=[5] + 8 * [0])
        info.header.stamp = rospy.Time(7)
        publisher.publish(info)
        rospy.loginfo("%s", isinstance(info.header.stamp, genpy.Time))
        rospy.spin()
        """
    )
    sim.run(0.2)
    assert node.error is None
    assert texts(node) == ["True", "5.0 7"]


def test_a_program_of_ros_1_is_known_by_its_imports(sim: Any, add: Any, tmp_path: Path) -> None:
    (tmp_path / "robot_tools.py").write_text("import rospy\n")
    through_module = add("from std_msgs.msg import Header\nimport robot_tools\nHeader().seq\n", "indirect")
    ros2 = add("from std_msgs.msg import Header\nassert not hasattr(Header(), 'seq')\n", "modern")
    sim.run(0.01)
    assert through_module.error is None
    assert ros2.error is None


@pytest.mark.slow
def test_a_program_without_rospy_in_a_catkin_package_is_one_of_ros_1(sim: Any, tmp_path: Path) -> None:
    text = "<package format='2'><name>robot</name><buildtool_depend>catkin</buildtool_depend></package>"
    (tmp_path / "package.xml").write_text(text)
    (tmp_path / "node.py").write_text("from std_msgs.msg import Header\nHeader().seq\n")
    node = sim.add_node(tmp_path / "node.py")
    sim.run(0.01)
    assert node.error is None


def test_an_exception_of_rospy_is_printed_with_its_name_in_ros(sim: Any, add: Any) -> None:
    node = add("import rospy\nrospy.init_node('a')\nrospy.wait_for_service('b', 0.1)\n")
    sim.run(0.2)
    assert node.log[-1] == "rospy.exceptions.ROSException: timeout exceeded while waiting for service /b"


def test_messages_are_filled_from_values_of_yaml_and_restored_from_bytes(sim: Any, add: Any, texts: Any) -> None:
    node = add(
        """
        import genpy, io, rospy
        from geometry_msgs.msg import PoseArray
        rospy.init_node("a")
        message = PoseArray()
        values = {"header": {"stamp": "now", "frame_id": "map"}, "poses": [{"position": [1, 2, 3]}]}
        genpy.message.fill_message_args(message, [values], {"now": rospy.Time(5)})
        rospy.loginfo("%s %s %s", message.header.stamp.secs, message.header.frame_id, message.poses[0].position.z)
        buffer = io.BytesIO()
        message.serialize(buffer)
        rospy.loginfo("%s", PoseArray().deserialize(buffer.getvalue()) == message)
        try:
            genpy.message.fill_message_args(message, {"pose": 1})
        except genpy.message.ROSMessageException as error:
            rospy.loginfo("%s", error)
        """
    )
    sim.run(0.01)
    assert node.error is None
    assert texts(node) == [
        "5 map 3",
        "True",
        "No field name [pose] in geometry_msgs/PoseArray; it has ['header', 'poses']",
    ]


def test_tf_message_is_the_type_of_the_topic_tf(sim: Any, add: Any, texts: Any) -> None:
    node = add(
        """
        import rospy, tf.msg
        from geometry_msgs.msg import TransformStamped
        rospy.init_node("a")
        rospy.Subscriber("/tf", tf.msg.tfMessage, lambda m: rospy.loginfo(m.transforms[0].child_frame_id))
        publisher = rospy.Publisher("/tf", tf.msg.tfMessage, queue_size=1)
        rospy.sleep(0.1)
        publisher.publish(tf.msg.tfMessage([TransformStamped(child_frame_id="carrot")]))
        rospy.spin()
        """
    )
    sim.run(0.2)
    assert texts(node) == ["carrot"]
