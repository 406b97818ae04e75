"""Program of ROS 1 that sets the parameter `description` to its first argument."""

import sys

import rospy

rospy.init_node("setter")
rospy.set_param("/description", sys.argv[1])
