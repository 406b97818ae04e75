"""Artefacts of sensors, one file each, found by the names of their elements."""
