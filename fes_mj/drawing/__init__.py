"""What a workshop needs of a design that has been sized: drawings and tables."""
