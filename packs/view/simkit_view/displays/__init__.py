"""Displays: messages such as paths, markers and maps, drawn in the scene where their frames are.

A `Display` takes the messages of one topic and draws a `Drawing`, which consists of the few shapes that the page knows.
The same displays serve a running simulation (`view/topic_display.py`) and a bag (`view/recorded_displays.py`).
"""
