"""A design and its motion: dimensions, kinematics, whether it turns, masses and loads of its bodies, riders."""
