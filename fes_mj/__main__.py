"""`python -m fes_mj` is the fes_mj command."""

from fes_mj.cli import main

if __name__ == "__main__":  # the page's processes import this module as one of another name
    main()
