"""Discovery of plugins: find the class of a plugin, create an instance and attach the instance to an entity.

A plugin is described by a `ScenePlugin` from a file, or is an object created in Python. The instance is attached to a
world, a model, a visual or a sensor. If that is not possible, a diagnostic states the reason. Code of a user runs only
if it is installed or explicitly allowed.
"""
