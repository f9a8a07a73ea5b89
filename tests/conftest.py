import os

from hypothesis import settings

os.environ["MPLBACKEND"] = "Agg"  # no window, on any machine

settings.register_profile("default", deadline=None, derandomize=True, max_examples=30)
settings.register_profile("ci", deadline=None, derandomize=True, max_examples=100)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "default"))
