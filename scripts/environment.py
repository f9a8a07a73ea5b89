"""Find or make the virtual environment of this repository.

Standard library only, and plain enough to parse on any Python, so that an old one can be told apart.
"""

from __future__ import print_function

import hashlib
import os
import subprocess
import sys
import time

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
VENV = os.path.abspath(os.environ.get("LIMITBLOCKS_VENV") or os.path.join(ROOT, ".venv"))
BIN = os.path.join(VENV, "Scripts" if os.name == "nt" else "bin")
PYTHON = os.path.join(BIN, "python.exe" if os.name == "nt" else "python")
STAMP = os.path.join(VENV, "limitblocks.stamp")
INSTALLING = "installing"
OFFLINE = ("Retrying (", "Max retries exceeded", "NewConnectionError", "ProxyError", "name resolution")


def prepare(extra=""):
    """Make sure that PYTHON runs, with limitblocks and its `extra` installed."""
    if sys.version_info < (3, 11):
        version = ".".join(map(str, sys.version_info[:3]))
        sys.exit(
            "limitblocks needs Python 3.11 or newer, but this is Python %s (%s)." % (version, sys.executable)
        )
    started = time.time()
    os.environ.setdefault("PYTHONUTF8", "1")  # Greek letters on a Windows console
    stamp = read_stamp()
    healthy = stamp != INSTALLING and answers("import pip")
    if (
        healthy
        and stamp in accepted_stamps(extra)
        and answers("import importlib.metadata as m; m.version('limitblocks')")
    ):
        return
    if not healthy:
        make_venv(started)
    elif not stamp.endswith(" dev"):
        say("using %s" % VENV, started)
    else:
        extra = "dev"  # what a developer's environment had, it keeps
    install(extra, started)


def enter():
    """Run this command by the Python of the environment, unless the running one has limitblocks."""
    try:
        from importlib.metadata import version

        version("limitblocks")
    except ImportError:
        prepare("dev")
        sys.exit(subprocess.call([PYTHON, *sys.argv]))


def accepted_stamps(extra):
    """Stamps of environments that serve: a developer's serves everybody."""
    with open(os.path.join(ROOT, "pyproject.toml"), "rb") as file:
        settings = file.read()
    key = hashlib.sha256(settings + ROOT.encode("utf-8")).hexdigest()
    return ["%s %s" % (key, name) for name in (extra or "core", "dev")]


def read_stamp():
    try:
        with open(STAMP) as file:
            return file.read()
    except (OSError, IOError):
        return ""


def write_stamp(text):
    with open(STAMP, "w") as file:
        file.write(text)


def answers(code):
    """Tell whether the environment's Python is the running version and runs `code`."""
    code = "import sys; assert sys.version_info[:2] == %r; %s" % (tuple(sys.version_info[:2]), code)
    try:
        return subprocess.call([PYTHON, "-I", "-c", code], stderr=subprocess.DEVNULL) == 0
    except OSError:
        return False


def make_venv(started):
    try:
        import ensurepip  # noqa: F401
        import venv  # noqa: F401
    except ImportError as error:
        sys.exit(
            "This Python lacks the module %s: install it (Debian, Ubuntu: python3-venv) and run again."
            % error.name
        )
    if os.path.isdir(VENV) and os.listdir(VENV) and not os.path.exists(os.path.join(VENV, "pyvenv.cfg")):
        sys.exit("%s is no virtual environment: it is left as it is; move it away and run again." % VENV)
    say("making %s" % VENV, started)
    base = getattr(sys, "_base_executable", sys.executable)  # the running Python may live in VENV itself
    if subprocess.call([base, "-m", "venv", "--clear", VENV]):
        sys.exit("Python could not make a virtual environment in %s (its words are above)." % VENV)


def install(extra, started):
    what = "%s[%s]" % (ROOT, extra) if extra else ROOT
    say(
        "installing limitblocks%s (a few minutes the first time)" % (" for development" if extra else ""),
        started,
    )
    write_stamp(INSTALLING)  # stays when this is interrupted: then the environment is made anew
    output = []
    command = [PYTHON, "-m", "pip", "install", "--progress-bar", "off", "--editable", what]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, encoding="utf-8")
    for line in process.stdout:
        output.append(line)
        if line.startswith(("Collecting", "Installing")):
            say("  " + line.strip()[:90], started)
    if process.wait():
        os.remove(STAMP)
        print("".join(output))
        if any(sign in line for sign in OFFLINE for line in output):
            sys.exit("pip could not reach its package index: check network and proxy, and run again.")
        sys.exit("pip could not install limitblocks (its words are above).")
    write_stamp(accepted_stamps(extra)[0])
    say("ready", started)


def say(text, started):
    print("[%4.0f s] %s" % (time.time() - started, text))
    sys.stdout.flush()
