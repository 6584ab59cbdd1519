"""MuJoCo against the project's own mechanics: a turn at constant cadence, and a ride."""
