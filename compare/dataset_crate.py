"""ro-crate-metadata.json: RO-Crate 1.1 with the profile Process Run Crate 0.5, in which each run is a CreateAction."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import datetime, timedelta
from urllib.parse import quote

from .dataset_kinds import media_type

METADATA = "ro-crate-metadata.json"
SPECIFICATION = "https://w3id.org/ro/crate/1.1"
PROFILE = "https://w3id.org/ro/wfrun/process/0.5"
LICENSE = "https://spdx.org/licenses/CC-BY-4.0"


def crate(
    about: Mapping[str, str], files: Mapping[str, int | None], runs: Mapping[str, dict]
) -> dict:
    """Of a package: `about` as in dataset_documents, `files` with their sizes [bytes] (None: not known yet), the manifest
    of each run by its folder."""
    engines = {_engine_id(manifest): manifest for manifest in runs.values()}
    authors = [
        {"@id": f"#author{number}", "@type": "Organization", "name": name}
        for number, name in enumerate(about["authors"], start=1)
    ]
    graph = [
        {
            "@id": METADATA,
            "@type": "CreativeWork",
            "about": {"@id": "./"},
            "conformsTo": {"@id": SPECIFICATION},
        },
        {
            "@id": "./",
            "@type": "Dataset",
            "name": about["title"],
            "description": about["description"],
            "datePublished": about["date"],
            "version": about["version"],
            "license": {"@id": LICENSE},
            "author": [{"@id": author["@id"]} for author in authors],
            "conformsTo": {"@id": PROFILE},
            "hasPart": [_file(name) for name in files if name != METADATA],
            "mentions": [{"@id": _action_id(folder)} for folder in runs],
        },
        {"@id": SPECIFICATION, "@type": "CreativeWork", "name": "RO-Crate", "version": "1.1"},
        {"@id": PROFILE, "@type": "CreativeWork", "name": "Process Run Crate", "version": "0.5"},
        {
            "@id": LICENSE,
            "@type": "CreativeWork",
            "name": "Creative Commons Attribution 4.0 International",
        },
        *authors,
    ]
    graph += [_file_entity(name, size) for name, size in files.items() if name != METADATA]
    graph += [_engine(identifier, manifest) for identifier, manifest in engines.items()]
    graph += [_action(folder, manifest, list(files)) for folder, manifest in runs.items()]
    return {"@context": f"{SPECIFICATION}/context", "@graph": graph}


def ended(manifest: Mapping) -> datetime:
    """When a run's process ended."""
    return datetime.fromisoformat(manifest["started_utc"]) + timedelta(seconds=manifest["wall_s"])


def _file(name: str) -> dict[str, str]:
    return {"@id": quote(name)}


def _file_entity(name: str, size: int | None) -> dict:
    entity = _file(name) | {"@type": "File", "name": name, "encodingFormat": media_type(name)}
    return entity if size is None else entity | {"contentSize": str(size)}


def _engine_id(manifest: Mapping) -> str:
    return "#" + quote(f"engine-{manifest['engine']}-{manifest['engine_version']}", safe="")


def _engine(identifier: str, manifest: Mapping) -> dict:
    entity = {"@id": identifier, "@type": "SoftwareApplication", "name": manifest["engine"]}
    entity["softwareVersion"] = manifest["engine_version"]
    if manifest["compiler"]:
        entity["description"] = f"compiled by {manifest['compiler']}"
    return entity


def _action_id(folder: str) -> str:
    return "#" + quote(folder.rpartition("/")[2], safe="")


def _action(folder: str, manifest: Mapping, files: Sequence[str]) -> dict:
    own = [name for name in files if name.startswith(f"{folder}/")]
    inputs = [name for name in own if name.startswith(f"{folder}/inputs/")]
    twin = f", twin {manifest['twin']}" if manifest["twin"] else ""
    return {
        "@id": _action_id(folder),
        "@type": "CreateAction",
        "name": f"{manifest['engine']} on packing {manifest['seed']}{twin}",
        "instrument": {"@id": _engine_id(manifest)},
        "object": [_file(name) for name in inputs],
        "result": [_file(name) for name in own if name not in inputs],
        "startTime": manifest["started_utc"],
        "endTime": ended(manifest).isoformat(timespec="seconds"),
        "actionStatus": "http://schema.org/CompletedActionStatus",
    }
