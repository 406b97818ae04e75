"""Modules with the names of ROS 1 packages: the folder `rospy` here is what a program of ROS 1 imports as `rospy`.

They have the form of those in `ros_modules`, and come before them for programs of ROS 1.
"""
