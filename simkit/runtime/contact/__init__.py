"""Forces between bodies in contact.

What enters: MuJoCo's model and data with contacts found and velocities known, and what plugins ask of wheels and belts.
What leaves: corrected references, tangents and coefficients of contacts, the contacts between collisions of the files,
and whether the next steps need the contact law or speculative contacts. What never: the clock, plugins, messages, or
anything that advances the state.
"""
