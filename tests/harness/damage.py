"""Damage to the files of a run, for Hypothesis to choose from, and a process of little memory that reads what is left."""

from __future__ import annotations

import json
import os
import resource
import signal
import sys
import traceback
from collections.abc import Callable
from pathlib import Path

import hypothesis.strategies as some

MOST_BYTES = 512 * 2**20  # beyond what this process holds already
MOST_S = 10
SURVIVED, BROKEN = 0, 1

any_json = some.recursive(
    some.none()
    | some.booleans()
    | some.integers()
    | some.sampled_from(
        [-1, 0, 1, 2**63, 10**400, 1e12, 1e300, -0.5, float("nan"), float("inf")]
    )
    | some.floats()
    | some.text(max_size=8),
    lambda parts: some.lists(parts, max_size=3) | some.dictionaries(some.text(max_size=4), parts),
    max_leaves=6,
)


@some.composite
def damaged_bytes(draw, content: bytes) -> bytes:
    """`content` cut off, with bytes of it replaced, or another content altogether."""
    kind = draw(some.sampled_from(["cut", "replaced", "replaced", "other"]))
    place = draw(some.integers(0, max(0, len(content) - 1)))
    if kind == "cut":
        return content[:place]
    if kind == "other":
        nested = b"[" * 100_000
        return draw(some.sampled_from([b"", b"{}", b"[]", b"1", nested]) | some.binary(max_size=64))
    new = draw(some.binary(min_size=1, max_size=16))
    return content[:place] + new + content[place + len(new) :]


@some.composite
def damaged_json(draw, value):
    """`value` with one of the values in it replaced by any other, or taken away."""
    if not isinstance(value, (dict, list)) or not value or draw(some.integers(0, 3)) == 0:
        return draw(any_json)
    keys = list(value) if isinstance(value, dict) else range(len(value))
    key = draw(some.sampled_from(keys))
    damaged = value.copy()
    if draw(some.integers(0, 4)) == 0:
        del damaged[key]
    else:
        damaged[key] = draw(damaged_json(value[key]))
    return damaged


@some.composite
def damaged_table(draw, text: str) -> str:
    """`text` of a CSV file with a field replaced, in one row or in all of them, or a row more or less."""
    rows = [line.split(",") for line in text.splitlines()]
    field = draw(
        some.sampled_from(
            ["", "nan", "inf", "1e308", "True", "9" * 400, "-1", "x", '"', "0x1", "\0"]
        )
    )
    kind = draw(some.sampled_from(["field", "column", "title", "less", "more"]))
    row, column = draw(some.integers(1, len(rows) - 1)), draw(some.integers(0, len(rows[0]) - 1))
    if kind == "column":
        rows[1:] = [[*one[:column], field, *one[column + 1 :]] for one in rows[1:]]
    elif kind == "less":
        del rows[row:]
    elif kind == "more":
        rows.append([field] * draw(some.integers(1, 12)))
    else:
        rows[row if kind == "field" else 0][column] = field
    return "\n".join(map(",".join, rows)) + "\n"


def dumped(value) -> bytes:
    return json.dumps(value).encode()


def survives(read: Callable[[], object], *refusals: type[Exception]) -> None:
    """Fails unless `read`, in a process with MOST_BYTES and MOST_S, returns or raises one of `refusals`."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        os._exit(_read_in_child(read, refusals, writing))
    os.close(writing)
    with os.fdopen(reading, errors="replace") as said:
        text = said.read()
    status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    assert status == SURVIVED, f"ended with {status}: {text}"


def _read_in_child(read, refusals, writing: int) -> int:
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stderr.fileno())
    held = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (held + MOST_BYTES, held + MOST_BYTES))
    signal.signal(signal.SIGALRM, signal.SIG_DFL)
    signal.alarm(MOST_S)
    try:
        read()
    except refusals:
        pass
    except BaseException:
        os.write(writing, traceback.format_exc()[-4000:].encode(errors="replace"))
        return BROKEN
    return SURVIVED
