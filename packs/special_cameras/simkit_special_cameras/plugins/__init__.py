"""Plugins of cameras and of what only cameras see."""
