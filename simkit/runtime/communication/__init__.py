"""Topics, services, actions and live parameters within the process, with the types of ROS 2.

What enters: messages, requests, goals and parameter values, as objects or dicts of their fields. What leaves: the same,
in the order of arrival and between two steps. What never: sockets, serialisation, and anything of the physics.
"""
