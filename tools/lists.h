/// Lists on the command line: `1,2,3,8`, `scalar,avx2`, `huestep,box2d`.
#pragma once

#include <string>
#include <vector>

#include "core/result.h"
#include "core/world/world.h"

namespace huestep::tools {

/// The pieces between commas; an empty piece stays an empty string.
std::vector<std::string> splitAtCommas(const std::string& text);

/// Thread counts, each 1 to `maxThreads`, none twice.
Result<std::vector<int>> parseThreads(const std::string& text);

/// A width by name, that this machine can run.
Result<Simd> parseSimd(const std::string& text);

/// Widths by name, none twice; `all` stands for every width that this machine can run.
Result<std::vector<Simd>> parseSimdList(const std::string& text);

}  // namespace huestep::tools
