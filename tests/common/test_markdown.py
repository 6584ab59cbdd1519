"""A table as Markdown and as records."""

from fes_mj.common.markdown import Table


def test_markdown() -> None:
    table = Table("Title", {"design": "", "power, W": ".2f"}, [("D1", 31.114), ("R2", None)], "Note.")
    lines = ["| design | power, W |", "| ------ | -------: |", "| D1     |    31.11 |", "| R2     |        - |"]
    assert table.markdown() == "\n".join(["## Title", "", *lines, "", "Note.", ""])
    assert table.records()[0] == {"design": "D1", "power, W": 31.114}
