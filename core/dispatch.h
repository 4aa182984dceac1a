// Run-time choice of the vector width: one binary with code for SSE2, AVX2 and AVX-512. Included
// before Highway's headers.
#pragma once

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
