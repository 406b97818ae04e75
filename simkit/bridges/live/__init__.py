"""Local sockets of running simulations: the server that `simkit run` polls, and the client behind `simkit.live`.

Other processes of the same user send requests, commands and goals. The server sends answers and subscribed messages.
All data is sent in the frames that `protocol.py` defines. No thread runs in parallel to the physics. The bits of a run
therefore depend only on the commands and on the steps at which they arrived.
"""
