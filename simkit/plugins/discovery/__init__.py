"""Which class stands behind a plugin of a file, and what it hangs on.

A `ScenePlugin`, or a plugin made in Python, enters; an instance, attached to a world, a model, a visual or a sensor,
leaves, or a diagnostic that says why there is none. Nothing of a user runs that is not installed or allowed.
"""
