"""A trial of a 3dm file in a process of its own: rhino3dm may search a damaged one without end, or crash."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

#: Time that reading may take, s: at least, and for each MB.
SECONDS = 10.0
SECONDS_PER_MB = 2.0
_NOTHING = 3  # exit code
_TRIAL = f"""
import sys
from pathlib import Path
import rhino3dm
sys.exit(0 if rhino3dm.File3dm.FromByteArray(Path(sys.argv[1]).read_bytes()) else {_NOTHING})
"""


def fault(path: Path) -> str:
    """Say why rhino3dm cannot read the file at `path`; empty when it can, or where no trial is possible."""
    if not sys.executable or getattr(sys, "frozen", False):  # not a Python that could be started
        return ""
    seconds = SECONDS + SECONDS_PER_MB * path.stat().st_size / 1e6
    command = [sys.executable, "-P", "-c", _TRIAL, str(path)]
    try:
        code = subprocess.run(command, capture_output=True, timeout=seconds, check=False).returncode
    except subprocess.TimeoutExpired:
        return (
            f"is damaged: rhino3dm does not come to an end with it in {seconds:.0f} s; save it again in Rhino"
        )
    except OSError:
        return ""
    # 1 is an error of Python, as where the package is found in this process only
    return "" if code in (0, 1) else "is not sound 3dm: rhino3dm cannot read it; save it again in Rhino"
