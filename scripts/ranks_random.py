#!/usr/bin/env python3
"""Whether small scenes drawn at random have the same bits on several ranks as on one process: each runs
on one, on several, on several that are cut anew under way, and goes on from one number to another.

    scripts/ranks_random.py --seed 1 --number 20
    scripts/ranks_random.py --seed 1 --only 17        # one of them again
    scripts/ranks_random.py --seed 1 --files          # with packings, bodies and meshes from files

What is drawn at once: packing and its orientation, bodies alone and inside elements (between two sides or
all around), outlines, cutouts, slots, cracks, holes and notches, criteria, scatter, softening, cracks of limited velocity, flow and creep, loads, motions at the
beginning, damping, gauges, regimes, steps of the mesh; with --files two zones in one mesh, too. Scenes that `ligament check -n` refuses are told
and left out. Exit code 1 where anything differs. PATH or --program says which ligament.
"""
import argparse
import itertools
import json
import random
import shutil
import subprocess
import sys
from pathlib import Path

from ranks_identity import differences

# Units of d = 1, E = 1, rho = 1.


def parse():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--number", type=int, default=10)
    parser.add_argument("--only", type=int, help="this scene of the seed alone")
    parser.add_argument("--files", action="store_true", help="each with a packing or a body from a file, or with two zones")
    parser.add_argument("--scratch", type=Path, default=Path("ranks_random"))
    parser.add_argument("--program", default="ligament")
    parser.add_argument("--keep", action="store_true", help="keep the runs of what is equal, too")
    return parser.parse_args()


