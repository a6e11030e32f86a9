"""Runs exported MetaDrive scripts one after the other, as `python SCRIPT SCENARIO --headless --trace TRACE` does each: starting an
interpreter with MetaDrive takes longer than most runs.

Arguments are SCRIPT, SCENARIO and TRACE of each. Each script's last line is JSON, and is printed with the name of its scenario's file.
"""

import contextlib
import io
import json
import runpy
import sys

for script, scenario, trace in zip(*[iter(sys.argv[1:])] * 3):
    told = io.StringIO()
    sys.argv = [script, scenario, "--headless", "--trace", trace]
    with contextlib.redirect_stdout(told):
        runpy.run_path(script, run_name="__main__")
    print(json.dumps({"file": scenario, **json.loads(told.getvalue().splitlines()[-1])}))
