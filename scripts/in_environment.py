"""Imported first, makes a command run in the environment of this repository."""

import environment

environment.enter()
