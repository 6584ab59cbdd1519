"""Joint moments over crank angle, where they come from and how sure they are, and the map that makes them joint angles'."""
