"""What is claimed about speed, each claim measured against its peers and its floor in one run.

``python -m benchmarks`` from the repository's root; see README.md.
"""
