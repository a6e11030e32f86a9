"""Runs ASAM's quality checkers over files; prints one JSON object per file. Runs in the environment of requirements/qc.txt."""

import json
import sys

import qc_opendrive.constants
import qc_opendrive.main
import qc_openscenario.constants
import qc_openscenario.main
from qc_baselib import Configuration, Result


def check(path):
    package = qc_opendrive if path.endswith(".xodr") else qc_openscenario
    configuration = Configuration()
    configuration.set_config_param("InputFile", path)
    result = Result()
    result.register_checker_bundle(
        name=package.constants.BUNDLE_NAME, description="", version=package.constants.BUNDLE_VERSION, summary=""
    )
    result.set_result_version(version=package.constants.BUNDLE_VERSION)
    package.main.run_checks(configuration, result)
    bundle = package.constants.BUNDLE_NAME
    status, issues = {}, []
    for checker in result.get_checker_results(bundle):
        status.setdefault(checker.status.value if checker.status else "none", []).append(checker.checker_id)
        for issue in checker.issues:
            places = [str(place) for location in issue.locations for place in (location.file_location + location.xml_location)]
            issues.append(f"{checker.checker_id}: {issue.description} {places}")
    return {"file": path, "status": status, "issues": issues}


if __name__ == "__main__":
    for name in sys.argv[1:]:
        print(json.dumps(check(name)))
