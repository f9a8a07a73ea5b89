"""Run the command line as `python -m limitblocks`."""

from limitblocks.cli import main

main()
