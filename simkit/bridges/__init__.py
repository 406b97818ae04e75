"""Bridges from a running simulation to the world outside its process: clients of other processes, and a window.

A simulation and what its clients send enter; messages, answers and pictures leave. A bridge is polled between two steps
and passes on what came as a caller in the process would; it never changes the physics by being there, and opens no
network port unless it is told to.
"""
