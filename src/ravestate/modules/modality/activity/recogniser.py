"""The recogniser: it compares the features of a movement with the features of known activities.

Each activity is a Gaussian with its own mean and standard deviation for each feature. All activities share one
correlation matrix of the features. A movement belongs to the activity that makes it most probable. The movement is
unknown if it is too far from that activity's mean. It is also unknown if one of the *other* movements, such as
standing, is more probable. The starter set, which comes with the module, has activities and *other* movements. The
recogniser tries the movement and its mirror image.

A new activity needs few demonstrations, because they determine only its mean. Its deviations are computed from those of
an average activity.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib import import_module
from importlib.resources import files
from typing import TYPE_CHECKING, Any

from ravestate.errors import PlatformError

from .features import COUNT, features_of
from .pose import Pose
from .skeleton import skeleton_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

OWN = 0.9
"""The weight of an activity's own variance in its deviations. The remaining weight goes to the variance of an average
activity."""
RIDGE = 0.05
"""This variance is added to every feature, and all correlations shrink by this share."""
SPREAD = 0.8
"""The deviations of a taught activity with many demonstrations, relative to those of an average activity."""
FAVOUR = 0.5
"""The cost (see `_compared`) of a taught activity is lowered by this number, so that it wins a close comparison."""
LIMIT = 4.0
"""The maximum distance of a movement from the taught activity to which it belongs (mean squared deviation of the
features)."""
REMEMBERED = 64
"""The maximum number of inverse matrices to keep. Each set of visible features needs one matrix."""
RUNNERS_UP = 3
"""The maximum number of next most likely names."""
FAR = 3.0
"""An activity farther from the movement than this many times the limit (see `LIMIT`) is not among the next most likely
names: it looks too different."""


@dataclass(frozen=True, slots=True)
class Recognition:
    """The result of a recognition."""

    name: str = ""
    """The name of the activity. It is empty if the movement is unknown, or if too little of the body is visible."""
    confidence: float = 0.0
    """The probability of the name, from 0 to 1."""
    others: tuple[tuple[str, float], ...] = ()
    """The next most likely names, with their confidence."""
    nearest: str = ""
    """The most probable activity, even if the movement is too far from it. It is empty if one of the *other* movements is
    more probable, or if too little of the body is visible."""
    distance: float = float("inf")
    """The distance from the most probable activity or *other* movement (mean squared deviation of the
    features), divided by the limit. It is infinite if too little of the body is visible."""


@dataclass(frozen=True, slots=True, eq=False)
class Starter:
    """The activities that the recogniser knows from the beginning, as Gaussians."""

    names: tuple[str, ...]
    """The name of each activity; empty for one of the *other* movements."""
    means: NDArray[Any]
    """(activities, features): the means of the normalised features."""
    deviations: NDArray[Any]
    """(activities, features): the deviations of the normalised features."""
    centre: NDArray[Any]
    """(features,): the values that are subtracted from features to normalise them."""
    size: NDArray[Any]
    """(features,): the values by which features are divided after this subtraction."""
    usual: NDArray[Any]
    """(features,): the deviations of an average activity."""
    correlation: NDArray[Any]
    """(features, features): the correlation matrix of the features."""
    limit: float
    """A movement farther than this from an activity does not belong to it."""
    heat: float
    """Log likelihoods are divided by this number, to calibrate the confidence."""

    @classmethod
    def load(cls) -> Starter:
        """Return the starter set that comes with the module.

        Raises:
            PlatformError: numpy is missing.
        """
        np = numpy()
        with (files(__name__.rpartition(".")[0]) / "starter.npz").open("rb") as file:
            data = dict(np.load(file))
        names = tuple(str(name) for name in data.pop("names"))
        limit, heat = float(data.pop("limit")), float(data.pop("heat"))
        return cls(names=names, limit=limit, heat=heat, **{key: value.astype(float) for key, value in data.items()})

    @classmethod
    def learn(cls, examples: Mapping[str, Sequence[NDArray[Any]]], others: Sequence[Sequence[NDArray[Any]]]) -> Starter:
        """Return a starter set whose `limit` and `heat` are both 1.0.

        Args:
            examples: The features of the performances of each activity, by the activity's name.
            others: The features of the performances of each *other* movement.
        """
        np = numpy()
        names = (*examples, *("" for _ in others))
        groups = [np.array(group) for group in (*examples.values(), *others)]
        everything = np.concatenate(groups)
        centre, size = np.nanmean(everything, axis=0), np.nanstd(everything, axis=0) + 1e-6
        groups = [(group - centre) / size for group in groups]
        means = np.stack([np.nanmean(group, axis=0) for group in groups])
        rests = [group - mean for group, mean in zip(groups, means, strict=True)]
        usual = np.nanmean(np.concatenate(rests) ** 2, axis=0)
        own = np.stack([np.nanmean(rest**2, axis=0) for rest in rests])
        deviations = np.sqrt((1 - OWN) * usual + OWN * own + RIDGE)
        scaled = np.concatenate([rest / deviation for rest, deviation in zip(rests, deviations, strict=True)])
        known = (~np.isnan(scaled)).astype(float)
        filled = np.nan_to_num(scaled)
        common = filled.T @ filled / np.maximum(known.T @ known, 1)
        spread = np.sqrt(np.diag(common))
        values, vectors = np.linalg.eigh(common / np.outer(spread, spread))
        correlation = (vectors * np.maximum(values, 1e-3)) @ vectors.T
        correlation = (1 - RIDGE) * correlation + RIDGE * np.eye(len(correlation))
        return cls(names, means, deviations, centre, size, np.sqrt(usual + RIDGE), correlation, 1.0, 1.0)


class Recogniser:
    """The starter set, and the activities that users have taught. Not thread-safe: use it from one thread at a time."""

    def __init__(self, starter: Starter | None = None) -> None:
        """Load the starter set, unless one is given.

        Raises:
            PlatformError: numpy is missing.
        """
        self._np = numpy()
        self.starter = starter or Starter.load()
        self._taught: dict[str, list[NDArray[Any]]] = {}
        self._inverses: dict[bytes, Any] = {}
        self._arrange()

    def __repr__(self) -> str:
        return f"Recogniser({len(self.names)} activities)"

    @property
    def names(self) -> tuple[str, ...]:
        """The names of all activities, in alphabetical order."""
        return tuple(sorted({name for name in self._names if name}))

    @property
    def taught(self) -> frozenset[str]:
        """The names of the activities that users have taught."""
        return frozenset(self._taught)

    def teach(self, name: str, poses: Sequence[Pose]) -> bool:
        """Learn an activity from a demonstration. Return False if the demonstration shows too little of the body.

        Args:
            name: A new name, or the name of a known activity.
            poses: The poses of the demonstration, which lasts about three seconds.
        """
        skeleton = skeleton_of(poses)
        if skeleton is None:
            return False
        self.teach_features(name, (features_of(skeleton), features_of(skeleton.mirrored())))
        return True

    def teach_features(self, name: str, sides: Sequence[NDArray[Any]]) -> None:
        """Learn an activity from the features of a demonstration, and the features of its mirror image.

        People may demonstrate with the left or the right hand. So the recogniser keeps either the demonstration or its
        mirror image: the one that is nearer to the activity's earlier demonstrations.
        """
        np, group = self._np, self._taught.setdefault(name, [])
        both = [(side - self.starter.centre) / self.starter.size for side in sides]
        if group:
            mean = _mean(np.array(group))
            away = [np.nanmean(((side - mean) / self.starter.usual) ** 2) for side in both]
            both = [both[int(np.argmin(away))]]
        group.append(both[0])
        self._arrange()

    def recognise(self, poses: Sequence[Pose]) -> Recognition:
        """Return the activity in a movement.

        Args:
            poses: The poses of one body in about three seconds.
        """
        skeleton = skeleton_of(poses)
        if skeleton is None:
            return Recognition()
        return self.recognise_features((features_of(skeleton), features_of(skeleton.mirrored())))

    def recognise_features(self, sides: Sequence[NDArray[Any]]) -> Recognition:
        """Return the activity in a movement, from its features.

        Args:
            sides: The features of a movement, and the features of its mirror image.
        """
        np = self._np
        pairs = [self._compared((side - self.starter.centre) / self.starter.size) for side in sides]
        better = np.argmin([cost for _, cost, _ in pairs], axis=0)
        distance = np.choose(better, [one for one, _, _ in pairs])
        cost = np.min([cost for _, cost, _ in pairs], axis=0)
        weight = np.exp(-0.5 * (cost - cost.min()) * pairs[0][2] / self.starter.heat)
        probability: dict[str, float] = {}
        for name, one in zip(self._names, weight / weight.sum(), strict=True):
            probability[name] = probability.get(name, 0.0) + float(one)
        best = int(np.argmin(cost))
        name, away = self._names[best], float(distance[best] / self._limits[best])
        if not name or away > 1.0:
            return Recognition(nearest=name, distance=away)
        reachable = {
            other for other, far, limit in zip(self._names, distance, self._limits, strict=True) if far <= FAR * limit
        }
        others = sorted(
            ((other, p) for other, p in probability.items() if other in reachable - {name, ""}),
            key=lambda pair: -pair[1],
        )[:RUNNERS_UP]
        return Recognition(name, probability[name], tuple(others), name, away)

    def _arrange(self) -> None:
        """Join the taught activities and the activities of the starter set."""
        np, starter = self._np, self.starter
        taught = {name: np.array(group) for name, group in self._taught.items()}
        self._names = (*starter.names, *taught)
        means = [_mean(group) for group in taught.values()]
        # The mean of a few demonstrations is uncertain, so a movement may be farther away from it.
        wider = [SPREAD * starter.usual * np.sqrt(1 + 1 / len(group)) for group in taught.values()]
        self._means = np.stack([*starter.means, *means])
        self._deviations = np.stack([*starter.deviations, *wider])
        self._favour = np.array([0.0] * len(starter.names) + [FAVOUR] * len(taught))
        self._limits = np.array([starter.limit] * len(starter.names) + [LIMIT] * len(taught))

    def _compared(self, features: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any], int]:
        """Return the distance from each activity, a cost for each activity, and the number of visible features.

        The cost is twice the negative log likelihood per feature, less `FAVOUR` for a taught activity.
        """
        np = self._np
        visible = ~np.isnan(features)
        key = visible.tobytes()
        if key not in self._inverses:
            if len(self._inverses) >= REMEMBERED:
                self._inverses.clear()
            self._inverses[key] = np.linalg.inv(self.starter.correlation[np.ix_(visible, visible)])
        deviations = self._deviations[:, visible]
        away = np.nan_to_num((features[visible] - self._means[:, visible]) / deviations)
        count = int(visible.sum())
        distance = np.einsum("ci,ij,cj->c", away, self._inverses[key], away) / count
        return distance, distance + 2 * np.log(deviations).sum(axis=1) / count - self._favour, count


def _mean(group: NDArray[Any]) -> NDArray[Any]:
    np = numpy()
    visible = ~np.isnan(group)
    total = np.where(visible, group, 0.0).sum(axis=0)
    return np.where(visible.any(axis=0), total / np.maximum(visible.sum(axis=0), 1), np.nan)


def numpy() -> Any:
    """Return numpy.

    Raises:
        PlatformError: numpy is missing.
    """
    try:
        return import_module("numpy")
    except ImportError as error:
        raise PlatformError("activity needs numpy: pip install 'ravestate[activity]'") from error


__all__ = ["COUNT", "Recogniser", "Recognition", "Starter"]
