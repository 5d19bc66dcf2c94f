"""What a report says no more once another one is written in its place."""

from __future__ import annotations

import json
from collections import Counter
from pathlib import Path

from .comparison import Comparison
from .wording import listed, packings


def replaced_by(comparison: Comparison, folder: Path) -> str | None:
    """A sentence where the report in `folder` rests on runs that the `comparison` lacks."""
    if not (folder / "report.json").is_file():
        return None
    try:
        before = json.loads((folder / "report.json").read_bytes())
        runs = {(run["engine"], run["seed"], run["twin"]) for run in before["runs"]}
        engines = [str(engine) for engine in before["engines"]]
    except (OSError, LookupError, ValueError, TypeError):
        return None
    if runs <= comparison.ensemble.manifests.keys():
        return None
    runs_each = Counter((engine, seed) for engine, seed, _ in runs).values()
    counted = packings(len({seed for _, seed, _ in runs}), list(runs_each))
    return (
        f"It replaces one of {counted} of {listed(engines)}, whose runs are all kept: the command that made that one makes "
        "it anew. To have both, choose another folder with --out."
    )
