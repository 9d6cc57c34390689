"""Benchmarks: each claim about speed, measured against its peers and its floor in one run.

``python -m benchmarks`` from the repository's root; see README.md.
"""
