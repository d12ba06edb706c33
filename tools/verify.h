/// What `verify` answers with, whatever it compared.
#pragma once

#include <string>

#include "tools/command.h"
#include "tools/compare.h"
#include "tools/scene_source.h"

namespace huestep::tools {

struct VerifyOptions {
    std::string source;
    std::string engine = "huestep";
    std::string method;       ///< empty: the scene's own
    std::uint64_t ticks = 0;  ///< 0: the scene's own, the journal's end
    std::string threads = "1,2,3,8";
    std::string simd = "all";
    std::uint64_t restoreEvery = 0;  ///< 0: never
    bool reorder = false;
    int jobs = 0;  ///< 0: as many as the machine has cores
    bool json = false;
};

/// Compares runs of a peer: repeated, and with `reorder` built in other orders and after noise.
Answer verifyPeer(const VerifyOptions& options, const NamedScene& scene);

}  // namespace huestep::tools
