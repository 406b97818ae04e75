"""Plugins that publish and save occupancy maps."""
