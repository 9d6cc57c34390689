"""Measure how often the agent confuses faces, and print the table for the documentation.

    PYTHONPATH=tests python -m modules.modality.visionio.error_curve

The photos in `photographs` show 14 faces of nine people. From each photo, the tool also makes worse pictures: dark,
blurred, and so on. The agent wrongly refuses a pair of pictures of one person if their distance is above the threshold. It
wrongly accepts pictures of two people if their distance is at most the threshold.
"""

import tempfile
from itertools import combinations
from math import dist
from pathlib import Path

from modules.modality.visionio.photographs import OBAMA, OTHERS, eye, faces, look, make, photo

CONDITIONS = ("as it is", "far", "dark", "blurred", "noisy", "tilted", "compressed")
THRESHOLDS = (0.40, 0.45, 0.50, 0.55, 0.60, 0.65, 0.70)

WORSE = """
picture = cv2.imread(a[0])
x, y, w, h = map(int, a[3:7])
top, left = max(0, y - h // 2), max(0, x - w // 2)
face = picture[top:y + 3 * h // 2, left:x + 3 * w // 2]
scale = 220 / w
face = cv2.resize(face, None, fx=scale, fy=scale)
kind = a[2]
if kind == "far":
    face = cv2.resize(face, None, fx=0.25, fy=0.25, interpolation=cv2.INTER_AREA)
elif kind == "dark":
    face = (face * 0.25).astype(np.uint8)
elif kind == "blurred":
    face = cv2.GaussianBlur(face, (0, 0), 4)
elif kind == "noisy":
    face = np.clip(face + np.random.default_rng(1).normal(0, 25, face.shape), 0, 255).astype(np.uint8)
elif kind == "tilted":
    height, width = face.shape[:2]
    turn = cv2.getRotationMatrix2D((width / 2, height / 2), 15, 1)
    face = cv2.warpAffine(face, turn, (width, height), borderMode=cv2.BORDER_REPLICATE)
elif kind == "compressed":
    face = cv2.imdecode(cv2.imencode(".jpg", face, [cv2.IMWRITE_JPEG_QUALITY, 12])[1], cv2.IMREAD_COLOR)
face = cv2.copyMakeBorder(face, 60, 60, 60, 60, cv2.BORDER_REPLICATE)
cv2.imwrite(a[1], face)
"""


def seen() -> tuple[dict[tuple[str, str], tuple[float, ...]], int]:
    """Return the vector of each face under each condition, and the number of faces that were not found."""
    found: dict[tuple[str, str], tuple[float, ...]] = {}
    missed = 0
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "worse.png"
        for name, face in faces().items():
            for kind in CONDITIONS:
                source = photo(name if "six" not in name else "six")
                make(WORSE, source, file, kind, *face.box)
                each = look(file.read_bytes())["faces"]
                if len(each) != 1:
                    missed += 1
                else:
                    found[name, kind] = tuple(each[0]["vector"])
    return found, missed


def person(name: str) -> str:
    return "obama" if name in OBAMA else name


def main() -> None:
    """Measure all pairs of pictures, and print the table."""
    found, missed = seen()
    same: list[float] = []
    different: list[float] = []
    for (one, kind), (other, condition) in combinations(found, 2):
        if one == other:
            continue  # skip pairs that come from the same photo
        distance = dist(found[one, kind], found[other, condition])
        (same if person(one) == person(other) else different).append(distance)
    print(
        f"{len(faces())} faces of {1 + len(OTHERS)} people, {len(CONDITIONS)} conditions: {len(found)} found, {missed} not"
    )
    print(f"{len(same)} pairs of one person, {len(different)} pairs of two people")
    print("| threshold | one person, wrongly refused | two people, wrongly accepted |\n| --- | --- | --- |")
    for threshold in THRESHOLDS:
        refused = sum(one > threshold for one in same) / len(same)
        accepted = sum(one <= threshold for one in different) / len(different)
        print(f"| {threshold:.2f} | {100 * refused:.2f} % | {100 * accepted:.2f} % |")
    eye().close()


if __name__ == "__main__":
    main()
