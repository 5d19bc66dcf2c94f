"""The tables of a recorded ensemble as text: CSV with the shortest digits that read back the same, and JSON lines."""

from __future__ import annotations

import gzip
import io
import json

import numpy as np
import pandas as pd

from crossdem.adapters.packing import COLUMNS

from .ensemble import RUN

# Of a field of displacements [m]: a ten-thousandth of the 0.1 mm that anything in it is read to.
FIELD_DIGITS = 8
# Names one thing, so that the manifests of a record can be read side by side.
NOT_KEPT = ("schema_version", "case_name", "command")


def compressed(text: str) -> bytes:
    """The same bytes for the same text, whenever they are made."""
    return gzip.compress(text.encode(), compresslevel=9, mtime=0)


def expanded(content: bytes) -> str:
    return gzip.decompress(content).decode()


def endpoints_text(table: pd.DataFrame) -> str:
    return table.to_csv()


def endpoints_of(text: str) -> pd.DataFrame:
    return _read(text)


def profiles_text(table: pd.DataFrame) -> str:
    return table.to_csv()


def profiles_of(text: str) -> pd.DataFrame:
    table = _read(text)
    table.columns = table.columns.astype(float).rename("depth_m")
    return table


def fields_text(table: pd.DataFrame) -> str:
    """A column "x 0.005 0.015" holds the x component in the cell with this middle (x_m, y_m)."""
    named = table.set_axis([f"{c} {x_m!r} {y_m!r}" for c, x_m, y_m in table.columns], axis=1)
    return named.to_csv(float_format=f"%.{FIELD_DIGITS}f")


def fields_of(text: str) -> pd.DataFrame:
    table = _read(text)
    cells = (name.split() for name in table.columns)
    columns = [(component, float(x_m), float(y_m)) for component, x_m, y_m in cells]
    return table.set_axis(
        pd.MultiIndex.from_tuples(columns, names=["component", "x_m", "y_m"]), axis=1
    )


def runs_text(manifests: dict[tuple[str, int, int], dict]) -> str:
    """A line for each run."""
    kept = (
        {key: value for key, value in manifest.items() if key not in NOT_KEPT}
        for manifest in manifests.values()
    )
    lines = ",\n".join(json.dumps(manifest, ensure_ascii=False) for manifest in kept)
    return f"[\n{lines}\n]\n"


def runs_of(text: str) -> dict[tuple[str, int, int], dict]:
    return {tuple(manifest[key] for key in RUN): manifest for manifest in json.loads(text)}


def packings_text(tables: dict[int, str]) -> str:
    """The packing.csv of each seed, each line as it is, after the seed."""
    lines = [f"seed,{','.join(COLUMNS)}\n"]
    for seed, text in sorted(tables.items()):
        lines += [f"{seed},{line}" for line in text.splitlines(keepends=True)[1:]]
    return "".join(lines)


def packings_of(text: str) -> dict[int, str]:
    """By seed, the packing.csv to the byte."""
    header, *lines = text.splitlines(keepends=True)
    tables: dict[int, list[str]] = {}
    for line in lines:
        seed, row = line.split(",", 1)
        tables.setdefault(int(seed), [header.split(",", 1)[1]]).append(row)
    return {seed: "".join(rows) for seed, rows in tables.items()}


def _read(text: str) -> pd.DataFrame:
    table = pd.read_csv(io.StringIO(text), float_precision="round_trip")
    # A column that is empty throughout is one of numbers, too.
    return table.set_index(RUN).astype(np.float64)
