/// A table of the document as CSV.
#pragma once

#include <string>

#include "tools/text.h"

namespace huestep::tools::chart {

/// The rows of the document's list `table`, with a head of their keys; keys that a row does not
/// have, and nulls, are empty. In front of each row stand the document's commit, machine, compiler
/// and date. As in RFC 4180, but for lines, which end in \n.
std::string csvOf(const Json& document, const std::string& table);

}  // namespace huestep::tools::chart
