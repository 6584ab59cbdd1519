"""Faults in the MuJoCo model, of a turn or of a ride."""

from typing import Any, TypeAlias

Steps: TypeAlias = dict[str, Any]  # step of a pipeline or of a RideCase -> what takes its place


def in_model(kind: str, name: str = "", **changes: Any) -> Steps:
    """Change attributes of the elements of a kind ("bodies", "joints", ...), of all or of the one with this name.

    changes: a new value, or a function of the old one. The kind "option" and "compiler" are elements themselves.
    """

    def edit(_: object, spec: Any) -> None:
        elements = getattr(spec, kind)
        for element in elements if hasattr(elements, "__len__") else [elements]:
            for attribute, new in changes.items() if name in ("", getattr(element, "name", "")) else ():
                setattr(element, attribute, new(getattr(element, attribute)) if callable(new) else new)

    return {"edit_model": edit}
