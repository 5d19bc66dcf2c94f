"""Files that are there whole or not at all, and places that only look like files."""

import os
from pathlib import Path
from secrets import token_hex


def write_whole(path: Path, content: bytes) -> None:
    """Replace `path` by `content`, whole or not at all, also when two write it at once, on two machines.

    Raises OSError. Whatever breaks it off, nothing else is left.
    """
    partial = path.with_name(f".{path.name}.{token_hex(8)}.partial")
    try:
        with open(partial, "wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        os.rename(partial, path)
    except BaseException:
        partial.unlink(missing_ok=True)
        raise


def refuse_special_files(folder: Path) -> None:
    """Raises OSError for a pipe, socket or device in `folder`, or its folders: who opens one may wait forever."""
    for place in folder.rglob("*"):
        if place.exists() and not (place.is_file() or place.is_dir()):
            raise OSError(f"{place} is neither a file nor a folder")
