// Numbers beyond all bounds: velocities near the largest float make impulses infinite and other
// velocities no numbers. What comes of them must not depend on which islands share a batch, for a
// batch makes the passes that any of its rows needs.

#include "core/solver/method.h"
#include "tests/core/odd_worlds.h"
#include "tests/determinism/random_scene.h"
#include "tests/determinism/together.h"

namespace huestep::test {
namespace {

constexpr std::uint32_t velocityX = 4;      // of `fieldsOf<BodyMotion>`
constexpr std::uint32_t highExponent = 30;  // bit: 0.5 becomes 1.7e38

/// Piles far apart, each of a material of its own: with and without friction, restitution, rolling
/// resistance and a moving surface, some with hinges, and a hub.
Scene differentPiles(Random& random) {
    Scene scene = hubOfContacts();
    for (int pile = 0; pile < 10; ++pile) {
        const Material material = {random.once(2) ? 0.0f : 0.6f, random.once(2) ? 0.0f : 0.5f,
                                   random.once(2) ? 0.0f : 0.05f, random.once(3) ? 1.5f : 0.0f};
        const float x = 100.0f + 40.0f * static_cast<float>(pile);
        BodyDef floor = bodyAt(BodyType::Static, {x, -1.0f}, ShapeDef::box(15.0f, 1.0f));
        floor.shapes[0].material = material;
        scene.bodies.push_back(floor);
        const bool hinged = random.once(2);
        for (int i = 0; i < 14; ++i) {
            const Vec2 at{x + random.betweenF(-1.5, 1.5), 0.4f + 0.6f * static_cast<float>(i / 3)};
            BodyDef body = random.once(2) ? boxAt(at, 0.4f) : discAt(at, 0.4f);
            body.shapes[0].material = material;
            body.velocity = {random.betweenF(0.3, 0.9), random.betweenF(-6.0, 0.0)};
            scene.bodies.push_back(body);
            const auto last = static_cast<std::uint32_t>(scene.bodies.size()) - 1;
            if (!hinged || i == 0) continue;
            JointDef joint = hinge(last - 1, {0.3f, 0.0f}, last, {-0.3f, 0.0f});
            if (random.once(3)) joint.limit = {true, -0.5f, 0.5f};
            scene.joints.push_back(joint);
        }
    }
    return scene;
}

class Explosion : public testing::TestWithParam<Method> {};

TEST_P(Explosion, IsTheSameWhicheverIslandsShareABatch) {
    const std::vector<Configuration> configurations = {
        {.name = "batches as usual"},
        {.name = "a batch an island", .limits = {.batchSize = 0, .parallelFrom = 0}},
        {.name = "one batch for all",
         .simd = Simd::Scalar,
         .limits = {.batchSize = 1'000'000, .parallelFrom = 0}}};
    std::size_t quarantined = 0;
    for (int round = 0; round < 6; ++round) {
        Random random(7'100 + static_cast<std::uint64_t>(round));
        SCOPED_TRACE(random.trace());
        Scene scene = differentPiles(random);
        scene.method = GetParam();
        scene.substeps = 3;
        const World start = worldOf(scene);
        std::vector<ConfiguredRun> runs;
        for (const Configuration& configuration : configurations)
            runs.emplace_back(configuration, start, 1);
        const World& reference = runs.front().world();
        while (reference.tick() < 24) {
            for (int i = 0; reference.tick() % 6 == 2 && i < 4; ++i) {
                const auto body = static_cast<BodyId>(1 + random.below(reference.info().nextBody));
                for (const ConfiguredRun& run : runs)
                    WorldSpoiler::flip(run.world(), body, velocityX, highExponent);
            }
            for (ConfiguredRun& run : runs) run.step({});
            quarantined += reference.events().quarantined.size();
            for (const ConfiguredRun& run : runs) {
                ASSERT_EQ(differentEvents(reference.events(), run.world().events()), "")
                    << "tick " << reference.tick() << ", " << run.name();
                ASSERT_EQ(run.world().fullRoot(), reference.fullRoot())
                    << "tick " << reference.tick() << ", " << run.name() << ": "
                    << differenceOf(reference, run.world());
            }
        }
    }
    EXPECT_GT(quarantined, 30u) << "nothing went beyond all bounds";
}

std::vector<Method> deterministicMethods() {
    std::vector<Method> found;
    for (const MethodTraits& method : allMethods())
        if (method.deterministic) found.push_back(method.method);
    return found;
}

std::string nameOfMethod(const testing::TestParamInfo<Method>& info) {
    std::string name(traitsOf(info.param).name);
    std::erase(name, '-');
    return name;
}

INSTANTIATE_TEST_SUITE_P(Methods, Explosion, testing::ValuesIn(deterministicMethods()),
                         nameOfMethod);

}  // namespace
}  // namespace huestep::test
