"""Discovery of plugins: find the class of a plugin and attach its instance to an entity.

A plugin is a `ScenePlugin` from a file or an object created in Python. The result is an instance attached to a world, a
model, a visual or a sensor, or else a diagnostic with the reason. Only installed or explicitly allowed code of a user
is executed.
"""
