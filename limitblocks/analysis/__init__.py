"""Bounds, non-associated solution, load path and checks; import from the modules."""
