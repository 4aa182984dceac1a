// Which program this is: version and commit, for the log, the resolved scene and --version.
#pragma once

#include <string>

namespace ligament::core
{
/// "0.1.0", from the top-level CMakeLists.txt.
std::string version();

/// Short hash of the commit that was built, with "+changes" when the tree differed from it;
/// "unknown" outside a git checkout.
std::string commit();
} // namespace ligament::core
