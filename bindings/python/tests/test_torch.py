"""The losses of PyTorch, where it is installed."""

import numpy as np
import pytest

import supple

torch = pytest.importorskip("torch")
from supple import torch as losses  # noqa: E402


def tensors(mesh, offset=(0, 0, 0), scale=1.0):
    x = torch.tensor(np.asarray(mesh.positions) * scale + np.asarray(offset), dtype=torch.float64)
    return x.requires_grad_(), np.asarray(mesh.triangles)


def noisy(mesh, rng):
    """No features that are equally near: the losses have no gradient there."""
    return supple.Mesh(
        np.asarray(mesh.positions) + 0.03 * rng.normal(size=(len(mesh.positions), 3)), mesh.triangles
    )


def test_gradients(rng):
    mesh = noisy(supple.make_icosphere(1), rng)
    a, faces = tensors(mesh)
    b, _ = tensors(noisy(supple.make_icosphere(1), rng), (2.05, 0.1, 0.2))
    assert losses.proximity_loss(a, faces, b, faces, 0.5) > 0
    assert torch.autograd.gradcheck(
        lambda p, q: losses.proximity_loss(p, faces, q, faces, 0.5), (a, b), eps=1e-7, atol=1e-5
    )
    inner, _ = tensors(noisy(supple.make_icosphere(1), rng), (1.3, 0.1, 0.2))
    assert losses.penetration_loss(inner, faces, a, faces) > 0
    assert torch.autograd.gradcheck(
        lambda p, q: losses.penetration_loss(p, faces, q, faces), (inner, a), eps=1e-7, atol=1e-5
    )
    both = torch.cat([a, inner]).detach().requires_grad_()
    joined = np.concatenate([faces, faces + len(a)])
    assert losses.self_penetration_loss(both, joined) > 0
    assert torch.autograd.gradcheck(
        lambda p: losses.self_penetration_loss(p, joined), (both,), eps=1e-7, atol=1e-5
    )


def test_batches(rng):
    mesh = supple.make_icosphere(2)
    x, faces = tensors(mesh)
    y = torch.stack([x.detach() + torch.tensor([2.0 + 0.1 * i, 0, 0]) for i in range(3)]).requires_grad_()
    batch = losses.proximity_loss(x, faces, y, faces, 0.3)
    single = torch.stack([losses.proximity_loss(x, faces, each, faces, 0.3) for each in y])
    assert batch.shape == (3,) and torch.equal(batch, single)
    batch.sum().backward()
    assert y.grad is not None and y.grad.shape == y.shape
    far = losses.self_penetration_loss(y, faces, 0.0)
    assert far.shape == (3,) and far.sum() == 0
    far.sum().backward()
    assert losses.proximity_loss(x.float(), faces, y.float(), faces, 0.3).dtype == torch.float32
    with pytest.raises(supple.Error, match="shapes"):
        losses.proximity_loss(y[:2], faces, y, faces, 0.3)


@pytest.mark.parametrize("value", [float("nan"), float("inf")])
def test_a_body_that_is_not_finite_has_no_loss(value):
    x, faces = tensors(supple.make_icosphere(2))
    far, _ = tensors(supple.make_icosphere(2), (9, 0, 0))
    for loss in (
        lambda p: losses.proximity_loss(p, faces, far, faces, 0.3),
        lambda p: losses.proximity_loss(far, faces, p, faces, 0.3),
        lambda p: losses.penetration_loss(p, faces, far, faces),
        lambda p: losses.self_penetration_loss(p, faces, 0.01),
        lambda p: losses.self_penetration_loss(torch.stack([far, p]), faces)[1],
    ):
        bad = x.detach().clone()
        bad[3, 1] = value
        bad.requires_grad_()
        found = loss(bad)
        assert torch.isnan(found)
        found.backward()
        assert torch.isnan(bad.grad).nonzero().tolist() == [[3, 1]]
    whole = torch.full_like(x, value).requires_grad_()
    assert torch.isnan(losses.penetration_loss(whole, faces, x, faces))
    assert losses.penetration_loss(far, faces, x, faces) == 0
    batch = losses.self_penetration_loss(torch.stack([x, whole]), faces)
    assert batch[0] == 0 and torch.isnan(batch[1])


def test_a_folded_body_is_freed():
    from folded_body import faces_of_limb, folded_pose, limb, self_contacts

    faces, pose = faces_of_limb(), folded_pose().requires_grad_()
    assert self_contacts(limb(pose), faces) > 100
    adam = torch.optim.Adam([pose], lr=0.05)
    pairs = losses.Pairs((faces,), margin=0.01)
    for _ in range(50):
        adam.zero_grad()
        pairs.self_penetration(limb(pose)).backward()
        adam.step()
    assert self_contacts(limb(pose), faces) == 0


def test_tensors_are_positions():
    scene = supple.Scene()
    mesh = supple.make_box()
    each = scene.add(
        torch.tensor(np.asarray(mesh.positions), dtype=torch.float32, requires_grad=True),
        torch.tensor(np.asarray(mesh.triangles).astype(np.int64)),
    )
    np.testing.assert_array_equal(each.positions, mesh.positions)
