"""The MuJoCo model of legs and linkage, the bench that runs it, and the files other tools read."""
