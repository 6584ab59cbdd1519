"""The seat for a rider, and who of a population can ride."""
