"""How results show themselves: in a line, without their arrays."""


class Brief:
    """A result whose repr is its class and what `brief` says of it; a dataclass needs repr=False to inherit it."""

    @property
    def brief(self) -> str:
        """What it is of and what came out."""
        raise NotImplementedError

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.brief}>"
