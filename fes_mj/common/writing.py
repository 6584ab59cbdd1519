"""All writing of files: whole or not at all, and never over an input."""

import json
import math
import os
from collections.abc import Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

from fes_mj.common.errors import InputError

TEMPORARY = ".fes_mj-"  # how the names of temporary files begin
MARKED = 4096  # bytes: the beginning of a file of ours, which can hold its name twice and escaped


def csv_text(columns: Mapping[str, Any]) -> str:
    """Columns of numbers, shape (rows,) each, as CSV with nine digits."""
    rows = zip(*(getattr(column, "tolist", lambda column=column: column)() for column in columns.values()), strict=True)
    return "\n".join([",".join(columns), *(",".join(f"{value:.9g}" for value in row) for row in rows)]) + "\n"


def require_folder(folder: Path, what: str) -> None:
    """Raise InputError unless `folder` exists and can be written to."""
    if not folder.is_dir():
        state = "is not a folder" if folder.exists() else "does not exist"
        raise InputError(f"{folder}: cannot write {what}: the folder {state}; create it or name another")
    if not os.access(folder, os.W_OK | os.X_OK):
        raise InputError(f"{folder}: cannot write {what}: no permission; name a folder you can write to")


def make_folder(folder: Path, what: str) -> None:
    """Make `folder` in an existing one unless it is there. Raises InputError if that cannot be."""
    if not folder.exists():
        require_folder(folder.parent, what)
        try:
            folder.mkdir()
        except OSError as error:
            raise InputError(f"{folder}: cannot be made: {error.strerror}") from None
    require_folder(folder, what)


def require_writable(path: Path, what: str, suffix: str = "", inputs: Iterable[Path] = ()) -> None:
    """Raise InputError unless a file that the user named can be put at `path` (and its name ends as it must).

    A file that is there is replaced, but never one of `inputs`, under whatever name.
    """
    require_folder(path.parent, what)
    try:
        path.lstat()
    except FileNotFoundError:
        pass
    except OSError as error:
        raise InputError(f"{path}: cannot write {what}: {error.strerror}; give it another name") from None
    except ValueError:  # a NUL in the name, or what the file system cannot spell
        raise InputError(f"{path}: cannot write {what}: no file can have this name") from None
    if path.is_dir():
        raise InputError(f"{path}: cannot write {what}: this is a folder; name a file in it")
    if suffix and path.suffix.lower() != suffix:
        raise InputError(f"{path}: cannot write {what}: the name must end in {suffix}")
    if path.exists():
        for file in inputs:
            if file.exists() and path.samefile(file):
                raise InputError(
                    f"{path}: cannot write {what}: it would replace {file}, which this command reads; "
                    "give the output another name or folder"
                )


def require_replaceable(path: Path, what: str, mark: str, inputs: Iterable[Path] = ()) -> None:
    """As require_writable, for a file that the user did not name but that is written beside one or into a folder.

    A file that is there is replaced only if `mark` is in its first MARKED bytes, as in all that fes_mj writes there.
    """
    require_writable(path, what, inputs=inputs)
    if path.exists():
        with _named(path), path.open("rb") as file:
            ours = mark.encode() in file.read(MARKED)
        if not ours:
            raise InputError(
                f"{path}: cannot write {what}: a file that fes_mj did not write has this name; "
                "move it, or give the output another name or folder"
            )


@contextmanager
def _named(path: Path) -> Iterator[None]:
    """What the system refuses becomes an InputError that names the file."""
    try:
        yield
    except BrokenPipeError:  # a stream's, not a file's
        raise
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror or error}") from None


@contextmanager
def _beside(path: Path) -> Iterator[Path]:
    """An empty temporary file in the folder of `path`, with its suffix; gone afterwards, whenever a signal comes."""
    temporary = path.with_name(f"{TEMPORARY}{os.urandom(8).hex()}{path.suffix}")
    with _named(path):
        try:
            temporary.touch(exist_ok=False)
            yield temporary
        finally:
            temporary.unlink(missing_ok=True)


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Give a temporary path beside `path`; rename it to `path` on success, remove it on any failure.

    Raises InputError for what the system refuses: a full disk, a folder that is gone or cannot be written to.
    """
    with _beside(path) as temporary:
        yield temporary
        temporary.replace(path)


def remove_leftovers(folder: Path) -> None:
    """Remove the temporary files that killed runs left in a folder which is this run's alone."""
    for path in folder.glob(f"{TEMPORARY}*"):
        if path.is_file():
            path.unlink(missing_ok=True)


def write_text(path: Path, text: str) -> None:
    """Write a whole text file or nothing. Raises InputError as replacing."""
    with replacing(path) as temporary:
        temporary.write_bytes(text.encode())


def write_files(contents: Mapping[Path, str | bytes]) -> None:
    """Write files that belong together: all appear whole, or none does and what stood there still stands.

    Raises InputError as replacing.
    """
    with ExitStack() as stack:
        new = {path: stack.enter_context(_beside(path)) for path in contents}
        old = {path: stack.enter_context(_beside(path)) for path in contents if path.exists()}
        for path, content in contents.items():
            with _named(path):
                new[path].write_bytes(content.encode() if isinstance(content, str) else content)
                if path in old:
                    import shutil

                    shutil.copy2(path, old[path])
        try:
            for path, temporary in new.items():
                with _named(path):
                    temporary.replace(path)
        except BaseException:
            for path in (path for path, temporary in new.items() if not temporary.exists()):  # these were renamed
                if path in old:
                    old[path].replace(path)
                else:
                    path.unlink()
            raise


def json_text(content: Mapping[str, Any]) -> str:
    """The object as indented JSON text; arrays become lists, numbers that JSON lacks (NaN, infinity) null."""
    return json.dumps(_plain(content), indent=2, allow_nan=False) + "\n"


def _plain(value: Any) -> Any:
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, Mapping):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
