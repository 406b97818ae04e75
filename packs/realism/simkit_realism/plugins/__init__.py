"""Plugins of sensors with losses and patterns of real devices."""
