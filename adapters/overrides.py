"""Overrides `key.path=value` from the command line, applied to a case before it is validated."""

import re
import tomllib

_STEP = re.compile(r"([A-Za-z0-9_-]+)((?:\[[0-9]{1,9}\])*)")
_BARE_WORD = re.compile(r"[A-Za-z0-9_.+-]+")


class OverrideError(Exception):
    """What is wrong with an override, without its text."""


def apply_override(tables: dict, override: str) -> None:
    """Sets one value, in place. Tables on the way are created: whether the key exists is for the schema to say."""
    path, equals, text = override.partition("=")
    if not equals:
        raise OverrideError("has no '='; write --set key.path=value")
    *parents, last = _parse_path(path.strip())
    value = _parse_value(text.strip())

    place, seen = tables, ""
    for step, following in zip(parents, [*parents[1:], last]):
        place = _enter(place, step, seen, default=[] if isinstance(following, int) else {})
        seen += f"[{step}]" if isinstance(step, int) else f".{step}" if seen else step
    _check_place(place, last, seen)
    place[last] = value


def _parse_path(path: str) -> list[str | int]:
    """`check[0].margin` as ["check", 0, "margin"]."""
    steps = []
    for part in path.split("."):
        matched = _STEP.fullmatch(part)
        if not matched:
            raise OverrideError(
                f"{path!r} is not a key path such as contact.particle_wall.friction"
            )
        steps.append(matched[1])
        steps += [int(index) for index in re.findall(r"[0-9]+", matched[2])]
    return steps


def _parse_value(text: str):
    """A TOML value; a bare word that is none is taken as a string."""
    try:
        parsed = tomllib.loads(f"value = {text}")
        if list(parsed) == ["value"]:
            return parsed["value"]
    except (ValueError, RecursionError):
        if _BARE_WORD.fullmatch(text):
            return text
    raise OverrideError(
        "the value is not TOML (text with spaces or signs needs quotes: 'key=\"some text\"')"
    )


def _enter(place, step: str | int, seen: str, default):
    _check_place(place, step, seen)
    return place[step] if isinstance(step, int) else place.setdefault(step, default)


def _check_place(place, step: str | int, seen: str) -> None:
    """Whether `place`, which lies at key path `seen`, can have this key or index."""
    if isinstance(step, int):
        if not isinstance(place, list):
            raise OverrideError(f"{seen} is not a list")
        if step >= len(place):
            raise OverrideError(f"{seen} has {len(place)} entries, counted from 0")
    elif not isinstance(place, dict):
        raise OverrideError(f"{seen} is not a table")
