"""Sockets of a running simulation and the clients that talk to it from other processes of the same user."""
