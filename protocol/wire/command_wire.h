/// Commands to Cap'n Proto and back.
#pragma once

#include "core/world/command.h"
#include "protocol/messages.capnp.h"
#include "protocol/wire/reading.h"

namespace huestep::protocol::wire {

/// Words of what a command points to: of a spawn's bodies and joints.
std::size_t contentWords(const Command& command);

void put(schema::Command::Builder to, const Command& command);
Command readCommand(Reading& in, schema::Command::Reader from);

}  // namespace huestep::protocol::wire
