"""Bridges between a running simulation and the outside of its process: clients of other processes, and a viewer window.

A bridge is polled between two steps. It passes commands on in the same way as a caller in the process would.
A bridge never changes the physics by its presence. It opens no network port unless the user requests one.
"""
