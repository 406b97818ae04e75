"""Step loop over MuJoCo: clock, scheduler, physics, sleep, random streams, plugin faults and snapshots.

- Input: a compiled world, commands that wait for the next step, and writes to the state between two steps.
- Output: states at ticks, due tasks of sensors and plugins, snapshots, and the error of a diverged simulation.
- Not known here: names of topics, kinds of sensors and plugins, and files.
"""
