"""Verdicts as JUnit XML."""

from xml.etree import ElementTree

from fes_mj.common.checks import check


def test_junit_reports_failures() -> None:
    from fes_mj.verification.junit import junit_xml

    root = ElementTree.fromstring(
        junit_xml([check("loop_gap", 1.0, "d1 <p1p2>"), check("mean_power", 0.0, "d1 <p1p2>")])
    )
    suite = root.find("testsuite")
    assert suite is not None
    assert suite.get("failures") == "1"
    failure = suite.find("testcase/failure")
    assert failure is not None
    assert "1 m (limit 1e-05 m)" in failure.get("message", "")


def test_the_file_says_the_encoding_it_is_written_in() -> None:
    """Whatever the locale is."""
    from fes_mj.verification.junit import junit_xml

    assert junit_xml(()).startswith("<?xml version='1.0' encoding='utf-8'?>")
