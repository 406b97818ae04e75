"""The step loop over MuJoCo: clock, scheduler, physics, sleep, random streams, plugin faults and snapshots.

What enters: a compiled world, commands that wait for the next step, and writes to the state between two steps. What
leaves: states at ticks, due tasks of sensors and plugins, snapshots, and the error of a physics that diverged. What
never: names of topics or kinds of sensors and plugins, and files.
"""
