"""Named motions of a robot, as in ROS's play_motion: read from files, planned, checked for collisions and played.

The package reads motion files of play_motion2 (ROS 2) and play_motion (ROS 1), and accepts goals of the actions of
both. For each motion, it sends goals to the robot's trajectory controllers, and then publishes feedback and a result.
Only the controllers of `ros2_control` move joints.
"""
