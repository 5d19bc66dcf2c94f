"""Small files that others read while they are written."""

import os
from pathlib import Path


def replace_text(path: Path, text: str) -> None:
    """Write the file whole or not at all, also when two write it at once."""
    partial = path.with_name(f".{path.name}.{os.getpid()}.partial")
    with open(partial, "w", encoding="utf-8") as file:
        file.write(text)
        file.flush()
        os.fsync(file.fileno())
    os.rename(partial, path)
