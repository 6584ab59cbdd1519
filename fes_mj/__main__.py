"""`python -m fes_mj` is the fes_mj command."""

from fes_mj.cli import main

main()
