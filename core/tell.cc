#include "core/tell.h"

namespace ligament::core
{
void tell(std::FILE *stream, std::string_view text) noexcept
{
  if (!stream)
    return;
  std::fwrite(text.data(), 1, text.size(), stream);
  std::fflush(stream);
}
} // namespace ligament::core
