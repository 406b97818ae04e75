"""ros2_control in the simulation: hardware, controllers and the controller manager.

What enters: the plugin element of a model (`gz_ros2_control`, `gazebo_ros2_control`, `gazebo_ros_control`), its
`<ros2_control>` or `<transmission>` blocks, and parameter files in the layout of ROS 2 or ROS 1. What leaves: actuators
of the joints, and the topics, services and actions of the controller manager and of its controllers. Controllers see
joints only through command and state interfaces; they never reach into the engine's model by themselves.
"""
