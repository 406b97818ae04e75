"""Runs the conformance suite and the import corpus that lie beside the project, and compares with what is expected.

    python tests/conformance_check.py ../shared

Every test is to pass and every file of the corpus to agree, but for what `conformance_expected.txt` lists with its
reason. Something else that fails, and something listed that does not fail any more, are errors: exit code 1.
"""

from __future__ import annotations

import argparse
import csv
import json
import os
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ET
from pathlib import Path

EXPECTED = Path(__file__).with_name("conformance_expected.txt")


def expected(path: Path = EXPECTED) -> dict[str, str]:
    """What is expected to fail, by name, with the reason: lines `suite name: reason`."""
    found: dict[str, str] = {}
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if not line.strip() or line.startswith("#"):
            continue
        name, _, reason = line.partition(": ")
        if not reason.strip() or len(name.split()) != 2:
            raise SystemExit(f"{path.name}:{number}: found {line!r}; expected 'suite name: reason'")
        found[" ".join(name.split())] = reason.strip()
    return found


def conformance(folder: Path, workers: int) -> dict[str, str]:
    """What each test of the suite came to: "passed", "skipped", or the first line of why it failed."""
    with tempfile.TemporaryDirectory() as work:
        report = Path(work) / "report.xml"
        command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "--tb=short"]
        command += [f"--junit-xml={report}", "-n", str(workers), "--rootdir", str(folder)]
        command += ["-c", os.devnull, str(folder)]
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
        if done.returncode > 1 or not report.is_file():
            raise SystemExit(f"the conformance suite did not run:\n{done.stdout}")
        cases = ET.parse(report).iter("testcase")
        return {f"conformance {_name(case)}": _outcome(case) for case in cases}


def _name(case: ET.Element) -> str:
    return f"{case.get('classname', '').rsplit('.', 1)[-1]}::{case.get('name')}"


def _outcome(case: ET.Element) -> str:
    for kind in ("failure", "error"):
        found = case.find(kind)
        if found is not None:
            return (found.get("message") or kind).splitlines()[0]
    return "skipped" if case.find("skipped") is not None else "passed"


def corpus(folder: Path, workers: int) -> dict[str, str]:
    """What each file of the corpus came to: "agrees", "skipped", or how it differs."""
    with (folder / "manifest.tsv").open(encoding="utf-8") as file:
        names = [row["id"] for row in csv.DictReader(file, delimiter="\t")]
    with tempfile.TemporaryDirectory() as work:
        reports = [Path(work) / f"{i}.json" for i in range(workers)]
        checks = [
            subprocess.Popen(
                [sys.executable, str(folder / "check_import.py"), *names[i::workers], "--json", str(report)],
                stdout=subprocess.DEVNULL,
            )
            for i, report in enumerate(reports)
        ]
        for check in checks:
            check.wait()
        found: dict[str, str] = {}
        for report in reports:
            if not report.is_file():
                raise SystemExit("the corpus check did not run to its end")
            for name, result in json.loads(report.read_text()).items():
                details = "; ".join(result["details"][:1])
                found[f"corpus {name}"] = " ".join(filter(None, (result["state"], details)))[:300]
        return found


def compare(found: dict[str, str], known: dict[str, str]) -> list[str]:
    """What is not as expected, a line each."""
    fine = ("passed", "skipped", "agrees")
    wrong = [f"FAILS  {name}: {how}" for name, how in found.items() if not how.startswith(fine) and name not in known]
    for name, reason in known.items():
        how = found.get(name, "is not there")
        if how in ("passed", "agrees", "is not there"):
            wrong.append(f"LISTED {name} {how}, take it out of {EXPECTED.name} ({reason})")
    return wrong


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, help="with conformance/ and corpus/ in it")
    folder = parser.parse_args().folder.resolve()
    workers = min(4, os.cpu_count() or 1)
    known = expected()
    found = conformance(folder / "conformance", workers)
    found |= corpus(folder / "corpus", workers)
    wrong = compare(found, known)
    for suite in ("conformance", "corpus"):
        own = [how for name, how in found.items() if name.startswith(f"{suite} ")]
        good = sum(how in ("passed", "agrees") for how in own)
        listed = sum(name.startswith(f"{suite} ") for name in known)
        sys.stdout.write(f"{suite}: {good} of {len(own)} ({listed} expected to fail)\n")
    sys.stdout.write("".join(f"{line}\n" for line in wrong) or "all as expected\n")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
