"""Controllers of ros2_controllers and of ROS 1, one file for each kind.

Inputs are the parameters of the controller's node, state interfaces, topics and goals. Outputs are values of command
interfaces, messages and results. A new kind is a new file in this folder: the manager finds it by the names in `types`.
Controllers never import the manager or the plugin.
"""
