"""Free riding on a road without MuJoCo: the reduced equation of motion, starts, and when to stimulate."""
