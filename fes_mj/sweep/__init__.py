"""Many designs, riders, cadences and moments, evaluated in chunks that a kill does not lose."""
