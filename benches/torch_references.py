"""What PyTorch makes of the operations of `seeone-nn`, for its test `tests/torch.rs`.

    python3 -m venv out/venv && out/venv/bin/pip install torch numpy safetensors
    out/venv/bin/python benches/torch_references.py framework/nn/tests/torch.safetensors

Each case has its inputs, its output and the gradients of sum(output * probe) at every
differentiable input, all made from the seed below.
"""

import sys

import torch
import torch.nn.functional as F
from safetensors.torch import save_file

torch.manual_seed(7)
STORED = {}


def draw(*shape):
    return torch.randn(*shape).requires_grad_()


def store(case, output, **inputs):
    """Stores a case; an input that asks for a gradient gets it stored too."""
    probe = torch.randn_like(output)
    wanted = {name: x for name, x in inputs.items() if x.requires_grad}
    gradients = torch.autograd.grad((output * probe).sum(), list(wanted.values()))
    STORED[f"{case}.output"], STORED[f"{case}.probe"] = output.detach(), probe
    for name, x in inputs.items():
        STORED[f"{case}.{name}"] = x.detach()
    for name, gradient in zip(wanted, gradients):
        STORED[f"{case}.{name}.gradient"] = gradient


def linear():
    x, w, b = draw(9, 6), draw(6, 5), draw(5)
    store("linear", torch.relu(x @ w + b), x=x, w=w, b=b)


def layer_norm():
    x, scale, shift = draw(7, 12), draw(12), draw(12)
    store("layer_norm", F.layer_norm(x, (12,), scale, shift), x=x, scale=scale, shift=shift)


def set_abstraction():
    """The PointNet++ block as it is usually written: group, subtract, two layers, maximum."""
    features, points = draw(20, 4), torch.rand(20, 3)
    centres = points[[0, 3, 5, 8, 11, 13]]
    near = torch.cdist(centres, points).topk(5, largest=False).indices
    first, bias, second = draw(7, 6), draw(6), draw(6, 8)
    grouped = torch.cat([features[near], points[near] - centres[:, None]], -1)
    output = (torch.relu(grouped @ first + bias) @ second).max(1).values
    store(
        "set_abstraction", output, features=features, points=points, centres=centres,
        near=near.to(torch.float32), first=first, bias=bias, second=second,
    )  # fmt: skip


def three_nearest():
    sources, targets, features = torch.rand(12, 3), torch.rand(30, 3), draw(12, 5)
    squared, near = torch.cdist(targets, sources).square().topk(3, largest=False)
    shares = 1 / (squared + 1e-8)
    shares = shares / shares.sum(1, keepdim=True)
    output = (features[near] * shares[..., None]).sum(1)
    store("three_nearest", output, sources=sources, targets=targets, features=features)


def attention():
    """Two clouds of 6 tokens, 2 heads of 4 columns; queries, keys, values side by side."""
    qkv = draw(12, 24)
    q, k, v = qkv.view(2, 6, 3, 2, 4).permute(2, 0, 3, 1, 4)
    output = F.scaled_dot_product_attention(q, k, v).transpose(1, 2).reshape(12, 8)
    store("attention", output, qkv=qkv)


def cross_entropy():
    """Three coordinates a row, 64 bins, targets of 1.5 bins' deviation cut off at 6 bins."""
    logits, values, weights = draw(8, 192), torch.rand(8, 3), torch.rand(8)
    place = values[..., None] * 64
    bins = torch.arange(64)
    target = torch.exp(-0.5 * ((bins + 0.5 - place) / 1.5) ** 2)
    target = torch.where((bins - place.floor()).abs() <= 6, target, 0.0)
    target = target / target.sum(-1, keepdim=True)
    each = -(target * F.log_softmax(logits.view(8, 3, 64), -1)).sum(-1)
    loss = (each * weights[:, None]).sum() / (3 * weights.sum())
    store("cross_entropy", loss.view(1), logits=logits, values=values, weights=weights)


def conv3d(case, stride):
    """Grids as matrices: rows z, y, x by channels; weights tap by tap."""
    x, w = draw(2 * 6**3, 3), draw(27 * 3, 4)
    grids = x.view(2, 6, 6, 6, 3).permute(0, 4, 1, 2, 3)
    kernel = w.view(3, 3, 3, 3, 4).permute(4, 3, 0, 1, 2)
    output = F.conv3d(grids, kernel, stride=stride, padding=1)
    store(case, output.permute(0, 2, 3, 4, 1).reshape(-1, 4), x=x, w=w)


def trilinear():
    grids, queries = draw(2 * 5**3, 3), torch.rand(2, 11, 3)
    volume = grids.view(2, 5, 5, 5, 3).permute(0, 4, 1, 2, 3)
    at = (2 * queries - 1).view(2, 1, 1, 11, 3)
    output = F.grid_sample(volume, at, padding_mode="border", align_corners=False)
    output = output.view(2, 3, 11).transpose(1, 2).reshape(22, 3)
    store("trilinear", output, grids=grids, queries=queries.reshape(22, 3))


def main():
    linear()
    layer_norm()
    set_abstraction()
    three_nearest()
    attention()
    cross_entropy()
    conv3d("conv3d", 1)
    conv3d("conv3d_stride_2", 2)
    trilinear()
    stored = {name: x.contiguous() for name, x in STORED.items()}
    save_file(stored, sys.argv[1], {"torch": torch.__version__})


if __name__ == "__main__":
    main()
