"""Plugins of the pack for robots."""
