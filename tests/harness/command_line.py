"""The real command line, as users call it, on a case of theirs."""

import os
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
REFERENCE = ROOT / "reference_cases" / "bar_penetration.toml"


def crossdem(*arguments, cwd=None, timeout=240, **environment):
    """Runs ./crossdem to its end; text of both streams and the exit code in the result."""
    return subprocess.run(
        [ROOT / "crossdem", *arguments],
        cwd=cwd,
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        timeout=timeout,
    )
