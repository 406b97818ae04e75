"""Local sockets of running simulations: the server that `simkit run` polls, and the client that `simkit.live` offers.

Requests, commands and goals of other processes of the same user enter; answers and subscribed messages leave as frames
of `protocol.py`. Nothing runs beside the physics, so that the bits of a run depend only on what came at which step.
"""
