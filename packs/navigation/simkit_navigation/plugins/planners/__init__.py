"""Planners and smoothers of Nav2, with the searches in a costmap."""
