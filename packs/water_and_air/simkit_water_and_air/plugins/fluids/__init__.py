"""Forces of air and water on links: wind, lift and drag, and buoyancy.

The modules compute forces from the poses and velocities of links. The package also contains the wind and wing plugins
of Gazebo and Gazebo Classic, such as `WindEffects` and `LiftDrag`. No fluid is simulated: velocity and density of the
fluid are prescribed functions of position and time.
"""
