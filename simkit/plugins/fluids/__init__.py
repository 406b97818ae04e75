"""What air and water do to links: wind, lift and drag, buoyancy.

Poses and velocities of links enter, forces leave. The plugins that differ only by an alias lie here as well:
`WindEffects`, `LiftDrag` and their twins of Classic. No fluid is simulated: each is a field that is given.
"""