class Draw:
    """One scene."""

    def __init__(self, seed, number):
        self.random = random.Random(f"{seed} {number}")
        self.dim = 2 if self.chance(0.75) else 3
        self.coupled = self.chance(0.5)
        self.static = self.chance(0.12)
        # Of their own, so that the other draws of a seed stay what they were.
        self.shapes = random.Random(f"{seed} {number} shapes")
        self.around = self.coupled and self.shapes.random() < (0.3 if self.dim == 2 else 0.15)
        self.outlined = not self.coupled and self.shapes.random() < 0.25

    def chance(self, p):
        return self.random.random() < p

    def one_of(self, *values):
        return self.random.choice(values)

    def between(self, low, high):
        return round(self.random.uniform(low, high), 3)

    def vector(self, size):
        return [round(self.random.uniform(-size, size), 6) for _ in range(self.dim)]

    def scene(self):
        scene = {"title": "drawn", "dimension": self.dim, "specimen": self.specimen(),
                 "material": self.material(), "discrete_zone": self.zone()}
        if self.dim == 2 and self.chance(0.3):
            scene["plane"] = "stress"
        if self.coupled:
            self.add_mesh(scene)
        scene["loads"] = self.loads()
        if self.chance(0.25) and not self.static:
            scene["initial_motion"] = self.initial_motion()
        if self.chance(0.25):
            scene["body_force"] = {"acceleration": self.vector(2e-5), "ramp": self.between(5, 30)}
        if self.chance(0.5):
            scene["damping"] = self.damping()
        if self.chance(0.4):
            scene["gauges"] = self.gauges()
        scene["time"] = {"duration": self.between(45, 90)}
        if self.static:
            scene["time"].update({"loading": "static"})
        if self.chance(0.2):
            scene["time"]["stop_when"] = "specimen_broken"
        scene["output"] = {"history_interval": 1.7, "field_interval": 35, "progress_interval": 1000,
                           "checkpoint_interval": 1e-9}
        return scene

    def specimen(self):
        if self.dim == 2:
            self.size = [self.between(24, 44), self.between(95, 130) if self.coupled else self.between(12, 60)]
        else:
            self.size = [self.between(6, 11), self.between(6, 11),
                         self.between(70, 76) if self.coupled else self.between(8, 18)]
        if self.around:  # as far as its mesh needs beside the zone
            self.size = self.size[-1:] * self.dim
        specimen = self.outline() if self.outlined else {"size": self.size}
        if self.chance(0.6):
            specimen["cracks"] = [self.crack() for _ in range(self.one_of(1, 1, 2))]
        if self.dim == 2 and self.chance(0.25):
            specimen["holes"] = [{"centre": [self.between(-4, 4), self.between(-2, 2)], "radius": self.between(2.5, 3)}]
        if self.dim == 2 and self.chance(0.25):
            x = -self.size[0] / 2
            specimen["notches"] = [{"lower": [x - 1, -1.1], "upper": [x + self.between(3, 8), 1.2]}]
        if self.dim == 2 and self.shapes.random() < 0.15:
            specimen["slots"] = [{"from": [-6, self.of_shape(-8, 8)], "to": [self.of_shape(-1, 3), self.of_shape(-8, 8)],
                                  "width": self.of_shape(1.2, 2)}]
        if self.dim == 2 and self.shapes.random() < 0.15:
            x, y = self.of_shape(2, 8), self.of_shape(-8, 4)
            specimen["cutouts"] = [{"outline": [{"at": [x, y]}, {"at": [x + 4, y]},
                                                {"at": [x + 2, y + 4], "centre": [x + 2, y + 1.5]}]}]
        return specimen

    def of_shape(self, low, high):
        return round(self.shapes.uniform(low, high), 3)

    def outline(self):
        """A prism with slanted sides, of the size that a box would have."""
        x, y = self.size[0] / 2, self.size[1] / 2
        corners = [[-x * self.of_shape(0.7, 1), -y], [x, -y], [x * self.of_shape(0.7, 1), y], [-x, y]]
        outline = [{"at": corner + [0] * (self.dim - 2)} for corner in corners]
        outline[0]["side"], outline[2]["side"] = "lower", "upper"
        return {"outline": outline, **({"thickness": self.size[2]} if self.dim == 3 else {})}

    def crack(self):
        if self.around:  # all of it within the zone
            x, to = self.of_shape(-6, 2), self.of_shape(3, 6)
            if self.dim == 2:
                return {"points": [[x, self.of_shape(-2, 2)], [to, self.of_shape(-2, 2)]]}
            return {"points": [[a, 0.3, b] for a, b in ((x, -2), (to, -2), (to, 2), (x, 2))]}
        if self.dim == 2:
            start = [self.between(-10, 10), self.between(-3, 3)]
            return {"points": [start, [start[0] + self.between(3, 16), self.between(-3, 3)]]}
        y, z = self.between(-1, 1), 2 if self.coupled else 7
        return {"points": [[-9, y, -z], [self.between(-2, 2), y, -z], [self.between(-2, 2), y, z], [-9, y, z]]}

    def material(self):
        material = {"youngs_modulus": 1, "poissons_ratio": self.one_of(0.25, 0, -0.1, 0.4, 0.3),
                    "density": 1, "friction": self.one_of(0, 0.4, 0.8)}
        strength = self.between(1e-3, 4e-3)
        law = self.law = self.one_of("elastic", "elastic", "elastic", *(["elastic"] if self.static else ["flow", "creep"]))
        criteria = ["maximum_tension", "maximum_tension", "maximum_tension", "face_tension", "principal_stress", "von_mises", "energy", "mohr_coulomb",
                    "drucker_prager"]
        fracture = {"criterion": self.one_of(*criteria), "strength": strength}
        if fracture["criterion"] == "mohr_coulomb":
            fracture.update({"cohesion": strength, "friction_angle": "30 deg"})
        if fracture["criterion"] == "drucker_prager":
            fracture["compressive_strength"] = 4 * strength
        if law == "elastic" and fracture["criterion"] == "maximum_tension" and self.chance(0.4):
            fracture["energy"] = self.between(2, 6) * strength ** 2
            fracture["softening"] = self.one_of("linear", "bilinear")
        if self.chance(0.3):
            fracture["weibull"] = {"modulus": self.between(5, 15), "reference_area": 1, "seed": self.one_of(1, 2, 3)}
        if self.chance(0.2) and law == "elastic" and "energy" not in fracture and not self.static:
            fracture["crack_velocity"] = self.between(0.05, 0.4)
        material["fracture"] = fracture
        self.softens = "energy" in fracture
        if law == "flow":
            material["plasticity"] = self.one_of(
                {"law": "von_mises", "yield_stress": strength, "saturation": strength, "saturation_rate": 200},
                {"law": "drucker_prager", "cohesion": strength, "friction_angle": "25 deg", "dilatancy_angle": "10 deg"})
        if law == "creep":
            material["viscosity"] = {"branches": [{"share": 0.3, "relaxation_time": 40}]}
        return material

    def zone(self):
        packing = self.one_of("hexagonal", "hexagonal", "square", "random") if self.dim == 2 else \
            self.one_of("fcc", "simple_cubic", "random")
        zone = {"packing": packing, "spacing": 1}
        if packing == "random":
            zone["seed"] = self.one_of(1, 2, 3, 4)
            if self.chance(0.3):
                zone["size_ratio"] = self.between(1.5, 4)
        elif self.chance(0.6):
            zone["orientation"] = self.between(0, 1) if self.dim == 2 else self.vector(0.8)
        if not self.coupled:
            zone["extent"] = "all"
        else:
            axis = self.dim - 1
            lower, upper = [None] * self.dim, [None] * self.dim
            reach = (24, 27) if self.dim == 2 else (18, 19)
            lower[axis], upper[axis] = -self.between(*reach), self.between(*reach)
            if self.around:
                lower, upper = [lower[axis]] * self.dim, [upper[axis]] * self.dim
            zone["region"] = {"lower": lower, "upper": upper}
        return zone

    def add_mesh(self, scene):
        scene["far_field"] = {"cell_size": self.between(3.6, 4.6) if self.dim == 2 else self.between(3.5, 3.8)}
        scene["coupling"] = {"overlap_cells": 2, "transition_cells": self.one_of(2, 3), "guard": "warn",
                             "regime": self.one_of("automatic", "automatic", "linear", "nonlinear"),
                             "step_ratio": self.one_of(1, 1, 2, 3)}
        if self.chance(0.3):
            scene["coupling"]["fine_damper"] = self.one_of(0, 4, 8)
        if self.chance(0.2):
            scene["coupling"]["gap_filter"] = self.one_of(0, 0.2)

    def loads(self):
        names = [["left", "right"], ["lower", "upper"] if self.outlined else ["bottom", "top"], ["back", "front"]]
        axis = self.dim - 1
        component = self.one_of(axis, axis, axis, 0)
        velocity = self.one_of(1, 1, 1, -1) * self.between(1e-3, 6e-3)
        loads = []
        for side in (0, 1):
            v = [None] * self.dim
            v[component] = velocity if side else -velocity
            load = {"boundary": names[axis][side], "velocity": v, "ramp": self.between(5, 30)}
            if side == 0 and self.chance(0.15) and not self.static:
                load = {"boundary": names[axis][side], "absorbing": True, "absorbing_layer": 5}
            loads.append(load)
        if self.chance(0.25) and self.law == "elastic" and not self.softens and not self.coupled:
            loads.append({"boundary": "left", "pressure": self.between(-2e-4, 5e-4), "ramp": 20})
        return loads

    def initial_motion(self):
        motion = {"velocity": self.vector(3e-3)}
        if self.chance(0.5):
            motion["spin"] = self.between(-2e-3, 2e-3) if self.dim == 2 else self.vector(2e-3)
        if self.chance(0.5):
            motion["within"] = {"lower": [None] * self.dim, "upper": [None] * (self.dim - 1) + [0.2]}
        return [motion]

    def damping(self):
        found = {}
        if self.chance(0.6):
            found["mass"] = self.between(1e-3, 2e-2)
        if self.chance(0.3):
            found["local"] = self.between(0.02, 0.3)
        if self.chance(0.3) and not self.static:
            found["kinetic"] = True
        return found or {"mass": 1e-3}

    def with_files(self, scene, folder):
        """The scene with a packing file, a body of gmsh (whose cells are the mesh where there is one), or two zones."""
        kinds = ["packing"]
        if self.coupled and not self.around:
            kinds.append("zones")
        if self.dim == 2 and not self.around and not self.outlined:
            kinds.append("body")
        self.kind = self.shapes.choice(kinds)
        zone, specimen = scene["discrete_zone"], scene["specimen"]
        if self.kind == "packing":
            for key in ("seed", "size_ratio", "orientation"):
                zone.pop(key, None)
            for key in ("holes", "notches", "slots", "cutouts"):  # a grid has points in them
                specimen.pop(key, None)
            # That of the densest lattice with cells of volume 1.
            zone.update({"packing": "file", "packing_file": "packing.csv",
                         "spacing": 1.0746 if self.dim == 2 else 1.1225})
            (folder / "packing.csv").write_text(self.packing_rows(zone))
        elif self.kind == "zones":
            at = self.dim - 1
            low, high = zone.pop("region").values()
            height = self.size[at]
            self.size[at] = specimen["size"][at] = round(2.2 * height, 3)
            zone["boxes"] = [{name: corner[:at] + [round(corner[at] + side * 0.55 * height, 3)]
                              for name, corner in (("lower", low), ("upper", high))} for side in (-1, 1)]
            for key in ("holes", "notches", "slots", "cutouts"):  # they would lie in the mesh between both
                specimen.pop(key, None)
            for crack in specimen.get("cracks", []):
                for point in crack["points"]:
                    point[1 if self.dim == 2 else 2] -= 0.55 * height
        else:
            specimen.pop("size")
            specimen["file"] = "body.msh"
            for key in ("holes", "notches", "slots", "cutouts"):
                specimen.pop(key, None)
            if self.coupled:
                scene["far_field"]["cells_from_file"] = True
            (folder / "body.msh").write_text(self.body(zone))
        return scene

    def packing_rows(self, zone):
        """A square or cubic grid over the body, shaken."""
        counts = [max(2, round(s)) for s in self.size]
        region = zone.get("region", {"lower": [None] * self.dim, "upper": [None] * self.dim})
        rows = ["x,y,z,r,material", "m,m,m,m,1"]
        for place in itertools.product(*(range(n) for n in counts)):
            x = [s * ((k + 0.5) / n - 0.5) + self.shapes.uniform(-0.2, 0.2) for k, n, s in zip(place, counts, self.size)]
            if all((a is None or v > a - 2) and (b is None or v < b + 2)
                   for v, a, b in zip(x, region["lower"], region["upper"])):
                rows.append(",".join(f"{v:.6f}" for v in x + [0] * (3 - self.dim) + [self.shapes.uniform(0.45, 0.55)]) + ",0")
        return "\n".join(rows) + "\n"

    def body(self, zone):
        """A rectangle of cells of size 4; the zone ends at edges of them."""
        h = 4
        nx, ny = (max(3, round(s / h)) for s in self.size)
        if self.coupled:
            zone["region"] = {"lower": [None, -6 * h], "upper": [None, 6 * h]}
            ny += ny % 2
        node = lambda a, b: 1 + a + (nx + 1) * b
        sides = {"bottom": [(node(a, 0), node(a + 1, 0)) for a in range(nx)],
                 "top": [(node(a, ny), node(a + 1, ny)) for a in range(nx)],
                 "left": [(node(0, b), node(0, b + 1)) for b in range(ny)],
                 "right": [(node(nx, b), node(nx, b + 1)) for b in range(ny)]}
        lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "5"]
        lines += [f'1 {k + 1} "{name}"' for k, name in enumerate(sides)] + ['2 5 "body"', "$EndPhysicalNames", "$Nodes"]
        lines.append(str((nx + 1) * (ny + 1)))
        lines += [f"{node(a, b)} {h * (a - nx / 2)} {h * (b - ny / 2)} 0" for b in range(ny + 1) for a in range(nx + 1)]
        elements = [f"1 2 {k + 1} {k + 1} {i} {j}" for k, of in enumerate(sides.values()) for i, j in of]
        elements += [f"3 2 5 5 {node(a, b)} {node(a + 1, b)} {node(a + 1, b + 1)} {node(a, b + 1)}"
                     for b in range(ny) for a in range(nx)]
        lines += ["$EndNodes", "$Elements", str(len(elements))] + [f"{k + 1} {e}" for k, e in enumerate(elements)]
        return "\n".join(lines + ["$EndElements"]) + "\n"

    def gauges(self):
        zero = [0] * self.dim
        up = zero[:-1] + [3]
        down = zero[:-1] + [-3]
        all_of = [{"name": "pieces", "kind": "fragments"},
                  {"name": "length", "kind": "opening", "points": [down, up]},
                  {"name": "e", "kind": "strain", "lower": [-3] * self.dim, "upper": [3] * self.dim},
                  {"name": "s", "kind": "stress", "lower": [-3] * self.dim, "upper": [3] * self.dim}]
        return self.random.sample(all_of, self.one_of(1, 2, 3))


