#include "core/flush_denormals.h"

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace ligament::core
{
void flush_denormals()
{
#ifdef __SSE2__
  constexpr unsigned flush_results = 0x8000, read_as_zero = 0x0040;
  _mm_setcsr(_mm_getcsr() | flush_results | read_as_zero);
#endif
}
} // namespace ligament::core
