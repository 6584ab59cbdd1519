"""Files that a page sends: data, never instructions to open other files; joint moments among them are kept a while."""

import time
from collections.abc import Callable, Collection
from dataclasses import replace
from operator import call
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import Lock
from typing import Any, TypeVar

from fes_mj.common.errors import InputError
from fes_mj.common.reading import Section, is_text
from fes_mj.moments.files import load_moments
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.moments.measurement import measured_files

Loaded = TypeVar("Loaded")
MOST, LONGEST = 32, 12 * 3600.0  # files of all pages that are kept, and s after which one that nobody uses is forgotten
LONGEST_NAME = 200  # bytes; file systems take 255


class Uploads:
    """The joint moments that pages have opened: each page has its own, under names that never change their meaning."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock, self._lock = clock, Lock()
        self._kept: dict[tuple[str, str], tuple[float, JointMoments]] = {}  # page and name -> last use; oldest first

    def of(self, page: str) -> dict[str, JointMoments]:
        """What a page has opened, by name."""
        with self._lock:
            now = self._clock()
            self._kept = {key: kept for key, kept in self._kept.items() if now - kept[0] <= LONGEST}
            of_page = {key: self._kept.pop(key) for key in [*self._kept] if key[0] == page}
            self._kept |= {key: (now, moments) for key, (_, moments) in of_page.items()}
        return {name: moments for (_, name), (_, moments) in of_page.items()}

    def add(self, page: str, moments: JointMoments, taken: Collection[str]) -> str:
        """Keep moments for a page under their name, with a number after it where that is taken; return the name."""
        taken = {*taken, *self.of(page)}
        names = (moments.name, *(f"{moments.name} {number}" for number in range(2, len(taken) + 3)))
        name = next(name for name in names if name not in taken)
        with self._lock:
            self._kept[page, name] = (self._clock(), replace(moments, name=name))
            for key in [*self._kept][:-MOST]:
                del self._kept[key]
        return name


def read_upload(question: Section, load: Callable[[Path], Loaded], reader: Callable[..., Loaded] = call) -> Loaded:
    """What the file in a question holds: its "name", its "text" and, by name, the texts of the files "beside" it.

    They are read as files of this machine are, from a folder that holds nothing else, by reader(load, path).
    Raises InputError as `load`, and for a name that is not a file's own.
    """
    name = question.value("name", None, _is_name, "the name of a file, without a folder")
    text = question.value("text", None, is_text, "the text of the file")
    beside = question.value("beside", {}, _are_files, "names of files, without a folder, and their texts")
    with TemporaryDirectory() as folder:
        for file_name, content in {**beside, name: text}.items():
            (Path(folder) / file_name).write_bytes(content.encode(errors="surrogatepass"))
        try:
            return reader(load, Path(folder) / name)
        except InputError as error:
            raise InputError(str(error).replace(f"{folder}/", "")) from None


def moments_of_bundle(path: Path) -> JointMoments:
    """Joint moments from a file and what it names, which must all lie beside it. Raises InputError as load_moments."""
    bundle = {*path.parent.iterdir()}
    for file in measured_files(path):
        if file not in bundle:
            raise InputError(f"{path}: it names {file.name!r}; choose that file too, and name it without a folder")
    return load_moments(path)


def _is_name(name: Any) -> bool:
    """Whether a text can only be a file in the folder where it is looked for."""
    plain = is_text(name) and name.isprintable() and name == Path(name).name and name not in ("", "..")
    return bool(plain and len(name.encode()) <= LONGEST_NAME)


def _are_files(files: Any) -> bool:
    return isinstance(files, dict) and all(_is_name(name) and is_text(text) for name, text in files.items())
