"""Benchmarks: us beside the alternatives, on the same work in the same run."""
