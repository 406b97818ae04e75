"""Plugins of the pack for water and air."""
