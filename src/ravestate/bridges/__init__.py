"""Ravestate inside other people's voice frameworks: Pipecat and LiveKit."""
