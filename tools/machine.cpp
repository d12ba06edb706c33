#include "tools/machine.h"

#include <fstream>
#include <thread>
#include <utility>

#include "tools/commit.h"

namespace huestep::tools {

std::string machineName() {
    const std::string cores = " x" + std::to_string(std::thread::hardware_concurrency());
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);)
        if (line.starts_with("model name")) {
            const std::size_t colon = line.find(": ");
            if (colon != std::string::npos) return line.substr(colon + 2) + cores;
        }
    return "unknown processor" + cores;
}

std::string compilerName() {
#if defined(__clang__)
    return "clang " __clang_version__ ", " HUESTEP_BUILD_TYPE;
#else
    return "g++ " __VERSION__ ", " HUESTEP_BUILD_TYPE;
#endif
}

std::string commitName() {
    return HUESTEP_COMMIT;
}

std::string originLine() {
    return machineName() + "; " + compilerName() + "; commit " + commitName();
}

Json documentOf(Json results, bool finished) {
    return {{"machine", machineName()},
            {"compiler", compilerName()},
            {"commit", commitName()},
            {"finished", finished},
            {"results", std::move(results)}};
}

}  // namespace huestep::tools
