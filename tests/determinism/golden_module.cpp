// The golden runs as WebAssembly: beside what a page calls of the core, whose turn it is to say
// something. tests/determinism/goldens_wasm.mjs steps them and reads their hashes as a page does.
#include "client/wasm/exports.h"
#include "tests/determinism/golden_runs.h"

namespace huestep::test {

namespace {

using wasm::Bytes;

/// Made on first use: its scripts read the catalogue.
const GoldenRun* runOf(const Bytes* scene) {
    static const std::vector<GoldenRun> runs = goldenRuns();
    for (const GoldenRun& run : runs) {
        if (run.scene == wasm::textOf(*scene)) return &run;
    }
    return nullptr;
}

}  // namespace

/// The run of a scene, by its text; null if there is none.
HUESTEP_EXPORT(goldenRun)(const Bytes* scene)->const GoldenRun* {
    return runOf(scene);
}
HUESTEP_EXPORT(goldenRunCount)()->std::uint32_t {
    return static_cast<std::uint32_t>(goldenRuns().size());
}
/// One step to which those say something who take part in the run.
HUESTEP_EXPORT(goldenStep)(const GoldenRun* run, World* world)->void {
    world->step(run->commandsOf(*world));
}
HUESTEP_EXPORT(goldenAsleep)(const World* world)->std::uint32_t {
    return allAsleep(*world) ? 1 : 0;
}

}  // namespace huestep::test
