"""What helps whoever writes plugins: the catalogue behind `simkit plugin`, skeletons, reloading while a run goes on.

A class, a world or a file enters; facts, Python text or a new instance leaves. Nothing here is loaded by a run, except
to reload a plugin whose file has changed.
"""
