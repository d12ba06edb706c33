// Trees of joints are solved by one worker, leaves first: the same bits on any machine, from any
// copy of the state.

#include "tests/core/solver/tree_scenes.h"
#include "tests/determinism/together.h"

namespace huestep::test {
namespace {

Scene direct(const std::string& catalogText, std::uint32_t substeps) {
    Scene scene = *sceneFromCatalog(catalogText);
    scene.method = Method::Direct;
    scene.substeps = substeps;
    return scene;
}

void expectSame(const Scene& scene, std::uint64_t ticks) {
    runTogether(worldOf(scene), ticks, silence, 81, [](const World&) {});
}

TEST(JointTrees, OfAChainThatGoesSlackAreTheSameInEveryConfiguration) {
    expectSame(direct("chain:ratio=1000,angle=90", 4), 300);
}

TEST(JointTrees, OfABridgeAreTheSameInEveryConfiguration) {
    expectSame(bridge(2), 60);
}

TEST(JointTrees, BesideContactsAndAllKindsOfJointsAreTheSameInEveryConfiguration) {
    expectSame(direct("joints", 4), 120);
    expectSame(direct("hinges", 4), 90);
}

}  // namespace
}  // namespace huestep::test
