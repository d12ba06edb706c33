#include "tools/fingerprint.h"

#include "core/scene/catalog.h"
#include "core/world/world.h"
#include "protocol/fingerprint.h"

namespace huestep::tools {

Result<protocol::Fingerprint> selfTest() {
    constexpr int ticks = 120;
    const Result<Scene> scene = sceneFromCatalog("mixed");
    if (!scene) return scene.error();
    Result<World> world = World::create(*scene);
    if (!world) return world.error();
    for (int tick = 0; tick < ticks; ++tick) world->step({});
    protocol::Fingerprint fingerprint = protocol::buildFingerprint();
    fingerprint.selfTest = world->fullRoot();
    return fingerprint;
}

}  // namespace huestep::tools
