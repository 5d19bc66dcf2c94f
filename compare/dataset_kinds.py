"""The kinds of files in a package."""

from pathlib import PurePosixPath

_MEDIA_TYPES = {
    ".csv": "text/csv",
    ".json": "application/json",
    ".h5": "application/x-hdf5",
    ".md": "text/markdown",
    ".cff": "application/yaml",
    ".py": "text/x-python",
}


def media_type(name: str) -> str:
    """Of a file with this name; text for all that is no data here."""
    return _MEDIA_TYPES.get(PurePosixPath(name).suffix, "text/plain")


def format_of(name: str) -> str:
    """As the extension says it, in lower case."""
    return PurePosixPath(name).suffix.lstrip(".").lower() or "txt"
