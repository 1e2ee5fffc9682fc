#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 beautymap contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Sums up the result files of gtest, rosunit and rostest: sum_test_results.py FOLDER

Prints each failed test with the end of what it says and, as the last line, `N passed, M failed`
(`, K skipped` if there are such). Exit code 1 if any failed or none passed.

A rostest writes two kinds of files: rosunit-NAME.xml with the test cases of its test node NAME, and
rostest-FILE.xml with one case testNAME for the node as a whole. The second counts only when it
failed and the first does not tell why (the node crashed or ran out of time).
"""
import pathlib
import sys
import xml.etree.ElementTree as ElementTree

LINES_OF_A_FAILURE = 20


def read_cases(path):
    """The cases of one file as (name, outcome, what it says of a failure)."""
    try:
        root = ElementTree.parse(path).getroot()
    except ElementTree.ParseError:
        return [(f"{path.name} (a broken result file)", "failed", "")]
    cases = []
    for case in root.iter("testcase"):
        outcome, reason = "passed", ""
        failures = case.findall("failure") + case.findall("error")
        if failures:
            outcome = "failed"
            reason = "\n".join(failure.text or failure.get("message", "") for failure in failures)
        elif case.find("skipped") is not None or case.get("status") == "notrun":
            outcome = "skipped"
        name = f"{case.get('classname', '')}.{case.get('name', '')}"
        if path.name.startswith("MISSING-"):
            name = f"{path.name[len('MISSING-'):-len('.xml')]} (crashed, no result)"
        cases.append((name, outcome, reason))
    return cases


def sum_up(folder):
    """All cases below a folder, as read_cases gives them."""
    cases = []
    nodes = {}  # test node -> the rostest file that ran it
    for path in sorted(folder.rglob("*.xml")):
        if not path.name.startswith("rostest-"):
            cases += read_cases(path)
            continue
        for name, outcome, reason in read_cases(path):
            node = name.rpartition(".test")[2]
            if node in nodes:
                # The second run has overwritten the first one's rosunit-NAME.xml.
                clash = f"{path.name} and {nodes[node]} both use test-name {node}"
                cases.append((clash, "failed", ""))
            nodes[node] = path.name
            details = path.with_name(f"rosunit-{node}.xml")
            known = [outcome for _, outcome, _ in read_cases(details)] if details.exists() else []
            if outcome == "failed" and "failed" not in known:
                cases.append((f"{path.name}: {node}", "failed", reason))
    return cases


def main():
    cases = sum_up(pathlib.Path(sys.argv[1]))
    count = {"passed": 0, "failed": 0, "skipped": 0}
    for name, outcome, reason in cases:
        count[outcome] += 1
        if outcome == "failed":
            print(f"FAILED: {name}")
            for line in reason.strip().splitlines()[-LINES_OF_A_FAILURE:]:
                print(f"  {line}")
    line = f"{count['passed']} passed, {count['failed']} failed"
    if count["skipped"]:
        line += f", {count['skipped']} skipped"
    print(line)
    return 0 if count["passed"] and not count["failed"] else 1


if __name__ == "__main__":
    sys.exit(main())
