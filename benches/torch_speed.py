"""The refiner of `nst` in PyTorch on one core: the same layers, sizes and index tables.

    python3 -m venv out/venv && out/venv/bin/pip install torch numpy
    taskset -c 0 cargo bench -p seeone-nst --bench speed -- --quick refiner
    OMP_NUM_THREADS=1 taskset -c 0 out/venv/bin/python benches/torch_speed.py

The tables are made before the clock starts, here as there ("neighbourhoods" tells what they
cost in ours). Grouping is written as PointNet++ does it: gather the neighbours' inputs,
two layers on every neighbour, maximum.
"""

import time

import torch
import torch.nn.functional as F
from torch import nn

CLOUDS, POINTS, NEIGHBOURS, BINS = 4, 512, 24, 64
CENTRES, TOKENS, QUERIES, WIDTH = POINTS // 4, POINTS // 16, POINTS // 2, 128
SECONDS = 5.0


class SetAbstraction(nn.Module):
    def __init__(self, inputs, outputs):
        super().__init__()
        self.first, self.second = nn.Linear(inputs, outputs), nn.Linear(outputs, outputs, False)
        self.norm = nn.LayerNorm(outputs)

    def forward(self, features, points, centres, near):
        grouped = points[near] - centres[:, None]
        if features is not None:
            grouped = torch.cat([features[near], grouped], -1)
        lifted = self.second(torch.relu(self.first(grouped)))
        return torch.relu(self.norm(lifted.max(1).values))


class FeaturePropagation(nn.Module):
    def __init__(self, coarse, fine, outputs):
        super().__init__()
        self.first, self.norm = nn.Linear(coarse + fine, outputs), nn.LayerNorm(outputs)
        self.last = nn.Linear(outputs, outputs)

    def forward(self, coarse, fine, near, shares):
        carried = (coarse[near] * shares[..., None]).sum(1)
        mixed = torch.relu(self.norm(self.first(torch.cat([carried, fine], -1))))
        return torch.relu(self.last(mixed))


class Refiner(nn.Module):
    def __init__(self):
        super().__init__()
        self.sa1, self.sa2 = SetAbstraction(3, 64), SetAbstraction(64 + 3, WIDTH)
        self.position = nn.Linear(3, WIDTH)
        layer = nn.TransformerEncoderLayer(
            WIDTH, 4, 2 * WIDTH, 0.0, batch_first=True, norm_first=True
        )
        self.attention = nn.TransformerEncoder(layer, 3, enable_nested_tensor=False)
        self.fp1 = FeaturePropagation(WIDTH, 64 + 3, WIDTH)
        self.fp2 = FeaturePropagation(WIDTH, 3, WIDTH)
        self.hidden, self.head = nn.Linear(WIDTH, WIDTH), nn.Linear(WIDTH, 3 * BINS)

    def forward(self, t):
        fine = self.sa1(None, t["points"], t["centres"], t["near_centres"])
        tokens = self.sa2(fine, t["centres"], t["tokens"], t["near_tokens"])
        tokens = (tokens + self.position(t["tokens"])).view(CLOUDS, TOKENS, WIDTH)
        tokens = self.attention(tokens).view(-1, WIDTH)
        placed = torch.cat([fine, t["centres"]], -1)
        centres = self.fp1(tokens, placed, *t["to_centres"])
        features = self.fp2(centres, t["queries"], *t["to_queries"])
        return self.head(torch.relu(self.hidden(features)))


def tables():
    """Random clouds; neighbours from anywhere in the own cloud cost what near ones do."""

    def rows(count, of, number):
        own = torch.arange(CLOUDS).repeat_interleave(count)[:, None] * of
        return own + torch.randint(of, (CLOUDS * count, number))

    def points(count):
        return torch.rand(CLOUDS * count, 3)

    def mixed(count, of):
        return rows(count, of, 3), torch.full((CLOUDS * count, 3), 1 / 3)

    return {
        "points": points(POINTS), "centres": points(CENTRES), "tokens": points(TOKENS),
        "queries": points(QUERIES), "near_centres": rows(CENTRES, POINTS, NEIGHBOURS),
        "near_tokens": rows(TOKENS, CENTRES, NEIGHBOURS), "to_centres": mixed(CENTRES, TOKENS),
        "to_queries": mixed(QUERIES, CENTRES),
    }  # fmt: skip


def median_ms(work):
    work()
    times, end = [], time.perf_counter() + SECONDS
    while time.perf_counter() < end:
        start = time.perf_counter()
        work()
        times.append(1e3 * (time.perf_counter() - start))
    return sorted(times)[len(times) // 2]


def main():
    torch.manual_seed(1)
    torch.set_num_threads(1)
    refiner, table = Refiner(), tables()
    target = torch.softmax(torch.randn(CLOUDS * QUERIES, 3, BINS), -1)

    def forward():
        with torch.no_grad():
            refiner(table)

    def step():
        refiner.zero_grad()
        logits = refiner(table).view(-1, 3, BINS)
        F.cross_entropy(logits.transpose(1, 2), target.transpose(1, 2)).backward()

    count = sum(p.numel() for p in refiner.parameters())
    print(f"PyTorch {torch.__version__}, {count} parameters, 4 clouds of {POINTS} points, one core")
    print(f"forward              {median_ms(forward):7.1f} ms")
    print(f"forward and backward {median_ms(step):7.1f} ms")


if __name__ == "__main__":
    main()
