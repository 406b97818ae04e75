"""play_motion: named motions of a robot that are planned, checked for collisions and played.

The package reads motion files in the layout of play_motion2 or ROS 1's play_motion, and accepts goals of their actions.
It sends goals to the robot's trajectory controllers, publishes results and feedback, and answers services. It never
moves a joint itself: the controllers of `ros2_control` do.
"""
