"""Measures of a topic: functions in the modules of this folder, each for the types of messages that it names."""
