"""A plugin of pytest for `cargo xtask`: what passed, failed and was skipped, in lines that it reads."""


def pytest_terminal_summary(terminalreporter) -> None:
    """Counts, and the skipped tests by name: `cargo xtask` reads these lines."""
    stats = terminalreporter.stats
    for report in stats.get("skipped", []):
        print(f"pytest skipped: {report.nodeid} ({str(report.longrepr[-1]).removeprefix('Skipped: ')})")
    failed = len(stats.get("failed", [])) + len(stats.get("error", []))
    print(f"pytest: {len(stats.get('passed', []))} passed, {failed} failed")
