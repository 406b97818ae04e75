"""World plugins of every simulation: clock, services and statistics; also the sun by date and place.

Requests of ROS and gz come in, responses and the state of the world go out. This package has no plugins of models.
"""
