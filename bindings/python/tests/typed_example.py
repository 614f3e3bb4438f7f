"""A program as users write it; mypy and pyright check its types."""

import numpy as np
import numpy.typing as npt

import supple


def fall(frames: int) -> list[int]:
    """Lets a sheet fall on a ball; returns the number of pairs within the margins of each frame."""
    scene = supple.Scene(contacts={"intersection", "proximity"})
    cloth = supple.make_cloth(20, 20)
    x: npt.NDArray[np.float64] = np.array(cloth.positions) + [0.0, 1.1, 0.0]
    sheet: supple.Object = scene.add(x, cloth.triangles, name="sheet", self_collision=True, margin=0.01)
    ball = scene.add(supple.make_icosphere(8), static=True, margin=0.01)
    counts: list[int] = []
    for _ in range(frames):
        x[:, 1] -= 0.01
        sheet.positions = x
        result: supple.Result = scene.detect(max_contacts=10_000)
        pairs: supple.Table = result.proximity
        counts.append(len(pairs))
        if len(pairs):
            vertices: npt.NDArray[np.uint32] = pairs["vertices"]
            assert vertices.shape == (len(pairs), 2, 3)
    step: supple.SafeStep = scene.collision_free_step()
    nearest = scene.distance(sheet, ball)
    assert nearest is not None and 0 <= step.step <= 1
    kind: supple.FeatureKind = supple.FeatureKind.edge
    assert kind == 1
    return counts


if __name__ == "__main__":
    print(fall(15))
