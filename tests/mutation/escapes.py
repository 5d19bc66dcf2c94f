"""Faults that the ladder does not notice, and why: known limits, which the nightly tests hold to be still there."""

UNSEEN_BY_LADDER: dict[str, str] = {}
