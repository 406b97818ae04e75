"""The step loop over MuJoCo: clock, scheduler, physics, sleep, random streams, plugin faults and snapshots."""
