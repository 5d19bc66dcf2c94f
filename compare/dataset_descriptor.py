"""datapackage.json, a Frictionless Data Package: size, hash and columns of every file."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from fnmatch import fnmatchcase

from .dataset_columns import Column
from .dataset_kinds import format_of, media_type

DESCRIPTOR = "datapackage.json"


def data_package(
    about: Mapping[str, str],
    files: Mapping[str, tuple[int, str]],
    columns: Mapping[str, Sequence[Column]],
) -> dict:
    """datapackage.json over `files`: size [bytes] and SHA-256 [hex] by path. `columns`: as dataset_columns.tables."""
    return {
        "profile": "data-package",
        "name": re.sub(r"[^-a-z0-9._/]", "-", about["name"].lower()),
        "title": about["title"],
        "description": about["description"],
        "version": about["version"],
        "created": f"{about['date']}T00:00:00Z",
        "licenses": [
            {
                "name": "CC-BY-4.0",
                "title": "Creative Commons Attribution 4.0 International",
                "path": "https://creativecommons.org/licenses/by/4.0/",
            }
        ],
        "contributors": [{"title": name, "role": "author"} for name in about["authors"]],
        "resources": [_resource(name, *facts, columns) for name, facts in files.items()],
    }


def _resource(
    name: str, size: int, digest: str, columns: Mapping[str, Sequence[Column]]
) -> dict[str, object]:
    entry: dict[str, object] = {
        "name": re.sub(r"[^-a-z0-9._/]", "-", name.lower()),
        "path": name,
        "format": format_of(name),
        "mediatype": media_type(name),
        "bytes": size,
        "hash": f"sha256:{digest}",
    }
    found = [table for pattern, table in columns.items() if fnmatchcase(name, pattern)]
    if found and name.endswith(".csv"):
        fields = [
            {"name": one.name, "type": one.type, "description": _described(one)} for one in found[0]
        ]
        entry |= {"profile": "tabular-data-resource", "encoding": "utf-8"}
        entry["schema"] = {"fields": fields}
    return entry


def _described(column: Column) -> str:
    unit = f" [{column.unit}]" if column.unit not in ("", "1") else ""
    return column.definition + unit
