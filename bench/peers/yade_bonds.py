# Steps of Yade's bonded concrete model on given particles and bonds, collider off:
#   yade -n -x -j1 yade_bonds.py PARTICLES BONDS SPACING
# Prints particles, bonds and million particle-steps per second of processor time.
import sys
import time

particles_file, bonds_file, spacing = sys.argv[-3], sys.argv[-2], float(sys.argv[-1])

O.materials.append(
    CpmMat(young=1, poisson=.25, frictionAngle=.5, density=1, sigmaT=1e3, epsCrackOnset=1e3, relDuctility=5))
O.bodies.append([sphere([float(x) for x in line.split()], spacing / 2) for line in open(particles_file)])
O.engines = [
    ForceResetter(),
    InteractionLoop(
        [Ig2_Sphere_Sphere_ScGeom()],
        [Ip2_CpmMat_CpmMat_CpmPhys(cohesiveThresholdIter=1)],
        [Law2_ScGeom_CpmPhys_Cpm()]),
    NewtonIntegrator(damping=0),
]
O.dt = 1e-4 * spacing
for line in open(bonds_file):
    i, j = (int(n) for n in line.split())
    utils.createInteraction(i, j)
for body in O.bodies:
    body.state.vel = 1e-6 * Vector3(body.state.pos[1], body.state.pos[2], body.state.pos[0])

n_particles = len(O.bodies)
n_bonds = sum(1 for i in O.interactions if i.isReal)
n_steps = max(20, 2000000 // n_bonds)
O.run(5, True)
best = 0
for repeat in range(3):
    start = time.process_time()
    O.run(n_steps, True)
    best = max(best, n_steps * n_particles / (time.process_time() - start))
assert sum(1 for i in O.interactions if i.isReal) == n_bonds, "bonds were lost"
print("result", n_particles, n_bonds, 1e-6 * best)
