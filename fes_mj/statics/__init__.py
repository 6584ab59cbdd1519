"""The quasi-static turn of a design, its batch version, and what both say: power, reactions, what has no data."""
