"""The comparison as a test report, junit.xml: a test for the verdict, for each run, each gate, each pair and check.

Only agreement passes; what stays open is skipped, so that no continuous integration counts it as agreement.
"""

from __future__ import annotations

from xml.etree import ElementTree

from . import checks, horizon_tables
from .comparison import Comparison
from .horizon import FAILED
from .wording import explanation, printable

# Outcome: how the test ends; None is a pass.
ENDS = {
    checks.AGREES: None,
    checks.DIFFERS: "failure",
    checks.INCONCLUSIVE: "skipped",
    checks.NOT_COMPARABLE: "error",
    FAILED: "error",
}


def junit_xml(comparison: Comparison) -> bytes:
    root = ElementTree.Element("testsuites", name=printable(comparison.case.name))
    verdict = comparison.verdict
    suite(
        root,
        "verdict",
        [("verdict", verdict.word, "failure" if verdict.exit_code else None, verdict.sentence)],
    )
    finished = [(run.engine, f"seed {run.seed}", None, "") for run in comparison.datasets]
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
                run.engine,
                f"seed {run.seed}: {gate['name']}",
                None if gate["passed"] else "failure",
                gate["message"],
            )
            for run in comparison.datasets
            for gate in run.manifest["gates"]
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
