"""From a fault to a program: a copy of the solver's sources, and a build of it that is brought up to date."""

from __future__ import annotations

import re
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class Fault:
    """One text of the sources, which stands there once, and the wrong one in its place."""

    name: str
    kind: str
    file: str  # below solver/src
    right: str
    wrong: str

    @property
    def slug(self) -> str:
        """The name as that of a file."""
        signs = self.name.replace("+", "plus ").replace(" -", " minus ")
        return re.sub(r"[^a-z0-9]+", "-", signs.lower()).strip("-")


# Faults are seeded in the plain steps, so that the copy makes its steps by them: the batches, which users' runs are made
# by, are held against the plain steps bit for bit (tests/solver/batch_test.cpp).
PLAIN = {
    "BatchedStepper<PaperBatches<PaperScheme>>>(setup, world)": (
        "PaperStepper<PaperScheme>>(PaperScheme{}, choice.readings, world)"
    ),
    "BatchedStepper<PaperBatches<RollingScheme>>>(setup, world)": (
        "PaperStepper<RollingScheme>>(RollingScheme{}, choice.readings, world)"
    ),
    "BatchedStepper<LiggghtsBatches<": "ConventionalStepper<LiggghtsScheme<",
    "BatchedStepper<YadeBatches<": "ConventionalStepper<YadeScheme<",
}


class Workshop:
    """A copy of the solver's sources in `folder`, a build of it, and every program that was built there, now or before."""

    def __init__(self, folder: Path):
        self.sources, self.build = folder / "sources", folder / "build"
        self.programs = folder / "programs"
        self.programs.mkdir(parents=True, exist_ok=True)
        # Whatever was left half changed is sound again, and whatever is sound keeps its date.
        shutil.copytree(
            ROOT / "solver",
            self.sources / "solver",
            copy_function=_copy_if_other,
            dirs_exist_ok=True,
        )
        _copy_if_other(ROOT / "CMakeLists.txt", self.sources / "CMakeLists.txt")
        schemes = self.sources / "solver" / "src" / "scheme.cpp"
        text = schemes.read_text()
        for batches, plain in PLAIN.items():
            text = text.replace(batches, plain)
        assert "BatchedStepper" not in text, "scheme.cpp steps in batches that have no PLAIN steps"
        schemes.write_text(text)
        flags = ["-DBUILD_TESTING=OFF", "-DCMAKE_BUILD_TYPE=None", "-DCMAKE_CXX_FLAGS=-O1"]
        _quietly("cmake", "-S", self.sources, "-B", self.build, *flags)

    def solver(self, fault: Fault | None = None) -> Path:
        """The program with this fault and no other, or the sound one; built once, and then kept."""
        program = self.programs / (fault.slug if fault else "sound")
        if program.exists():
            return program
        if fault is None:
            return self._built(program)
        file = self.sources / "solver" / "src" / fault.file
        sound = file.read_text()
        assert sound.count(fault.right) == 1, f"{fault.file} holds {fault.right!r} not just once"
        try:
            file.write_text(sound.replace(fault.right, fault.wrong))
            return self._built(program)
        finally:
            file.write_text(sound)

    def _built(self, program: Path) -> Path:
        _quietly("cmake", "--build", self.build, "--target", "crossdem-solver", "--parallel", "2")
        return Path(shutil.copy2(self.build / "solver" / "crossdem-solver", program))


def _copy_if_other(source, target) -> None:
    if not Path(target).exists() or Path(source).read_bytes() != Path(target).read_bytes():
        shutil.copyfile(source, target)


def _quietly(*command) -> None:
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
