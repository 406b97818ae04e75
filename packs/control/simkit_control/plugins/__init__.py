"""Plugins of the pack for control."""
