"""Compute the features of a movement, the numbers that describe it, after `skeleton_of` has normalised the movement.

The features do not depend on tempo, or on when the movement starts.
"""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING

from .skeleton import JOINTS, Skeleton

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

HEAD, LEFT_WRIST, RIGHT_WRIST = 0, 3, 4
TRACKS = 12
"""The number of coordinates whose pairwise correlations are features: those of the wrists, the height and depth of the
knees, the depth of the torso, and the height of the shoulders."""


def features_of(skeleton: Skeleton) -> NDArray[np.float64]:
    """Return the `COUNT` features of a movement. A feature is NaN if the joints that it needs are not visible.

    First come the mean place and the size of the movement of each joint and of the torso. The size of the movement of
    the shoulders' height follows. Next come the correlations between pairs of coordinates. The last features describe
    the wrists: their rotations, the distance between them, and their distances from the face. All features are
    statistics over time, so tempo and phase do not matter.
    """
    import numpy as np

    joints, present = skeleton.joints, skeleton.present
    missing = ~present
    mean, spread = joints.mean(axis=0), joints.std(axis=0)
    mean[missing], spread[missing] = np.nan, np.nan
    torso = skeleton.torso if skeleton.has_hips else np.full_like(skeleton.torso, np.nan)
    parts = [mean.ravel(), np.sqrt(spread).ravel(), torso.mean(axis=0), np.sqrt(torso.std(axis=0))]
    parts.append(np.sqrt([skeleton.rise.std()]))
    tracks = np.concatenate(
        [
            joints[:, LEFT_WRIST],
            joints[:, RIGHT_WRIST],
            joints[:, 5:7, 1:].reshape(len(joints), -1),
            torso[:, 2:],
            skeleton.rise[:, None],
        ],
        axis=1,
    )
    gone = np.repeat([missing[LEFT_WRIST], missing[RIGHT_WRIST]], 3).tolist()
    gone += [*np.repeat(missing[5:7], 2).tolist(), not skeleton.has_hips, False]
    tracks[:, gone] = np.nan
    centred = tracks - tracks.mean(axis=0)
    deviation = centred.std(axis=0) + 0.02
    common = (centred.T @ centred) / len(centred) / np.sqrt(np.outer(deviation, deviation))
    parts.append(np.array([common[i, j] for i, j in combinations(range(TRACKS), 2)]))
    parts.append(np.array([_rotation(tracks[:, [a, b]]) for a, b in ((0, 1), (1, 2), (0, 2), (3, 4), (4, 5), (3, 5))]))
    left, right = tracks[:, :3], tracks[:, 3:6]
    face = np.full_like(joints[:, HEAD], np.nan) if missing[HEAD] else joints[:, HEAD]
    apart = np.linalg.norm(left - right, axis=1)
    near = [np.linalg.norm(hand - face, axis=1) for hand in (left, right)]
    parts.append(np.array([apart.mean(), np.sqrt(apart.std()), apart.min()]))
    parts.append(np.array([value for one in near for value in (one.mean(), np.sqrt(one.std()), one.min())]))
    return np.concatenate(parts)


COUNT = 6 * len(JOINTS) + 7 + TRACKS * (TRACKS - 1) // 2 + 6 + 9
"""The number of features."""


def _rotation(path: NDArray[np.float64]) -> float:
    """Return the signed area that a path in a plane sweeps, relative to its length and size; 0 without a rotation."""
    import numpy as np

    centred = path - path.mean(axis=0)
    steps = np.diff(centred, axis=0)
    swept = centred[:-1, 0] * steps[:, 1] - centred[:-1, 1] * steps[:, 0]
    length, size = np.linalg.norm(steps, axis=1).sum(), np.sqrt((centred**2).sum(axis=1).mean())
    return float(swept.sum() / (length + 0.05) * np.sqrt(size) / (size + 0.05))
