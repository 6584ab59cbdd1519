"""`fes_mj --install-completion`: by the parser's own command, which takes a while to import."""

from cyclopts.completion.install import create_install_completion_command

from fes_mj.cli.app import app

install_completion = create_install_completion_command(app.install_completion, add_to_startup=True)