def call(args, folder, words):
    with open(str(folder) + ".out", "a", encoding="utf-8") as out:
        return subprocess.run([args.program] + words, stdout=out, stderr=subprocess.STDOUT, timeout=900).returncode


def has_ended(run):
    """The last thing that the program said is that there is nothing to go on with."""
    return "come to its end" in Path(str(run) + ".out").read_text().strip().splitlines()[-1]


def broken_in(run):
    return json.loads((run / "run.json").read_text()).get("broken_bonds")


def compare(args, base, scene, draw):
    """What differs, by the run; how many bonds broke; whether a part of the run went on."""
    file, one = str(base / "scene.json"), base / "on_1"
    code = call(args, one, ["run", file, "-o", str(one)])
    found = {}
    if code not in (0, 3):
        return {"on_1": [f"exit code {code}"]}, None, False
    n = draw.one_of(2, 3, 4)
    runs = {f"on_{n}": ["-n", str(n)],
            "cut_anew": ["-n", str(draw.one_of(2, 3)), "--rebuild-interval", str(draw.one_of(5, 11, 23))]}
    for name, more in runs.items():
        now = call(args, base / name, ["run", file, "-o", str(base / name)] + more)
        found[name] = differences(one, base / name) if now == code else [f"exit codes {code} and {now}"]
    half = base / "goes_on"
    share = draw.between(36, scene["time"]["duration"] - 5)  # behind ramps and intervals, lest it warn of them
    now = call(args, half, ["run", file, "-o", str(half), "-n", str(draw.one_of(1, 2, 3)), "--set",
                            f"/time/duration={share}"])
    # It ends where the loads break it, or a guard finds it: nothing to go on with.
    if now == 0 and not scene["time"].get("loading"):
        now = call(args, half, ["resume", str(half), "-n", str(draw.one_of(1, 2, 3)), "--set",
                                f"/time/duration={scene['time']['duration']}"])
        if now != 2 or not has_ended(half):
            found["goes_on"] = differences(one, half) if now == code else [f"exit codes {code} and {now}"]
        if "viscosity" in scene["material"]:  # it says how much softer the zone will be, by the duration
            found["goes_on"] = [name for name in found.get("goes_on", []) if name != "warnings"]
    elif now not in (0, 2, 3):
        found["goes_on"] = [f"exit code {now}"]
    return {name: what for name, what in found.items() if what}, broken_in(one), "goes_on" in found


