// The future is a function of (state, commands): not of the order in which a scene lists its
// bodies, nor of what was created and destroyed on the way.

#include <algorithm>
#include <numeric>

#include "tests/core/odd_worlds.h"
#include "tests/determinism/script.h"
#include "tests/determinism/together.h"

namespace huestep::test {
namespace {

/// The scene with every id written into it, doubled so that there is room between.
Scene withDoubledIds(Scene scene) {
    const std::vector<BodyId> bodies = bodyIdsOf(scene);
    const std::vector<JointId> joints = jointIdsOf(scene);
    std::vector<std::size_t> byId(bodies.size());
    std::iota(byId.begin(), byId.end(), std::size_t{0});
    std::sort(byId.begin(), byId.end(),
              [&](std::size_t a, std::size_t b) { return bodies[a] < bodies[b]; });
    ShapeId shape = 2;
    for (const std::size_t i : byId) {
        scene.bodies[i].id = 2 * bodies[i];
        scene.bodies[i].firstShape = shape;
        shape += static_cast<ShapeId>(scene.bodies[i].shapes.size()) + 1;
    }
    for (std::size_t i = 0; i < joints.size(); ++i) scene.joints[i].id = 2 * joints[i];
    return scene;
}

/// The same bodies and joints, listed in an order drawn from `random`.
Scene shuffled(const Scene& scene, Random& random) {
    std::vector<std::uint32_t> place(scene.bodies.size());
    std::iota(place.begin(), place.end(), 0u);
    for (std::size_t i = place.size(); i > 1; --i) std::swap(place[i - 1], place[random.below(i)]);
    Scene out = scene;
    for (std::size_t i = 0; i < place.size(); ++i) out.bodies[place[i]] = scene.bodies[i];
    for (JointDef& joint : out.joints) {
        joint.bodyA = place[joint.bodyA];
        joint.bodyB = place[joint.bodyB];
    }
    for (std::size_t i = out.joints.size(); i > 1; --i) {
        std::swap(out.joints[i - 1], out.joints[random.below(i)]);
    }
    return out;
}

/// Adds piles of boxes, far from everything, whose ids lie between those of the scene.
Scene withNoise(const Scene& scene, std::vector<BodyId>& noise) {
    Scene out = scene;
    const std::size_t real = scene.bodies.size();
    for (std::size_t i = 0; i < real && noise.size() < 40; i += 1 + real / 40) {
        const BodyDef& next = scene.bodies[i];
        const auto k = static_cast<float>(noise.size());
        BodyDef body = boxAt({4.0e4f + 0.9f * k, 0.4f});
        if (noise.size() % 5 == 0) body.type = BodyType::Static;
        body.id = next.id - 1;
        body.firstShape = next.firstShape - 1;
        body.shapes[0].material = {0.9f, 0.7f, 0.2f, 1.0f};  // every kind of row
        if (noise.size() % 4 == 1) {
            JointDef rod = hinge(static_cast<std::uint32_t>(out.bodies.size() - 1), {0.4f, 0.0f},
                                 static_cast<std::uint32_t>(out.bodies.size()), {-0.4f, 0.0f});
            rod.id = 2 * static_cast<JointId>(noise.size()) + 1;
            out.joints.push_back(rod);
        }
        noise.push_back(body.id);
        out.bodies.push_back(body);
    }
    return out;
}

void expectEqual(const World& a, const World& b, const std::string& when) {
    if (a.fullRoot() != b.fullRoot()) FAIL() << when << ": " << differenceOf(a, b);
    EXPECT_EQ(a.motionRoot(), b.motionRoot()) << when;
}

/// A scene, and what its host does.
struct Told {
    OddWorld world;
    CommandsOf host = silence;
};

void PrintTo(const Told& told, std::ostream* out) {
    *out << told.world.name;
}

class History : public testing::TestWithParam<Told> {
 protected:
    const std::string& m_name = GetParam().world.name;
    const Scene& m_scene = GetParam().world.scene;
};

TEST_P(History, OfListingDoesNotReachTheRun) {
    Random random(41);
    SCOPED_TRACE(random.trace());
    const Scene scene = withDoubledIds(m_scene);
    World reference = worldOf(scene);
    for (int order = 0; order < 2; ++order) {
        World other = worldOf(shuffled(scene, random));
        World first = reference;
        for (int tick = 0; tick < 120; ++tick) {
            const std::vector<Command> commands = playersScript(first);
            first.step(commands);
            other.step(commands);
            expectEqual(first, other, m_name + ", tick " + std::to_string(tick));
            if (HasFatalFailure()) return;
            ASSERT_EQ(differentEvents(first.events(), other.events()), "");
        }
    }
}

TEST_P(History, OfWhatCameAndWentDoesNotReachTheRun) {
    Random random(42);
    SCOPED_TRACE(random.trace());
    Scene scene = withDoubledIds(m_scene);
    std::vector<BodyId> noise;
    const Scene noisy = withNoise(scene, noise);
    ASSERT_EQ(noise.empty(), scene.bodies.empty());
    World other = worldOf(shuffled(noisy, random));
    scene.counters = {other.info().nextBody, other.info().nextShape, other.info().nextJoint};
    scene.limits = noisy.limits;
    World reference = worldOf(scene);
    std::uint64_t sequence = 0;
    std::uint64_t applied = 0;
    for (int tick = 0; tick < 120; ++tick) {
        std::vector<Command> commands;
        if (tick == 30) {
            for (const BodyId id : noise) commands.push_back({0, ++sequence, RemoveBody{id}});
        }
        reference.step(commands);
        other.step(commands);
        for (const CommandOutcome& outcome : other.events().commands) {
            applied += outcome.reason == Rejection::None;
        }
        if (tick < 30) continue;
        expectEqual(reference, other, m_name + ", tick " + std::to_string(tick));
        if (HasFatalFailure()) return;
    }
    EXPECT_EQ(applied, noise.size());
}

TEST_P(History, OfSnapshotsDoesNotReachTheRun) {
    // Restored at tick k for several k, each copy ends where the run that never stopped ends.
    World reference = worldOf(m_scene);
    std::vector<World> copies;
    for (int tick = 0; tick < 100; ++tick) {
        if (tick % 23 == 0) copies.push_back(restored(reference));
        const std::vector<Command> commands = GetParam().host(reference);
        reference.step(commands);
        for (World& copy : copies) copy.step(commands);
        for (const World& copy : copies) {
            expectEqual(reference, copy, m_name + ", tick " + std::to_string(tick));
            if (HasFatalFailure()) return;
            ASSERT_EQ(differentEvents(reference.events(), copy.events()), "");
        }
    }
}

std::vector<Told> toldScenes() {
    std::vector<Told> all;
    for (const std::string text :
         {"pyramid:base=12", "many_pyramids:rows=3,columns=3,base=5", "joint_grid:n=12",
          "tumbler:count=8", "spinner:bodies=250", "washer:count=8", "smash:columns=8,rows=8",
          "compounds:columns=4,rows=5", "small", "hinges", "joints", "mixed", "terrain", "sandbox",
          "pendulum", "junkyard:columns=20,rows=4", "rain:floors=1,columns=3,group=2,period=20",
          "chain"}) {
        all.push_back({{text.substr(0, text.find(':')), *sceneFromCatalog(text)}, hostOf(text)});
    }
    for (const OddWorld& odd : oddWorlds()) all.push_back({odd});
    return all;
}

std::string nameOfTold(const testing::TestParamInfo<Told>& info) {
    return info.param.world.name;
}

INSTANTIATE_TEST_SUITE_P(Scenes, History, testing::ValuesIn(toldScenes()), nameOfTold);

}  // namespace
}  // namespace huestep::test
