"""The console: what is typed is heard, what is said is printed."""
