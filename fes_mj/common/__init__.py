"""What every room uses: units and arrays, reading and writing of files, messages, tables, checks and their limits."""
