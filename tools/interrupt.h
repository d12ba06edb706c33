/// Ctrl-C and SIGTERM as a question that long loops ask.
#pragma once

namespace huestep::tools {

/// From now on the first SIGINT or SIGTERM only sets `interrupted()`; a second one ends the
/// program at once.
void catchInterrupts();

[[nodiscard]] bool interrupted();

}  // namespace huestep::tools
