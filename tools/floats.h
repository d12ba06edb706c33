/// Whether this process computes as the core needs it.
#pragma once

#include "core/result.h"

namespace huestep::tools {

/// Tries, at run time, that denormal numbers are kept and that a product is rounded before it is
/// added to: a library built with fast-math may switch the first off for the whole process.
Status checkFloats();

}  // namespace huestep::tools
