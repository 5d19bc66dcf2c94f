"""An engine that is not ours: a program that keeps the contract of docs/own_engine.md, described by its user.

A TOML file becomes one (engine_file.py). A Python class becomes one by deriving from External: of its four methods
`version` and `command` are to be written, `write_input` and `read_output` only where the contract's files are not what
the program reads and writes.
"""

from __future__ import annotations

import hashlib
import shutil
from collections.abc import Mapping, Sequence
from pathlib import Path

from .case import Case
from .contract import Columns, read_contract
from .dataset import Dataset
from .engine import INPUTS, OUTPUT, Engine, EngineNotFound
from .packing import Packing


class External(Engine):
    """A user's code. `source` is the file that describes it; paths of the description start from its folder."""

    files: Sequence[
        str
    ] = ()  # beside `source`: copied into every run's inputs/, part of the run's name
    columns: Mapping[
        str, Columns
    ] = {}  # of its tables, where they are not as the contract has them
    scheme: Mapping[str, str] = {}  # as in a case's [scheme]: the native scheme whose law it has
    twin_limit_m: float | None = (
        None  # how far it may be from that scheme on the ladder; None: not compared
    )
    difference: Sequence[Mapping] = ()  # as [[difference]] of a case, with the key `case`
    samples_file = f"{OUTPUT}/resistance.csv"
    kept_output = ("run.json",)
    cost_s = 1e-5  # generous: a code that is slower is ended only after twenty times that
    declined_status = (
        77  # as in automake: it cannot run this case faithfully; its last line says why
    )

    def __init__(self, source: Path):
        self.source = source.resolve()

    @property
    def description(self) -> str:
        """As `attach` takes it, in any folder."""
        own_class = f":{type(self).__name__}" if self.source.suffix == ".py" else ""
        return f"{self.source}{own_class}"

    def executable(self) -> str:
        """`program` beside `source` where it names a path, else on the PATH."""
        beside = self.source.parent / self.program
        found = shutil.which(str(beside) if "/" in self.program else self.program)
        if not found:
            where = f"{beside} is not there" if "/" in self.program else "it is not on the PATH"
            raise EngineNotFound(f"{self.name}: its program {self.program} cannot be run: {where}")
        return found

    @property
    def by_hand(self) -> str:
        """A sentence for README.txt."""
        return f"{self.program} is as {self.source.name} names it." if "/" in self.program else ""

    def digest(self) -> str:
        """Of its description, its program and its files: whoever builds it anew has it run anew."""
        content = hashlib.sha256()
        for path in (self.source, Path(self.executable()), *map(self._beside, self.files)):
            content.update(hashlib.sha256(path.read_bytes()).digest())
        return content.hexdigest()

    def lines_before_bar(self, case: Case) -> int:
        return 1  # the title

    def complaint(self, log: str) -> str | None:
        lines = [line.strip() for line in log.splitlines() if line.strip()]
        return lines[-1] if lines else None

    def write_input(self, case: Case, packing: Packing, run_dir: Path) -> None:
        """Its own files; case and packing are there already."""
        for name in self.files:
            shutil.copyfile(self._beside(name), run_dir / INPUTS / Path(name).name)

    def read_output(self, case: Case, packing: Packing, run_dir: Path, manifest: dict) -> Dataset:
        return read_contract(self.name, self.columns, case, packing, run_dir / OUTPUT, manifest)

    def copy_to(self, folder: Path) -> None:
        """Its description and its files, into the new `folder`."""
        for name in (self.source.name, *self.files):
            place = folder / name
            place.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(self._beside(name), place)

    def _beside(self, name: str) -> Path:
        path = self.source.parent / name
        if not path.is_file():
            raise EngineNotFound(
                f"{self.name}: {path}, which {self.source.name} names, is not a file"
            )
        return path
