"""Plugins of Open-RMF's rmf_simulation: robots that follow paths, doors and lifts."""
