# The layer check must accept a sound tree and refuse each kind of broken one.
#   cmake -DCHECK=scripts/check_layers.cmake -DTREE=<scratch folder> -P self_test.cmake

cmake_minimum_required(VERSION 3.22)

# Builds a small sound tree, adds `text` to `file`, runs the check.
function(run_check file text)
  file(REMOVE_RECURSE ${TREE})
  file(WRITE ${TREE}/core/types.h "#include <vector>\n#include <Eigen/Core>\n")
  file(WRITE ${TREE}/particles/particles.h "#include \"core/types.h\"\n")
  file(WRITE ${TREE}/dem/law.h "#include \"particles/particles.h\"\n")
  file(WRITE ${TREE}/packings/packing.h "#include \"particles/particles.h\"\n")
  file(WRITE ${TREE}/md/atoms.h "#include \"packings/packing.h\"\n")
  file(WRITE ${TREE}/fem/mesh.cc "#include <deal.II/grid/tria.h>\n#include \"core/types.h\"\n")
  file(WRITE ${TREE}/coupling/overlap.cc
    "#include \"fem/solver.h\"\n#include \"particles/particles.h\"\n#include <Amesos.h>\n")
  file(WRITE ${TREE}/fem/solver.h "#include \"core/types.h\"\n")
  file(WRITE ${TREE}/src/main.cc "#include \"dem/law.h\"\n#include <CLI/CLI.hpp>\n")
  file(APPEND ${TREE}/${file} "${text}\n")
  execute_process(COMMAND ${CMAKE_COMMAND} -DROOT=${TREE} -P ${CHECK}
    RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE err)
  set(code "${code}" PARENT_SCOPE)
  set(said "${out}${err}" PARENT_SCOPE)
endfunction()

function(must_pass file text)
  run_check(${file} "${text}")
  if(NOT code STREQUAL "0")
    message(FATAL_ERROR "a sound tree was refused (${file}: ${text}):\n${said}")
  endif()
endfunction()

function(must_fail file text)
  run_check(${file} "${text}")
  if(code STREQUAL "0")
    message(FATAL_ERROR "not noticed: ${file}: ${text}")
  endif()
  if(NOT said MATCHES "${file}")
    message(FATAL_ERROR "the complaint about ${file} does not name it:\n${said}")
  endif()
endfunction()

must_pass(core/types.h "")
must_pass(core/types.h "// #include \"dem/law.h\"")
must_pass(dem/law.h "  #  include <cmath>")

must_pass(src/simulation/make_force.cc "#include \"dem/law.h\"\ndem::Law law;")
must_pass(src/simulation/make_force.h "Academy::law(); // not of dem")
must_pass(src/verification/cases/waves.cc "#include \"dem/law.h\"")

must_pass(algebra/factor.cc "#include <cholmod.h>\n#include <omp.h>\n#include \"core/types.h\"")

must_fail(core/types.h "#include \"particles/particles.h\"")
must_fail(algebra/factor.h "#include \"particles/particles.h\"")
must_fail(particles/particles.h "#include \"dem/law.h\"")
must_fail(dem/law.h "#include \"fem/solver.h\"")
must_fail(dem/law.h "#include \"md/atoms.h\"")
must_fail(md/atoms.h "#include \"dem/law.h\"")
must_fail(md/atoms.h "#include \"fem/solver.h\"")
must_fail(coupling/overlap.cc "#include \"md/atoms.h\"")
must_fail(md/atoms.h "#include <deal.II/base/point.h>")
must_fail(src/simulation/loop.cc "#include \"md/atoms.h\"")
must_fail(fem/mesh.cc "#include \"particles/particles.h\"")
must_fail(coupling/overlap.cc "#include \"dem/law.h\"")
must_fail(coupling/overlap.cc "#include \"src/main.cc\"")

must_fail(core/types.h "#include <deal.II/base/point.h>")
must_fail(particles/particles.h "#include <Epetra_Vector.h>")
must_fail(dem/law.h "#include <cholmod.h>")
must_fail(dem/law.h "  #  include <deal.II/base/point.h>")
must_fail(dem/law.h "#include <CLI/CLI.hpp>")
must_fail(fem/mesh.cc "#include <nobody_knows/this.h>")

must_fail(dem/law.h "#include \"law.h\"")
must_fail(dem/law.h "#include \"../core/types.h\"")
must_fail(dem/law.h "#include <core/types.h>")
must_fail(src/main.cc "#include \"core/missing.h\"")

must_fail(src/simulation/loop.cc "#include \"dem/law.h\"")
must_fail(src/simulation/make_force.h "#include \"dem/law.h\"")
must_fail(src/simulation/loop.h "  std::unique_ptr<dem::Law> law;")
must_fail(src/output/fields.cc "double f = ::ligament::dem::force();")
must_fail(src/drawing/picture.cc "dem::Law law;")
must_fail(src/analysis/report.cc "#  include  \"dem/law.h\"")

must_fail(tests/unit/dem/law.cc "#include <deal.II/base/point.h>")
must_fail(tests/unit/core/types.cc "#include \"fem/solver.h\"")
must_fail(dem/CMakeLists.txt "deal_ii_setup_target(ligament_dem)")

file(REMOVE_RECURSE ${TREE})
