"""Damaged evidence: no command reads a user's evidence, but who edits the file deserves a message."""

from pathlib import Path

from fes_mj.errors import InputError
from fes_mj.paper.evidence import load_evidence
from fes_mj.paper.printed import DATA
from fes_mj.paper.reconstruction import reconstruct
from tests.cli.test_fuzz import broken


def test_broken_evidence(tmp_path: Path) -> None:
    path, messages = tmp_path / "fuzzed.toml", []
    for text in broken(5, (DATA / "evidence.toml").read_text(), 60):
        path.write_text(text, encoding="utf-8", errors="surrogatepass")
        try:
            reconstruct(load_evidence(path))
        except InputError as error:
            messages.append(str(error))
    assert len(messages) > 30
    assert max(map(len, messages)) < 4000
