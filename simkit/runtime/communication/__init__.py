"""Topics, services, actions and live parameters within the process, with the types of ROS 2.

- Input: messages, requests, goals and parameter values, as objects or dicts of their fields.
- Output: the same, in the order of arrival and between two steps.
- Not known here: sockets, serialisation and physics.
"""
