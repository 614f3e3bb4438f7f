"""A body model that folds into itself: a limb whose pose has one angle for each joint."""

import numpy as np
import torch

import supple

RINGS, SIDES, JOINTS = 60, 12, 6


def faces_of_limb():
    """The triangles of a closed tube, (m, 3)."""
    ring = np.arange(SIDES)
    low = (np.arange(RINGS - 1)[:, None] * SIDES + ring).ravel()
    next_low = (np.arange(RINGS - 1)[:, None] * SIDES + np.roll(ring, -1)).ravel()
    last = (RINGS - 1) * SIDES + ring
    return np.concatenate(
        [
            np.stack([low, low + SIDES, next_low], 1),
            np.stack([next_low, low + SIDES, next_low + SIDES], 1),
            np.stack([ring, np.roll(ring, -1), np.full(SIDES, RINGS * SIDES)], 1),
            np.stack([np.roll(last, -1), last, np.full(SIDES, RINGS * SIDES + 1)], 1),
        ]
    )


def limb(angles, length=1.0, radius=0.06):
    """The vertices (n, 3) of the limb, bent in a plane by these angles in radians, smoothly around each
    joint."""
    place = torch.linspace(0, 1, RINGS, dtype=angles.dtype)
    joints = (torch.arange(JOINTS, dtype=angles.dtype) + 1) / (JOINTS + 1)
    heading = (angles * torch.sigmoid((place[:, None] - joints) * 40)).sum(dim=1)
    along = torch.stack([torch.cos(heading), torch.sin(heading)], dim=1)
    center = torch.cat(
        [torch.zeros(1, 2, dtype=angles.dtype), torch.cumsum(along[:-1], dim=0) * length / (RINGS - 1)]
    )
    out = torch.stack([torch.sin(heading), -torch.cos(heading)], dim=1)
    turn = 2 * torch.pi * torch.arange(SIDES, dtype=angles.dtype) / SIDES
    plane = center[:, None] + radius * torch.cos(turn)[:, None] * out[:, None]
    height = (radius * torch.sin(turn)).expand(RINGS, SIDES)
    tube = torch.cat([plane, height[..., None]], dim=2).reshape(-1, 3)
    ends = torch.cat([center[[0, -1]], torch.zeros(2, 1, dtype=angles.dtype)], dim=1)
    return torch.cat([tube, ends])


def folded_pose():
    """A pose in which the limb cuts itself."""
    return torch.full((JOINTS,), 1.15, dtype=torch.float64)


def self_contacts(vertices, faces):
    """The number of pairs of triangles that intersect."""
    scene = supple.Scene()
    scene.add(vertices, faces, self_collision=True)
    return len(scene.detect().contacts)
