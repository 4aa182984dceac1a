#!/bin/sh
# Strain over the middle of the polymer in runs of this scene beside the closed form of creep (README.md):
#   usage: examples/polymer_bar/creep.sh FOLDER_OF_THE_RUN..
# Uniaxial stress: the volume is elastic, the shear compliance that of the two branches (Laplace transform of
# G(s) = G [1 - g1 - g2 + g1 s T1/(1 + s T1) + g2 s T2/(1 + s T2)]), the load the scene's ramp.
set -eu
for run in "$@"; do
  echo "$run"
  awk -F, '
  function shear_compliance(t) { return 1 / (rest * G) + w1 * exp(r1 * t) + w2 * exp(r2 * t) }
  function weight(r) { return (1 + r * T1) * (1 + r * T2) / (r * (2 * a * r + b)) / G }
  function strain(t,   n, i, s, sum) { # superposition over the ramp, whose rate is (1 - cos(2 pi s/ramp))/ramp
    n = 400; sum = 0
    for (i = 0; i < n; ++i) {
      s = (i + 0.5) / n * (t < ramp ? t : ramp)
      sum += (1 - cos(2 * PI * s / ramp)) / ramp * (shear_compliance(t - s) / 3 + 1 / (9 * K))
    }
    return stress * sum * (t < ramp ? t : ramp) / n
  }
  BEGIN {
    PI = 3.14159265358979; E = 3e9; nu = 0.35; G = E / (2 * (1 + nu)); K = E / (3 * (1 - 2 * nu))
    g1 = 0.3; T1 = 5e-4; g2 = 0.3; T2 = 4e-3; rest = 1 - g1 - g2; stress = 10e6; ramp = 1e-3; gauge = 0.02
    a = T1 * T2; b = rest * (T1 + T2) + g1 * T1 + g2 * T2
    r1 = (-b + sqrt(b * b - 4 * a * rest)) / (2 * a); r2 = (-b - sqrt(b * b - 4 * a * rest)) / (2 * a)
    w1 = weight(r1); w2 = weight(r2)
    print " t, ms  strain, 1e-3  closed form   ratio"
  }
  NR == 1 { for (k = 1; k <= NF; ++k) column[$k] = k }
  NR > 2 && $column["time"] >= (next_time + 1) * 1e-3 - 1e-9 {
    ++next_time
    e = $column["extension"] / gauge; f = strain($column["time"])
    printf "%6.2f %13.4f %12.4f %7.4f\n", 1e3 * $column["time"], 1e3 * e, 1e3 * f, e / f
  }' "$run/history.csv"
done
