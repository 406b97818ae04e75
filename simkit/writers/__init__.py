"""Writers: scenes and compiled worlds become files again.

A scene, a compiled world or a folder of files enters; SDF, MJCF, a self-contained folder, plain data or a mended file
leaves, whole or not at all. Nothing here changes what it writes.
"""
