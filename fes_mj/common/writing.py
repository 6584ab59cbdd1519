"""All writing of files: whole or not at all, and never over an input."""

import json
import math
import os
import sys
from collections.abc import Collection, Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from functools import lru_cache
from pathlib import Path
from typing import Any

from fes_mj.common.errors import InputError

if sys.platform != "win32":
    import fcntl

TEMPORARY = ".fes_mj-"  # how the names of temporary files begin
# In a folder: SHA-256, a line each, of what fes_mj wrote there without having been named.
FOLDER_RECORD = ".fes_mj.sha256"
PICTURES = (".png", ".svg")
PAGES = (".svg", ".pdf", ".png")


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
    require_folder(folder if folder.exists() else folder.parent, what)
    try:
        folder.mkdir(exist_ok=True)
    except (OSError, ValueError) as error:  # ValueError: a name that no file can have
        raise InputError(f"{folder}: cannot be made: {getattr(error, 'strerror', error)}") from None


@contextmanager
def made_folder(folder: Path, what: str) -> Iterator[None]:
    """As make_folder; one that was made goes again if what follows is refused or fails and left nothing in it."""
    is_new = not folder.exists()
    make_folder(folder, what)
    try:
        yield
    except BaseException:
        with suppress(OSError):  # there is something in it
            if is_new:
                folder.rmdir()
        raise


def require_writable(
    path: Path | None, what: str, suffixes: str | tuple[str, ...] = "", inputs: Iterable[Path] = ()
) -> None:
    """Raise InputError unless a file that the user named, if any, can be put at `path` and its name ends as it must.

    A file that is there is replaced, but never one of `inputs`, under whatever name.
    """
    if path is None:
        return
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
    allowed = (suffixes,) if isinstance(suffixes, str) else suffixes
    if suffixes and path.suffix.lower() not in allowed:
        raise InputError(f"{path}: cannot write {what}: the name must end in {' or '.join(allowed)}")
    for file in inputs:
        if path.exists() and file.exists() and path.samefile(file):
            raise InputError(
                f"{path}: cannot write {what}: it would replace {file}, which this command reads; "
                "give the output another name or folder"
            )


def require_replaceable(paths: Iterable[Path], what: str, inputs: Collection[Path] = ()) -> None:
    """As require_writable, for files that the user did not name but that are written beside one or into a folder.

    One that is there is replaced only while it is as fes_mj wrote it: its SHA-256 stands in the folder's FOLDER_RECORD.
    """
    for path in paths:
        require_writable(path, what, inputs=inputs)
        if path.exists():
            with _named(path, "read"):
                ours = _digest(path.read_bytes()) in _recorded(path.parent)
            if not ours:
                raise InputError(
                    f"{path}: cannot write {what}: a file has this name that fes_mj did not write, or that was changed "
                    "since; move it, or give the output another name or folder"
                )


def require_results(folder: Path, names: Iterable[str | Path], inputs: Collection[Path] = ()) -> list[Path]:
    """Where a set of files goes in a folder that is made if its parent exists; refused as by the others."""
    require_folder(folder if folder.exists() else folder.parent, "the results")
    paths = [folder / name for name in names]
    require_replaceable((path for path in paths if path.parent.exists()), "the results", inputs)
    return paths


def write_results(contents: Mapping[Path, str | bytes]) -> None:
    """Write the set into its folder, and folders in it; those that were made for it do not stay without it."""
    with ExitStack() as stack:
        for folder in sorted({path.parent for path in contents}):
            stack.enter_context(made_folder(folder, "the results"))
        write_files(contents, unnamed=contents.keys())


def _digest(content: bytes) -> str:
    import hashlib

    return hashlib.sha256(content).hexdigest()


def _recorded(folder: Path) -> list[str]:
    """SHA-256 of what fes_mj wrote in a folder without having been given its name."""
    record = folder / FOLDER_RECORD
    return record.read_text(errors="replace").split() if record.is_file() else []


@contextmanager
def _named(path: Path, deed: str = "written") -> Iterator[None]:
    """What the system refuses becomes an InputError that names the file."""
    try:
        yield
    except BrokenPipeError:  # a stream's, not a file's
        raise
    except OSError as error:
        raise InputError(f"{path}: cannot be {deed}: {error.strerror or error}") from None


@contextmanager
def temporary_beside(path: Path) -> Iterator[Path]:
    """An empty temporary file in the folder of `path`, with its suffix; gone afterwards, whenever a signal comes.

    Its lock is held meanwhile, by which others tell it from what a killed run left.
    """
    _tidy(path.parent)
    temporary = path.with_name(f"{TEMPORARY}{os.urandom(8).hex()}{path.suffix}")
    with _named(path):
        try:
            with temporary.open("xb") as file:
                if sys.platform == "win32":
                    file.close()  # or nobody else could write it or rename it
                else:
                    with suppress(OSError):  # a file system without locks
                        fcntl.flock(file, fcntl.LOCK_EX)
                yield temporary
        finally:
            temporary.unlink(missing_ok=True)


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Give a temporary path beside `path`; rename it to `path` on success, remove it on any failure.

    Raises InputError for what the system refuses: a full disk, a folder that is gone or cannot be written to.
    """
    with temporary_beside(path) as temporary:
        yield temporary
        temporary.replace(path)


def remove_leftovers(folder: Path) -> None:
    """Remove the temporary files that killed runs left in a folder, none of a run that lives."""
    if sys.platform != "win32":
        for path in folder.glob(f"{TEMPORARY}*"):
            with suppress(OSError), path.open("r+b") as file:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
                path.unlink()


_tidy = lru_cache(maxsize=64)(remove_leftovers)  # once for all that a run writes there


def write_text(path: Path, text: str) -> None:
    """Write a whole text file or nothing. Raises InputError as replacing."""
    with replacing(path) as temporary:
        temporary.write_bytes(text.encode())


def write_files(contents: Mapping[Path, str | bytes], unnamed: Collection[Path] = ()) -> None:
    """Write files that belong together: all appear whole, or none does and what stood there still stands.

    unnamed: those of them whose names fes_mj chose; they go into their folders' FOLDER_RECORD, by which
    require_replaceable knows them again. Raises InputError as replacing.
    """
    data = {path: content.encode() if isinstance(content, str) else content for path, content in contents.items()}
    records = {}
    for folder in {path.parent for path in unnamed}:
        digests = [_digest(data[path]) for path in unnamed if path.parent == folder]
        records[folder / FOLDER_RECORD] = "\n".join(dict.fromkeys([*_recorded(folder), *digests, ""])).encode()
    data = records | data  # should a kill come between, what stands there is known, whether new or old
    with ExitStack() as stack:
        new = {path: stack.enter_context(temporary_beside(path)) for path in data}
        old = {path: stack.enter_context(temporary_beside(path)) for path in data if path.exists()}
        for path, content in data.items():
            with _named(path):
                new[path].write_bytes(content)
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