def main():
    args = parse()
    numbers = [args.only] if args.only is not None else range(args.number)
    n_equal, n_refused, n_gone_on, different = 0, 0, 0, []
    for number in numbers:
        draw = Draw(args.seed, number)
        scene = draw.scene()
        base = args.scratch / f"scene_{args.seed}_{number}"
        shutil.rmtree(base, ignore_errors=True)
        base.mkdir(parents=True)
        if args.files:
            scene = draw.with_files(scene, base)
        (base / "scene.json").write_text(json.dumps(scene, indent=1))
        check = subprocess.run([args.program, "check", str(base / "scene.json"), "-n", "2"], capture_output=True,
                               text=True)
        what = f"{scene['dimension']}D {scene['discrete_zone']['packing']}{', coupled' if draw.coupled else ''}, " \
               f"{draw.kind + ', ' if args.files else ''}{scene['material']['fracture']['criterion']}"
        if check.returncode:
            n_refused += 1
            reasons = [line.split("error: ")[-1] for line in check.stderr.splitlines() if "error: " in line]
            print(f"{number}: {what}: refused: {(reasons or [str(check.returncode)])[0][:150]}", flush=True)
            continue
        differs, broken, goes_on = compare(args, base, scene, draw)
        n_gone_on += goes_on
        print(f"{number}: {what}, {broken} broken: {differs or 'equal'}", flush=True)
        if differs:
            different.append(number)
        else:
            n_equal += 1
            if not args.keep:
                shutil.rmtree(base)
    print(f"{n_equal} equal, {n_gone_on} went on from a part, {n_refused} refused, different: {different or 'none'}")
    return int(bool(different))


if __name__ == "__main__":
    sys.exit(main())
