"""Text from outside, such as the name of a file, made fit to be shown."""


def printable(text: str) -> str:
    r"""The text with what has no picture of its own (control, direction, undecodable bytes) as escapes such as \x1b.

    The result can be printed, drawn, encoded as UTF-8 and stand in XML.
    """
    return "".join(letter if letter.isprintable() else letter.encode("unicode_escape").decode() for letter in text)


def typeset(text: str) -> str:
    """A number as a page sets it: with a true minus, and one sign for +-."""
    return text.replace("+-", "\N{PLUS-MINUS SIGN}").replace("-", "\N{MINUS SIGN}")
