"""Writers of files: scenes and compiled worlds as SDF, MJCF, self-contained folders, plain data or corrected files.

Files are written completely or not at all. No writer changes its input.
"""
