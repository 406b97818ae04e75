"""World plugins of every simulation: clock, services and statistics; also the sun by date and location.

They answer the requests of ROS and gz, and publish the state of the world. This package has no plugins of models.
"""
