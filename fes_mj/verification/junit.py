"""The detections as JUnit XML, which every continuous integration reads."""

from collections.abc import Sequence
from xml.etree import ElementTree

from fes_mj.common.checks import Check, definitions
from fes_mj.verification.faults import Detection


def junit_xml(checks: Sequence[Check], detections: Sequence[Detection] = ()) -> str:
    """One test suite a subject, one test case a check; injected faults that nobody caught are failures too."""
    root = ElementTree.Element("testsuites", name="fes_mj validate")
    for subject in dict.fromkeys(check.subject for check in checks):
        of_subject = [check for check in checks if check.subject == subject]
        suite = _suite(root, subject, len(of_subject), sum(not check.ok for check in of_subject))
        for check in of_subject:
            case = ElementTree.SubElement(suite, "testcase", classname=subject, name=check.name)
            text = f"{check.value:g} {check.unit} (limit {check.limit:g} {check.unit})"
            if not check.ok:
                failure = ElementTree.SubElement(case, "failure", message=text)
                definition = definitions()[check.name]
                failure.text = f"{definition.guards} Usually broken by: {definition.breaks}"
            ElementTree.SubElement(case, "system-out").text = text
    if detections:
        suite = _suite(root, "injected faults", len(detections), sum(not detection.caught for detection in detections))
        for detection in detections:
            case = ElementTree.SubElement(suite, "testcase", classname="injected faults", name=detection.fault.name)
            if not detection.first:
                ElementTree.SubElement(case, "failure", message=f"nobody noticed: {detection.fault.mistake}")
            else:
                ElementTree.SubElement(case, "system-out").text = f"caught by {detection.first.name}"
    ElementTree.indent(root)
    return str(ElementTree.tostring(root, encoding="utf-8", xml_declaration=True), "utf-8") + "\n"


def _suite(root: ElementTree.Element, name: str, tests: int, failures: int) -> ElementTree.Element:
    return ElementTree.SubElement(root, "testsuite", name=name, tests=str(tests), failures=str(failures), errors="0")
