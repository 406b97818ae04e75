"""Pack actors: people and animals that a script or a plugin moves. Sensors see them, but they have no contacts.

The plugin `ActorMover` converts each `SceneActor` to a static model, and moves the links of this model along the
script. Actors exert no forces and receive none.
"""
