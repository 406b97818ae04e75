"""Shared code of several commands: options, output, completion, keyboard, and sources of topics.

No module here is a command or imports one. No module imports MuJoCo, NumPy or rosbags before a command needs them.
"""
