"""The programs of the bridge processes. Each program runs alone on Python 3.8 or newer, and imports nothing from Ravestate."""
