/// What this build shares with builds that may play together with it.
#pragma once

#include "core/result.h"
#include "protocol/messages.h"

namespace huestep::tools {

/// The build's fingerprint with its self-test: the full root of the scene `mixed` after 120 ticks,
/// stepped here and now, so that a processor or library that computes otherwise shows itself.
Result<protocol::Fingerprint> selfTest();

}  // namespace huestep::tools
