"""play_motion: motions that a robot knows by name, planned, checked for collisions and played.

What enters: files of motions in the layout of play_motion2 or ROS 1's play_motion, and goals of their actions. What
leaves: goals for the robot's trajectory controllers, results and feedback, and answers of services. It never moves a
joint by itself: whoever moves one is a controller of `ros2_control`.
"""
