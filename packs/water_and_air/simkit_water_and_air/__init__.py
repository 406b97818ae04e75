"""Pack for water and air: buoyancy, waves, wind, wings, rotors, thrusters, and autopilots that fly vehicles."""
