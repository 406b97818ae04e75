"""What air and water do to links: wind, lift and drag, buoyancy. Shared by Gazebo's and Classic's plugins."""
