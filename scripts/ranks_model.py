#!/usr/bin/env python3
"""What a step of a large body would take on many ranks, by a model: cuts across one axis, particles
of a rank and its ghosts, messages between neighbours, agreements, and a mesh that every rank has whole.

    scripts/ranks_model.py --ns 23 --ns 82 --mesh-us 0

--ns: measured time of a particle's step on one core, in 2D and in 3D (bench_ranks); --mesh-us: of the
mesh, in each step of the particles. The machine's memory is taken to be as fast for all cores of a node
as for one, its network to have --latency and --bandwidth. Bodies are squares and cubes.
"""
import argparse
import math

# Of a hexagonal and a face-centred cubic body across its layers, d = 1.
LAYER_SPACING = {2: math.sqrt(0.75), 3: math.sqrt(0.5)}
# Ghosts on one side of a part where bonds break by the stresses of faces, in layers (bench_ranks:
# 2634 of 658 a row; 20480 of 4900 a layer).
GHOST_LAYERS = 4.1
GHOST_COST = 0.5  # of a particle's
GHOST_BYTES = {2: 24, 3: 56}
LEAST_LAYERS = 10  # of a part: a ring of ghosts must not reach beyond the neighbour


def step_seconds(dimension, n, ranks, ns, mesh, latency, bandwidth):
    """None where there are too few layers."""
    width = (n * LAYER_SPACING[dimension]) ** (1 / dimension)  # a particle fills a layer's spacing
    layers = width / LAYER_SPACING[dimension]
    layer = n / layers
    if ranks > 1 and layers / ranks < LEAST_LAYERS:
        return None
    sides = min(ranks - 1, 2)
    ghosts = sides * GHOST_LAYERS * layer
    work = (n / ranks + GHOST_COST * ghosts) * ns * 1e-9 + mesh
    if ranks == 1:
        return work
    messages = sides * latency + ghosts * GHOST_BYTES[dimension] / bandwidth
    agreements = 2 * math.ceil(math.log2(ranks)) * latency
    return work + messages + agreements


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--ns", type=float, action="append", help="twice: 2D, 3D")
    parser.add_argument("--mesh-us", type=float, default=0)
    parser.add_argument("--latency", type=float, default=2e-6, help="s")
    parser.add_argument("--bandwidth", type=float, default=1e10, help="bytes/s")
    args = parser.parse_args()
    ns = dict(zip((2, 3), args.ns or (23, 82)))
    counts = (2, 8, 64, 256, 1000)
    print("| particles | " + " | ".join(f"{p} ranks" for p in counts) + " |")
    print("|---" * (len(counts) + 1) + "|")
    for dimension, n in ((2, 1e6), (2, 1e7), (2, 1e9), (3, 1e6), (3, 1e7), (3, 1e8), (3, 1e9)):
        cells = []
        one = step_seconds(dimension, n, 1, ns[dimension], args.mesh_us * 1e-6, args.latency, args.bandwidth)
        for ranks in counts:
            many = step_seconds(dimension, n, ranks, ns[dimension], args.mesh_us * 1e-6, args.latency,
                                args.bandwidth)
            cells.append("-" if many is None else f"{one / (ranks * many):.2f}")
        print(f"| {n:.0e} in {dimension}D | " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main()
