"""WebSocket servers of a simulation for Foxglove and for clients of rosbridge, each in a process of its own.

Each WebSocket client has its own connection to the simulation. The simulation queues the messages of each subscription,
drops the oldest for a client that reads too slowly, and closes what the client has opened when the client ends.
"""
