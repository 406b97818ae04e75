"""Contact forces between bodies.

- Input: MuJoCo's model and data with contacts and velocities, and the requests of plugins for wheels and belts.
- Output: corrected references, tangents and coefficients of contacts, and the contacts between the collisions of a
  file. It also decides whether the next steps need the contact law or speculative contacts.
- Not known here: the clock, plugins, messages, and anything that advances the state.
"""
