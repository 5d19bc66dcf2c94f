"""The texts of a package: README.md, CITATION.cff, columns.csv and provenance.json."""

from __future__ import annotations

import csv
import io
import json
import shlex
from collections.abc import Mapping, Sequence
from fnmatch import fnmatchcase
from pathlib import Path
from string import Template

from .dataset_columns import Column

TEMPLATES = Path(__file__).parent / "templates"
# What tells when and how fast something ran. All other files of two builds from the same versions have the same bytes,
# where the engine's own bits do not vary.
TIMED = (
    "runs/*/manifest.json",
    "runs/*/engine.log",
    "comparison/report.json",
    "CITATION.cff",
    "provenance.json",
    "ro-crate-metadata.json",
    "datapackage.json",
    "SHA256SUMS",
)
# By pattern, who made the files.
MADE_BY = {
    "runs/*/inputs/*": "crossdem, for the engine to read",
    "runs/*": "the run's engine by the command in its manifest.json, read by crossdem",
    "engines/*": "whoever has the code",
    "packings/*": "crossdem-solver pack",
    "*": "crossdem dataset build",
}


def readme(about: Mapping[str, str]) -> str:
    return Template((TEMPLATES / "dataset_readme.md").read_text(encoding="utf-8")).substitute(about)


def license_text() -> str:
    return (TEMPLATES / "CC-BY-4.0.txt").read_text(encoding="utf-8")


def citation(about: Mapping[str, str]) -> str:
    """CITATION.cff 1.2.0; strings of YAML are written as JSON, which YAML 1.2 reads."""
    values = {
        "cff-version": "1.2.0",
        "message": "If you use these data, please cite them with these metadata.",
        "type": "dataset",
        "title": about["title"],
        "abstract": about["description"],
        "version": about["version"],
        "date-released": about["date"],
        "license": "CC-BY-4.0",
        "authors": [{"name": name} for name in about["authors"]],
        "keywords": ["discrete element method", "granular material", "reference data"],
    }
    lines = (f"{key}: {json.dumps(value, ensure_ascii=False)}\n" for key, value in values.items())
    return "".join(lines)


def dictionary(tables: Mapping[str, Sequence[Column]]) -> str:
    """columns.csv."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["files", "name", "unit", "definition"])
    for files, columns in tables.items():
        writer.writerows([files, one.name, one.unit, one.definition] for one in columns)
    return text.getvalue()


def provenance(
    about: Mapping, programs: Sequence[dict], libraries: Mapping[str, str], files: Sequence[str]
) -> dict:
    """provenance.json: versions, the command, what made each of `files`, and which of them vary from build to build."""
    made_by = {
        name: next(who for key, who in MADE_BY.items() if fnmatchcase(name, key)) for name in files
    }
    return {
        "crossdem": about["version"],
        "crossdem_commit": about["commit"],
        "crossdem_solver_sha256": about["solver"],
        "libraries": dict(libraries),
        "command": about["command"],
        "engines": list(programs),
        "vary_from_build_to_build": list(TIMED),
        "made_by": made_by,
    }


def command_of(words: Sequence[object]) -> str:
    return shlex.join(["crossdem", *map(str, words)])


def json_text(value: object) -> str:
    return json.dumps(value, indent=2, ensure_ascii=False, allow_nan=False) + "\n"
