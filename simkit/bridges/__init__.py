"""Connections of a running simulation to other processes (local clients) and to a viewer window.

A bridge is polled between two steps. Its commands have the same effect as calls in the simulation's process. A bridge
without commands never changes the physics. Network ports are opened only if the user requests them.
"""
