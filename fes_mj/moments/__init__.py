"""Joint moments over crank angle, their sources and errors, and the map that makes them moments of joint angles."""
