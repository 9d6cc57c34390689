"""Measure the pitch of a voice, to detect that another person has begun to speak."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ravestate.modules.modality.rawio.line import IN_RATE

from .sound import Samples

FRAME = 640
"""The number of samples in a frame (40 ms)."""
LOWEST, HIGHEST = 70.0, 400.0
"""The lowest and the highest pitch of speaking voices (Hz)."""
PERIODIC = 0.6
"""A frame is voiced if its autocorrelation at one period is greater than this."""
ENOUGH = 8
"""This many voiced frames are enough to know a voice's pitch."""
ANOTHER = 1.6
"""If the ratio of two median pitches is greater than this, they belong to two people. One person's pitch varies
less."""
LASTING = 15
"""A change of voice within speech needs this many voiced frames on each side. One person's pitch jumps for a shorter
time."""
AGREE = 0.9
"""At a change of voice, a threshold separates the earlier pitches from the later ones. It is halfway between the medians
of the two groups (in logarithms). At least this share of each group must be on the same side as the group's median."""
SOFT = 500
"""A frame in which no sample reaches this level counts as silence."""
_SHORTEST, _LONGEST = int(IN_RATE / HIGHEST), int(IN_RATE / LOWEST)
NEEDED = FRAME + _LONGEST + 1
"""The number of samples needed to compute a pitch: a frame, and the frame one period later."""
_SIZE = 1 << (NEEDED + FRAME).bit_length()


def pitches(sound: Samples, step: int = FRAME) -> list[float | None]:
    """Return the pitch (Hz) at every `step` samples of a sound (16 kHz); None where there is no voice."""
    return [pitch(sound[at : at + NEEDED]) for at in range(0, len(sound) - NEEDED + 1, step)]


def pitch(sound: Samples) -> float | None:
    """Return the pitch (Hz) at the beginning of a sound of at least `NEEDED` samples; None if there is no voice."""
    wave = sound[:NEEDED].astype(np.float64)
    frame = wave[:FRAME]
    if np.abs(frame).max() < SOFT:
        return None
    spectrum = np.fft.rfft(wave, _SIZE) * np.conj(np.fft.rfft(frame, _SIZE))
    later = np.fft.irfft(spectrum, _SIZE)[_SHORTEST : _LONGEST + 1]
    energy = np.concatenate([[0.0], np.cumsum(wave**2)])
    powers = energy[_SHORTEST + FRAME : _LONGEST + FRAME + 1] - energy[_SHORTEST : _LONGEST + 1]
    alike = later / np.sqrt(float(frame @ frame) * powers + 1e-9)
    best = float(alike.max())
    if best <= PERIODIC:
        return None
    first = int(np.flatnonzero(alike > 0.9 * best)[0])  # the first peak: later peaks are multiples of the period
    while first + 1 < len(alike) and alike[first + 1] > alike[first]:
        first += 1
    return IN_RATE / (first + _SHORTEST)


def is_another(first: Sequence[float | None], second: Sequence[float | None]) -> bool:
    """Return whether two sequences of pitches seem to be the voices of two people."""
    one, other = _voiced(first), _voiced(second)
    if len(one) < ENOUGH or len(other) < ENOUGH:
        return False
    low, high = sorted((float(np.median(one)), float(np.median(other))))
    return high > ANOTHER * low


def change(found: Sequence[float | None]) -> int | None:
    """Return the index in a sequence of pitches at which another person begins; None if only one person speaks.

    The pitch of one person also jumps, but seldom for long. So nearly all pitches before the index must be below
    a threshold, and nearly all later ones above it, or the reverse (`AGREE`).
    """
    places = [place for place, each in enumerate(found) if each is not None]
    logs = np.log(np.array(_voiced(found), np.float64))
    best, chosen = 0, None
    for split in range(LASTING, len(logs) - LASTING + 1):
        one, other = float(np.median(logs[:split])), float(np.median(logs[split:]))
        if abs(one - other) <= np.log(ANOTHER):
            continue
        low = logs < (one + other) / 2
        first = int((low[:split] == (one < other)).sum())
        second = int((low[split:] == (other < one)).sum())
        if min(first / split, second / (len(logs) - split)) >= AGREE and first + second > best:
            best, chosen = first + second, places[split]
    return chosen


def _voiced(found: Sequence[float | None]) -> list[float]:
    return [each for each in found if each is not None]
