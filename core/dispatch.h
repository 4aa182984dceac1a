// Run-time choice of the vector width: one binary with plain code (SSE2) and code for AVX2 and
// AVX-512. Included before the headers of Highway, whose name for plain code is EMU128. Builds with
// LIGAMENT_FEW_TARGETS leave AVX-512 out.
#pragma once

#ifdef LIGAMENT_FEW_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL | HWY_AVX3)
#else
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#endif
