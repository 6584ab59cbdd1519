"""What searches have found so far, kept beside their design file: a run that was stopped loses nothing and can go on.

Each search is a function of the problem and its own seed. So one that is finished is never done again, and one that
was stopped is done again from its start; whatever happens in between, the end is the same to the last bit.
"""

import dataclasses
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.errors import InputError
from fes_mj.common.provenance import digest
from fes_mj.common.reading import read_json
from fes_mj.common.text import printable
from fes_mj.common.writing import TEMPORARY, json_text, make_folder, write_text
from fes_mj.linkage.design_file import design_toml
from fes_mj.optimization.problem import Problem
from fes_mj.optimization.search import SearchResult

_UNFINISHED = "\nBest so far, of a search that is not finished."


class Findings:
    """The design file `out`, kept at the best design from the first feasible one on, and BEST.search beside it.

    In the folder BEST.search: recipe.json, all that the outcome depends on; best-N.json, the best of search N where it
    was the best of all; search-N.json, the result of a finished search. A design file that was there before is replaced
    only by the final one; until then the best is BEST.search/best.toml. Several processes may call `improve` at once.
    """

    def __init__(self, out: Path, origin: str, recipe: dict[str, Any]) -> None:
        """origin: comment of the design file. recipe: what the outcome depends on beside the problem, as JSON."""
        self.out, self.folder, self.name = out, out.with_suffix(".search"), printable(out.stem)
        self._origin, self._recipe = origin, recipe
        self._problem: Problem | None = None
        self._known = -np.inf  # merit of the best design, as far as this process knows
        self.so_far = out

    @contextmanager
    def searching(self, problem: Problem) -> Iterator[None]:
        """Claim the folder for searches of a problem; it is gone afterwards if they found nothing."""
        self._problem, self._recipe = problem, self._recipe | {"problem": digest(problem)}
        self._claim()
        try:
            yield
        finally:
            if not self.best:
                self.remove()

    def _claim(self) -> None:
        """Make the folder, or go on with what is in it. Raises InputError if that belongs to another search."""
        recipe, earlier = self.folder / "recipe.json", self.out.exists()
        make_folder(self.folder, "what is found")
        if recipe.exists():
            theirs = read_json(recipe, "record of a search")
            different = [key for key, value in self._recipe.items() if theirs.get(key) != value]
            if different and self.best:
                raise InputError(
                    f"{self.folder}: this folder holds what another search has found (different: "
                    f"{', '.join(different)}), which is not finished; its command was: {theirs.get('command')}. "
                    "Run that to its end, or delete the folder, or give another -o"
                )
            earlier = earlier if different else bool(theirs.get("earlier"))
        elif any(not path.name.startswith(".") for path in self.folder.iterdir()):
            raise InputError(
                f"{self.folder}: searches are recorded in this folder; move what is in it, or give another -o"
            )
        write_text(recipe, json_text(self._recipe | {"earlier": earlier}))
        self.so_far = self.folder / "best.toml" if earlier else self.out
        if self.best:
            self._known = self.best[0]
            self._publish(self.best[1], "resumed")

    @property
    def best(self) -> tuple[float, list[float]] | None:
        """Merit and variables of the best design so far; None before there is any."""
        return max((_read(path, "merit", "x") for path in self.folder.glob("best-*.json")), default=None)

    @property
    def power(self) -> float | None:
        """Mean crank power of one leg in the best design so far, W; None before there is any."""
        if self._problem is None or not (best := self.best):
            return None
        return float(self._problem.evaluate(np.array([best[1]])).power[0, 0])

    def improve(self, search: int, x: FloatArray, merit: float) -> None:
        """Keep a feasible design, shape (10,), found by a search, if it is the best of all."""
        if merit <= self._known:
            return
        write_text(self.folder / f"best-{search}.json", json_text({"merit": merit, "x": x}))
        published = None
        # another process may put its design in place between our looking and our writing; the last to write looks again
        while (best := self.best) and best != published:
            self._publish(best[1], str(search))
            self._known, published = best[0], best

    def finish(self, search: int, result: SearchResult) -> None:
        """Keep the result of a finished search."""
        self.improve(search, result.x, result.merit)
        write_text(self.folder / f"search-{search}.json", json_text(vars(result)))

    def finished(self) -> dict[int, SearchResult]:
        """Results of the finished searches, by their numbers."""
        names = [field.name for field in dataclasses.fields(SearchResult)]
        results = {}
        for path in self.folder.glob("search-*.json"):
            x, merit, evaluations, history = _read(path, *names)
            results[int(path.stem.partition("-")[2])] = SearchResult(np.array(x), merit, evaluations, np.array(history))
        return results

    def remove(self) -> None:
        """Remove the folder, as all is finished; the recipe last: after a kill in here the same command goes on."""
        ours = ("search-*.json", "best-*.json", "best-*.toml", "best.toml", f"{TEMPORARY}*", "recipe.json")
        for pattern in ours:
            for path in self.folder.glob(pattern):
                path.unlink(missing_ok=True)
        if not any(self.folder.iterdir()):
            self.folder.rmdir()

    def _publish(self, x: list[float], by: str) -> None:
        assert self._problem
        design = self._problem.design(np.array(x), self.name)
        beside = self.folder / f"best-{by}.toml"
        write_text(beside, design_toml(design, self._origin + _UNFINISHED))
        beside.replace(self.so_far)


def _read(path: Path, *keys: str) -> tuple[Any, ...]:
    content = read_json(path, "record of a search")
    try:
        return tuple(content[key] for key in keys)
    except KeyError:
        raise InputError(f"{path}: this is no record of a search; delete its folder to begin anew") from None
