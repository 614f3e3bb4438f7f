"""The contacts of 16 balls that fall on a floor, whose parts are on all ranks.

mpirun -n 4 python -m mpi4py many_ranks.py
"""

import numpy as np
from mpi4py import MPI

import supple

scene = supple.DistributedScene(MPI.COMM_WORLD)
rank, ranks = scene.rank, scene.rank_count

# Object 0 is the floor. Each rank has a strip of it.
floor = supple.make_cloth(40, 40, 8, 8)
V, F = np.asarray(floor.positions), np.asarray(floor.triangles)
strip = np.floor((V[F, 0].min(axis=1) + 4) / 8 * ranks) == rank
vertices, corners = np.unique(F[strip], return_inverse=True)
scene.add_part(
    V[vertices],
    corners.reshape(-1, 3),
    vertices,
    np.flatnonzero(strip),
    id=0,
    name="floor",
    static=True,
)

# Objects 1 to 16 are balls. Each rank has every ranks-th of them.
ball = supple.make_icosphere(8)


def place(i, frame):
    squeezed = np.asarray(ball.positions) * [1, 1 - 0.0625 * frame, 1]
    return squeezed + [1.6 * (i % 4) - 2.4, 0.9 - 0.125 * frame, 1.6 * (i // 4) - 2.4]


balls = {i: scene.add(place(i, 0), ball.triangles, id=1 + i) for i in range(rank, 16, ranks)}
for frame in range(5):
    for i, each in balls.items():
        each.positions = place(i, frame)  # your simulation goes here
    result = scene.detect()  # all ranks call it; the contacts are on rank 0
    if rank == 0:
        print(f"frame {frame}: {len(result.contacts)} contacts of {len(result.groups)} pairs")
