"""Connections to autopilots: protocols, sockets with bounded waits, and channels that move joints."""
