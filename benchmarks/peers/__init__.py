"""The contestants: each does the same work, in an interpreter of its own, and reports over `wire`."""
