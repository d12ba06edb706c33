/// What two builds must share to step the same bits, as far as this folder knows it.
#pragma once

#include <cstdint>
#include <string_view>

#include "protocol/messages.h"

namespace huestep::protocol {

/// The hash of the schemas this program was built with and the versions of the scene and snapshot
/// layout.
/// `selfTest` is 0: whoever can step a world fills it in.
Fingerprint buildFingerprint();

/// XXH3-64 of a schema's text without comments and runs of white space, so that better prose in a
/// schema does not keep builds from playing together.
std::uint64_t schemaHash(std::string_view text);

}  // namespace huestep::protocol
