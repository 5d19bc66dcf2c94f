"""The comparison as a test report, junit.xml: a test for the verdict, for each run, each gate, each pair and check.

Only equivalence passes; what stays open is skipped, so that no continuous integration counts it as such.
"""

from __future__ import annotations

from xml.etree import ElementTree

from . import horizon_tables, outcomes
from .comparison import Comparison
from .intake import run_name
from .wording import explanation, printable

# Outcome: how the test ends; None is a pass.
ENDS = {
    outcomes.EQUIVALENT: None,
    outcomes.DIFFERENT: "failure",
    outcomes.INCONCLUSIVE: "skipped",
    outcomes.AGREES: None,
    outcomes.DIFFERS: "failure",
    outcomes.NOT_COMPARABLE: "error",
    outcomes.FAILED: "error",
}


def junit_xml(comparison: Comparison) -> bytes:
    root = ElementTree.Element("testsuites", name=printable(comparison.case.name))
    verdict = comparison.verdict
    suite(
        root,
        "verdict",
        [("verdict", verdict.word, "failure" if verdict.exit_code else None, verdict.sentence)],
    )
    manifests = comparison.ensemble.manifests
    finished = [
        (run[0], _packing(run), None, "") for run in manifests if run not in comparison.recorded
    ]
    failed = [
        (engine, f"seed {seed}", "error", message)
        for (engine, seed), message in comparison.failures.items()
    ]
    suite(root, "runs", finished + failed)
    suite(
        root,
        "gates",
        [
            (
                run[0],
                f"{_packing(run)}: {gate['name']}",
                None if gate["passed"] else "failure",
                gate["message"],
            )
            for run, manifest in manifests.items()
            for gate in manifest["gates"]
        ],
    )
    suite(
        root,
        "checks",
        [
            (
                " against ".join(result.pair),
                result.check.quantity.name,
                ENDS[result.outcome],
                f"{result.outcome}: {explanation(result)}",
            )
            for result in comparison.results
        ],
    )
    if comparison.horizon:
        rows = horizon_tables.rows(comparison.horizon)
        suite(
            root,
            "particle by particle",
            [
                (row.engine, "native scheme of its name", ENDS.get(row.outcome), row.remark)
                for row in rows
                if row.outcome in ENDS
            ],
        )
    return to_bytes(root)


def _packing(run: tuple[str, int, int]) -> str:
    """ "seed 3, twin 1"."""
    return run_name(run).removeprefix(f"{run[0]}, ")


def to_bytes(root: ElementTree.Element) -> bytes:
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="utf-8", xml_declaration=True) + b"\n"


def suite(root, name: str, cases: list[tuple[str, str, str | None, str]]) -> None:
    """A suite of `cases`: (class, name, how it ends, message)."""
    ends = [end for _, _, end, _ in cases]
    element = ElementTree.SubElement(
        root,
        "testsuite",
        name=name,
        tests=str(len(cases)),
        failures=str(ends.count("failure")),
        errors=str(ends.count("error")),
        skipped=str(ends.count("skipped")),
    )
    for class_name, case_name, end, message in cases:
        test = ElementTree.SubElement(
            element,
            "testcase",
            classname=f"{name}.{printable(class_name)}",
            name=printable(case_name),
        )
        if end:
            ElementTree.SubElement(test, end, message=printable(message))
