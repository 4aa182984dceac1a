// Run-time choice of the vector width: one binary, the widest instructions of the machine.
#pragma once

// Not under sanitizers: the choice is made before they are ready, and every clone would be
// instrumented.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) &&                             \
    !defined(__SANITIZE_ADDRESS__)
#define LIGAMENT_DISPATCH __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define LIGAMENT_DISPATCH
#endif
#define LIGAMENT_INLINE inline __attribute__((always_inline))
