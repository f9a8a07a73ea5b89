"""The set of certified non-associated load factors: sampled, searched, and exact for small models."""
