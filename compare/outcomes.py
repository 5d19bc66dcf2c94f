"""The outcomes that a single comparison can have; verdict.py makes one word of many."""

# Of checks, between ensembles: a statement with an error rate.
EQUIVALENT = "equivalent"
DIFFERENT = "different"
INCONCLUSIVE = "inconclusive"

# Of what has no scatter: a rung of the ladder, a comparison particle by particle.
AGREES = "agrees"
DIFFERS = "differs"
NO_SUCH_LAW = "not offered"  # the engine says itself that it cannot run the case faithfully

# Of either.
NOT_COMPARABLE = "not comparable"
NO_RESULT = "no result"
FAILED = "failed"
