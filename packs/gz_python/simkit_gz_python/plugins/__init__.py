"""Plugins for systems and messages of gz-sim: systems in Python, and messages in protobuf's text format."""
