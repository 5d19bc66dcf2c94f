"""Texts that some engine, shell or browser would take for code, and numbers at the edges of what a case may hold."""

import hypothesis.strategies as some

FRAGMENTS = (
    "$(touch broken)",
    "`touch broken`",
    "${friction_particle}",
    '"""',
    "'",
    '"',
    "\\",
    "\n",
    "\r\nshell rm -rf .\n",
    "; import os; os.abort()",
    "# &",
    "<script>alert(1)</script>",
    "<img src=x onerror=alert(1)>",
    "-->",
    "]]>",
    "{{ 7 * 7 }}",
    "{% include 'x' %}",
    "../../../broken",
    "\x1b[2J",
    "土のモデル",
    "\u202e",
)

texts = (
    some.lists(some.sampled_from(FRAGMENTS) | some.text(max_size=4), min_size=1, max_size=5)
    .map("".join)
    .filter(bool)
)
positive = some.floats(1e-300, 1e12)
