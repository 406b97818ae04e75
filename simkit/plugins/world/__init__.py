"""What every world brings: its clock, its services, its statistics; and the sun by date and place.

Requests of ROS and gz enter, answers and the world's state leave. No model's own plugin lies here.
"""
