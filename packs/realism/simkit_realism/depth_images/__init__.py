"""Helpers of the artefacts of depth images: random images, laws of depth, angles of surfaces."""
