"""Grounding: from words that are heard to what they mean: K, hypotheses, validation, Φ (thesis chapter 4)."""
