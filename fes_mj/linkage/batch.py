"""Batches of designs: one Design whose numbers are arrays of shape (designs, 1)."""

from collections.abc import Iterator
from dataclasses import fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fes_mj.linkage.design import Design


def batch_size(design: Design) -> int:
    """Number of designs in a batch; 1 for a single design."""
    return max((len(value) for _, _, value in _arrays(design)), default=1)


def take(design: Design, rows: Any) -> Design:
    """The designs of a batch at `rows` (an index array, a mask or a slice), as a batch; a single design is itself."""
    changes: dict[str, dict[str, Any]] = {"linkage": {}, "rider": {}}
    for owner, name, value in _arrays(design):
        changes[owner][name] = value[rows]
    return design.changed(**changes)


def single(design: Design, row: int) -> Design:
    """One design of a batch, with plain numbers."""
    changes: dict[str, dict[str, Any]] = {"linkage": {}, "rider": {}}
    for owner, name, value in _arrays(design):
        changes[owner][name] = value[row, 0].item()
    return design.changed(**changes)


def _arrays(design: Design) -> Iterator[tuple[str, str, NDArray[Any]]]:
    for owner in ("linkage", "rider"):
        part = getattr(design, owner)
        for field in fields(part):
            value = getattr(part, field.name)
            if isinstance(value, np.ndarray):
                yield owner, field.name, value
