"""Simulation of ros2_control: hardware, controllers and the controller manager.

Inputs are the plugin element of a model (`gz_ros2_control`, `gazebo_ros2_control`, `gazebo_ros_control`), its
`<ros2_control>` or `<transmission>` blocks, and parameter files in the layout of ROS 2 or ROS 1. Outputs are actuators
of the joints, and the topics, services and actions of the controller manager and of its controllers. Controllers access
joints only through command and state interfaces, never through the engine's model.
"""
