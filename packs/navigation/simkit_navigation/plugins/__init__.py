"""Plugins of the pack for navigation."""
