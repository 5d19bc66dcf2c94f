"""Prints a dictionary for libFuzzer: every text that stands in quotes in the given files, the schema and the seeds.

usage: dictionary.py FILE...
"""

import re
import sys
from pathlib import Path

LONGEST = 64  # bytes: a longer text is a sentence, not a word of the format


def words(text: str) -> set[str]:
    """Keys and names, each with its quotes as it stands in JSON; numbers bare; the titles of tables."""
    quoted = set(re.findall(r'"[\w./ -]+"', text))
    numbers = set(re.findall(r"(?<![\w.])-?\d+(?:\.\d+)?(?:e-?\d+)?(?![\w.])", text))
    titles = set(re.findall(r"^[a-z_]+(?:,[a-z_]+)+$|^[a-z.]+:$", text, re.MULTILINE | re.ASCII))
    return {word for word in quoted | numbers | titles if len(word) <= LONGEST}


def escaped(word: str) -> str:
    return word.replace("\\", "\\\\").replace('"', '\\"')


if __name__ == "__main__":
    found = set().union(*(words(Path(name).read_text(encoding="utf-8")) for name in sys.argv[1:]))
    print("\n".join(f'"{escaped(word)}"' for word in sorted(found)))
