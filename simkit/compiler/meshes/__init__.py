"""Mesh files: read into triangles, made into what collides, and kept in the cache."""
