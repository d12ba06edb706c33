/// Files of keys (protocol/keys.h): what others must not read, they cannot.
#pragma once

#include <string>

#include "protocol/keys.h"

namespace huestep::tools {

/// Reads a key file. One with a secret that others may read is refused, as it is none any more. The
/// sentence names the file, and the line.
Result<protocol::Keys> readKeyFile(const std::string& path);

/// Writes a new file, for its owner alone if a secret is in it. One that exists stays as it is: a
/// key that is overwritten is lost. The sentence names the file.
Status writeKeyFile(const std::string& path, const protocol::Keys& keys);

}  // namespace huestep::tools
