"""The verdicts as JUnit XML, which every continuous integration reads."""

from __future__ import annotations

from collections.abc import Sequence
from xml.etree import ElementTree

from fes_mj.checks import Check, criteria
from fes_mj.verification.faults import Verdict


def junit_xml(checks: Sequence[Check], verdicts: Sequence[Verdict] = ()) -> str:
    """One test suite a subject, one test case a check; injected faults that nobody caught are failures too."""
    root = ElementTree.Element("testsuites", name="fes_mj validate")
    for subject in dict.fromkeys(each.subject for each in checks):
        cases = [each for each in checks if each.subject == subject]
        suite = _suite(root, subject, len(cases), sum(not each.ok for each in cases))
        for each in cases:
            case = ElementTree.SubElement(suite, "testcase", classname=subject, name=each.name)
            text = f"{each.value:g} {each.unit} (limit {each.limit:g} {each.unit})"
            if not each.ok:
                failure = ElementTree.SubElement(case, "failure", message=text)
                failure.text = f"{criteria()[each.name].guards} Usually broken by: {criteria()[each.name].breaks}"
            ElementTree.SubElement(case, "system-out").text = text
    if verdicts:
        suite = _suite(root, "injected faults", len(verdicts), sum(not each.caught for each in verdicts))
        for verdict in verdicts:
            case = ElementTree.SubElement(suite, "testcase", classname="injected faults", name=verdict.fault.name)
            if not verdict.first:
                ElementTree.SubElement(case, "failure", message=f"nobody noticed: {verdict.fault.mistake}")
            else:
                ElementTree.SubElement(case, "system-out").text = f"caught by {verdict.first.name}"
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="unicode", xml_declaration=True) + "\n"


def _suite(root: ElementTree.Element, name: str, tests: int, failures: int) -> ElementTree.Element:
    return ElementTree.SubElement(root, "testsuite", name=name, tests=str(tests), failures=str(failures), errors="0")
