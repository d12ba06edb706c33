/// Whole files, in and out.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"

namespace huestep::tools {

/// All bytes of a regular file of at most `limit` bytes. The sentence names the file.
Result<std::vector<std::byte>> readFile(const std::string& path, std::size_t limit);

/// Writes or overwrites a file. The sentence names the file.
Status writeFile(const std::string& path, std::span<const std::byte> bytes);

}  // namespace huestep::tools
