"""Finding and calling the program `crossdem-solver`."""

import hashlib
import os
import shutil
import subprocess
from pathlib import Path

from .process import bound_to_us

# The solver's exit status where a motion is not finite, leaves the box, explodes or does not settle.
BEYOND_REASON = 3
_IN_CHECKOUT = Path(__file__).resolve().parent.parent / "build/release/solver/crossdem-solver"


class SolverError(Exception):
    """crossdem-solver is missing, or ended in a way that is no fault of its input."""


def find_solver() -> Path:
    """The program named by CROSSDEM_SOLVER, else the one built in this checkout, else the one on PATH."""
    named = os.environ.get("CROSSDEM_SOLVER")
    found = named or (_IN_CHECKOUT if _IN_CHECKOUT.exists() else shutil.which("crossdem-solver"))
    if found and os.access(found, os.X_OK) and Path(found).is_file():
        return Path(found).resolve()
    if named:
        raise SolverError(f"CROSSDEM_SOLVER={named} is not a program; unset it or correct it")
    raise SolverError("crossdem-solver is not built; run scripts/quickstart, which builds it")


def solver_sha256() -> str:
    """Of the program itself [hex]: two builds that differ in a bit are two solvers. Raises SolverError."""
    return hashlib.sha256(find_solver().read_bytes()).hexdigest()


def call_solver(arguments: list[str], stdin: bytes = b"") -> subprocess.CompletedProcess:
    """Runs the solver to its end, or to ours. Status 2 (bad input) is for the caller; any other but 0 is a SolverError."""
    try:
        command = [*bound_to_us(), find_solver(), *arguments]
        done = subprocess.run(command, input=stdin, capture_output=True)
    except OSError as error:
        raise SolverError(f"crossdem-solver cannot be started: {error.strerror}") from error
    if done.returncode in (0, 2):
        return done
    said = messages(done.stderr)
    ending = f"crossdem-solver {arguments[0]} ended with status {done.returncode}"
    raise SolverError(": ".join([ending, *said[-1:]]))


def messages(stderr: bytes) -> list[str]:
    """The non-empty lines a program wrote for people."""
    return [line for line in stderr.decode(errors="replace").splitlines() if line.strip()]
