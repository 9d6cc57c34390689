"""The features of a movement, with all joints visible and with some of them invisible."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from modules.modality.activity.performers import performance
from ravestate.modules.modality.activity.features import COUNT, HEAD, LEFT_WRIST, RIGHT_WRIST, features_of
from ravestate.modules.modality.activity.skeleton import Skeleton, skeleton_of

APART, NEAR_LEFT, NEAR_RIGHT = slice(-9, -6), slice(-6, -3), slice(-3, None)
"""The features of the distance between the wrists, and of each wrist's distance from the face."""


@pytest.fixture(scope="module")
def skeleton() -> Skeleton:
    found = skeleton_of(performance("clapping"))
    assert found is not None and found.present.all() and found.has_hips
    return found


def test_all_features_of_a_visible_body_are_numbers(skeleton: Skeleton) -> None:
    features = features_of(skeleton)
    assert features.shape == (COUNT,)
    assert np.isfinite(features).all()


@pytest.mark.parametrize(
    ("joint", "lost"),
    [(HEAD, (NEAR_LEFT, NEAR_RIGHT)), (LEFT_WRIST, (APART, NEAR_LEFT)), (RIGHT_WRIST, (APART, NEAR_RIGHT))],
    ids=["head", "left wrist", "right wrist"],
)
def test_the_distances_from_an_invisible_joint_are_nan_and_the_other_distances_stay(
    skeleton: Skeleton, joint: int, lost: tuple[slice, ...]
) -> None:
    present = skeleton.present.copy()
    present[joint] = False
    whole, partial = features_of(skeleton), features_of(dataclasses.replace(skeleton, present=present))
    for part in (APART, NEAR_LEFT, NEAR_RIGHT):
        if part in lost:
            assert np.isnan(partial[part]).all()
        else:
            assert np.array_equal(partial[part], whole[part])
