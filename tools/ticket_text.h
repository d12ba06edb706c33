/// Tickets as text, as `huestep ticket issue` prints them.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/result.h"

namespace huestep::tools {

/// The sealed ticket in a file, or on standard input for `-`; nothing where no file is named. The
/// sentence names the file.
Result<std::vector<std::byte>> readTicket(const std::string& path);

}  // namespace huestep::tools
