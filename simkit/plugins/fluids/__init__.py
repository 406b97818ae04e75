"""Forces of air and water on links: wind, lift and drag, and buoyancy.

The modules read poses and velocities of links and return forces. The package also contains the plugins whose Gazebo and
Classic variants differ only in their aliases, such as `WindEffects` and `LiftDrag`. No fluid is simulated: each fluid
is a prescribed field.
"""
