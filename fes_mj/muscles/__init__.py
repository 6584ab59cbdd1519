"""Stimulated muscles: lengths, force, activation, what is known of a rider's, and when it is best to stimulate them."""
