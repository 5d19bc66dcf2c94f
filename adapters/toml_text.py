"""Reading a TOML or JSON file that may be anything at all: a fault of its text names file, line and column."""

import json
import re
import stat
import tomllib
from pathlib import Path

_LARGEST_BYTES = 2**20  # a case has some kilobytes; a larger file is a mistake and is not read


class TextError(Exception):
    """The file holds no such text; the message starts with the file's name."""


def read_tables(path: Path) -> dict:
    """The tables of a TOML file, or, where its name ends in .json, of a JSON file. Raises TextError."""
    content = _read_bytes(path)
    try:
        found = (json if path.suffix == ".json" else tomllib).loads(content.decode())
    except UnicodeDecodeError as error:
        line, column = _position(content[: error.start])
        byte = content[error.start]
        raise TextError(f"{path}:{line}:{column}: byte 0x{byte:02x} is not UTF-8 text") from error
    except RecursionError as error:
        raise TextError(f"{path}: nested too deeply") from error
    except json.JSONDecodeError as error:
        where = f"{path}:{error.lineno}:{error.colno}"
        raise TextError(f"{where}: not valid JSON: {error.msg}") from error
    except ValueError as error:  # TOMLDecodeError, or int() refusing a number
        raise TextError(_with_position(path, content, str(error))) from error
    if not isinstance(found, dict):
        raise TextError(f"{path}: holds no object of JSON")
    return found


def _read_bytes(path: Path) -> bytes:
    try:
        status = path.stat()
        if stat.S_ISDIR(status.st_mode):
            raise TextError(f"{path}: is a folder, not a case file")
        if not stat.S_ISREG(status.st_mode):
            raise TextError(f"{path}: is not an ordinary file")
        if status.st_size > _LARGEST_BYTES:
            size_MB = status.st_size / 1e6
            raise TextError(
                f"{path}: {size_MB:.1f} MB is too large for a case file (1 MiB at most)"
            )
        return path.read_bytes()
    except OSError as error:
        raise TextError(f"{path}: cannot be read: {error.strerror}") from error
    except ValueError as error:  # a NUL in the name
        raise TextError(f"{path!r}: is no file name") from error


def _position(before: bytes) -> tuple[int, int]:
    """Line and column, from 1, of what follows these bytes."""
    line_start = before.rfind(b"\n") + 1
    column = len(before[line_start:].decode(errors="replace")) + 1
    return before.count(b"\n") + 1, column


def _with_position(path: Path, content: bytes, message: str) -> str:
    """tomllib's `what (at line 3, column 5)` as `FILE:3:5: what`."""
    if told := re.fullmatch(r"(.*) \(at line (\d+), column (\d+)\)", message, re.DOTALL):
        what, line, column = told.groups()
        return f"{path}:{line}:{column}: not valid TOML: {what}"
    if told := re.fullmatch(r"(.*) \(at end of document\)", message, re.DOTALL):
        line, column = _position(content)
        return f"{path}:{line}:{column}: not valid TOML: {told[1]} (the file ends here)"
    return f"{path}: a number has thousands of digits"
