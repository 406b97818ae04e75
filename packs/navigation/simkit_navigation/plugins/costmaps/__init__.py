"""Costmaps of Nav2, with their layers and filters."""
