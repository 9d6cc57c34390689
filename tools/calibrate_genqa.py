"""Calibrate the confidence of the module genqa: fit its constants to questions whose answers are known.

    python tools/calibrate_genqa.py

The tool answers each question of tests/modules/skill/genqa/questions.yaml and compares the answer with the expected one. A
logistic regression then estimates the probability of a right answer from two numbers: the score of the passage, and its
coverage of the question. Copy the printed constants to genqa/confidence.py. For a held-out estimate, the tool first fits
each half of the questions and measures the other half.
"""

from __future__ import annotations

import re
import tempfile
from pathlib import Path

import numpy as np
import yaml

from ravestate.modules.skill.genqa import Settings
from ravestate.modules.skill.genqa.answering import Answer, Answerer

QUESTIONS = Path(__file__).resolve().parents[1] / "tests/modules/skill/genqa/questions.yaml"
PRIOR = 0.05
"""The regularisation: it keeps the constants small."""


def is_right(answer: Answer, wanted: object) -> bool:
    """Return whether an answer matches the expected pattern."""
    return wanted is not None and re.search(str(wanted), answer.text) is not None


def fit(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Fit a logistic regression by Newton's method; the first column of `x` is 1."""
    w = np.zeros(x.shape[1])
    penalty = np.diag([0.0] + [PRIOR] * (x.shape[1] - 1))
    for _ in range(100):
        p = 1 / (1 + np.exp(-x @ w))
        step = np.linalg.solve((x.T * (p * (1 - p))) @ x + penalty, x.T @ (y - p) - penalty @ w)
        w += step
        if np.abs(step).max() < 1e-9:
            break
    return w


def table(p: np.ndarray, y: np.ndarray) -> None:
    """Print the effect of several thresholds."""
    print("threshold  answered  right  wrong  share wrong")
    for threshold in (0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9):
        told = p >= threshold
        wrong = int((told & (y == 0)).sum())
        print(
            f"{threshold:9.1f}  {told.sum():8d}  {int((told & (y == 1)).sum()):5d}  {wrong:5d}  {wrong / max(1, told.sum()):10.1%}"
        )


def main() -> None:
    """Answer, fit, print."""
    asked = yaml.safe_load(QUESTIONS.read_text(encoding="utf-8"))
    rows, right, missed, wrong = [], [], [], []
    with tempfile.TemporaryDirectory() as folder:
        answerer = Answerer(Path(folder) / "index.sqlite")
        for text, wanted in asked.items():
            answer = answerer.answer(text)
            if answer.text:
                best = answer.candidates[0]
                rows.append((1.0, best.score, best.covered))
                right.append(is_right(answer, wanted))
                if not right[-1] and answer.confidence >= Settings().sure:
                    wrong.append(f"{answer.confidence:.2f} {text} -> {answer.text}")
            if wanted is not None and not is_right(answer, wanted):
                missed.append(f"{text} -> {answer.text or answer.reason}")
        answerer.close()
    x, y = np.array(rows), np.array(right, dtype=float)
    answerable = sum(wanted is not None for wanted in asked.values())
    print(
        f"{len(asked)} questions, {answerable} answerable; {int(y.sum())} found, {len(y)} answers before any threshold"
    )
    held_out = np.zeros(len(y))
    for half in (0, 1):
        held_out[half::2] = 1 / (1 + np.exp(-x[half::2] @ fit(x[1 - half :: 2], y[1 - half :: 2])))
    print("\nHeld out:")
    table(held_out, y)
    w = fit(x, y)
    print("\nAll:")
    table(1 / (1 + np.exp(-x @ w)), y)
    print(f"\nINTERCEPT, SCORE, COVERED = {', '.join(f'{value:.3f}' for value in w)}")
    print("\nNot found:", *missed, sep="\n  ")
    print("\nWrong, and not doubted:", *wrong, sep="\n  ")


if __name__ == "__main__":
    main()
