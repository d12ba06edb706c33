// Snapshots: exact, and refused wherever a byte is wrong. What comes from outside never crashes.

#include "core/state/snapshot.h"
#include "core/state/validate.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <regex>

#include "core/solver/effort.h"
#include "core/state/roots.h"
#include "tests/core/support.h"
#include "tests/determinism/script.h"

namespace huestep::test {
namespace {

/// A few bodies with everything a state can hold: joints, a grab, players, contacts, sleepers.
World richWorld() {
    Scene scene =
        sceneOf({ground(), boxAt({0.0f, 0.5f}), boxAt({0.0f, 1.5f}), discAt({4.0f, 3.0f})},
                {hinge(0, {4.0f, 5.0f}, 3, {0.0f, 1.0f})});
    scene.joints[0].motor = {true, 1.0f, 5.0f};
    PlayerDef players;
    players.body = discAt({}, 0.4f);
    players.spawnPoints = {{-10.0f, 1.0f}, {-12.0f, 2.0f}};
    scene.players = players;
    World world = worldOf(scene);
    world.step(
        std::vector<Command>{{0, 1, AddPlayer{3}}, {3, 1, Grab{4, {4.0f, 3.0f}, {5.0f, 3.0f}}}});
    run(world, 20);
    return world;
}

std::string refusal(std::span<const std::byte> bytes) {
    const Result<World> world = World::restore(bytes);
    return world.ok() ? std::string() : world.error().message;
}

TEST(Snapshot, HoldsTheStateExactly) {
    for (const char* scene :
         {"mixed", "sandbox", "hinges", "joints", "joint_grid:n=6", "ballistic"}) {
        World world = worldOf(scene);
        for (int tick = 0; tick < 40; ++tick) world.step(playersScript(world));
        const std::vector<std::byte> bytes = world.save();
        const World copy = restored(world);
        EXPECT_EQ(differenceOf(world, copy), "");
        EXPECT_EQ(world.fullRoot(), copy.fullRoot());
        EXPECT_EQ(world.motionRoot(), copy.motionRoot());
        EXPECT_EQ(copy.save(), bytes) << "and writes the same bytes";
    }
}

/// Whether the sentence names a place that holds byte `at`.
bool namesPlaceOf(const std::string& sentence, std::size_t at) {
    std::smatch found;
    if (std::regex_search(sentence, found, std::regex("bytes (\\d+) to (\\d+)"))) {
        return std::stoull(found[1]) <= at && at <= std::stoull(found[2]);
    }
    if (std::regex_search(sentence, found, std::regex("offset (\\d+)"))) {
        return std::stoull(found[1]) <= at;
    }
    return false;
}

TEST(Snapshot, WithAnyByteFlippedIsRefusedWithASentenceThatNamesThePlace) {
    const std::vector<std::byte> good = richWorld().save();
    ASSERT_EQ(refusal(good), "");
    Random random(77);
    SCOPED_TRACE(random.trace());
    for (std::size_t at = 0; at < good.size(); ++at) {
        std::vector<std::byte> bad = good;
        bad[at] ^= static_cast<std::byte>(1u << random.below(8));
        const std::string sentence = refusal(bad);
        ASSERT_FALSE(sentence.empty()) << "byte " << at << " of " << good.size();
        ASSERT_TRUE(namesPlaceOf(sentence, at)) << "byte " << at << ": " << sentence;
    }
}

TEST(Snapshot, CutAtAnyLengthOrWithBytesAddedIsRefused) {
    const std::vector<std::byte> good = richWorld().save();
    for (std::size_t length = 0; length < good.size(); ++length) {
        ASSERT_NE(refusal(std::span(good).first(length)), "") << length;
    }
    std::vector<std::byte> longer = good;
    longer.resize(good.size() + 9);
    for (std::size_t length = good.size() + 1; length <= longer.size(); ++length) {
        ASSERT_NE(refusal(std::span(longer).first(length)), "") << length;
    }
}

TEST(Snapshot, OfNoiseIsRefused) {
    Random random(78);
    SCOPED_TRACE(random.trace());
    for (int trial = 0; trial < 2000; ++trial) {
        std::vector<std::byte> bytes(random.below(600));
        for (std::byte& b : bytes) b = static_cast<std::byte>(random.below(256));
        if (random.once(2) && bytes.size() > 16) {
            const std::uint32_t versionAndArrays[] = {snapshotVersion, 12};
            std::memcpy(bytes.data(), "HUESNAP1", 8);
            std::memcpy(bytes.data() + 8, versionAndArrays, 8);
        }
        EXPECT_NE(refusal(bytes), "");
    }
}

TEST(Snapshot, WithAHostileCountAsksForNoMemory) {
    std::vector<std::byte> bytes = richWorld().save();
    const std::uint32_t many = 0xffffffffu;
    for (std::size_t entry = 0; entry < 12; ++entry) {
        std::vector<std::byte> bad = bytes;
        std::memcpy(bad.data() + 20 + 8 * entry, &many, 4);
        EXPECT_NE(refusal(bad), "");
    }
}

/// Values that have broken programs before, of one field.
std::vector<std::uint32_t> nastyBits(FieldType type) {
    const auto f = [](float v) { return std::bit_cast<std::uint32_t>(v); };
    const float most = std::numeric_limits<float>::max();
    if (type == FieldType::F32) {
        return {f(std::numeric_limits<float>::quiet_NaN()),
                f(std::numeric_limits<float>::infinity()),
                f(-0.0f),
                f(most),
                f(-most),
                f(1e-45f),
                f(0.0f),
                f(1.0f),
                f(-1.0f),
                f(1e9f),
                f(-1e9f)};
    }
    return {0u, 1u, 2u, 3u, 0x7fffffffu, 0x80000000u, 0xfffffffeu, 0xffffffffu, 0x100u, 0x1fffu};
}

/// Steps a world that was let in, with everything a session may do to it; it must stay one that
/// can be saved and restored.
std::string liveOn(World world) {
    Executor executor(2);
    for (std::uint64_t tick = 0; tick < 4; ++tick) {
        std::vector<Command> commands;
        if (tick == 1) {
            const std::uint64_t sequence = world.players()[0].lastSequence;
            if (sequence < ~std::uint64_t{0} - 9) {
                commands = {{0, sequence + 1, AddPlayer{9}},
                            {0, sequence + 2, Grab{2, {0.0f, 0.5f}, {1.0f, 1.0f}}},
                            {0, sequence + 3, Spawn{{boxAt({0.0f, 4.0f})}, {}}},
                            {0, sequence + 4, ApplyImpulse{3, {1.0f, 1.0f}, {}}},
                            {0, sequence + 5, RemovePlayer{3}},
                            {0, sequence + 6, RemoveBody{4}}};
            }
        }
        world.step(commands, {&executor, Simd::Auto, nullptr});
        if (world.contactViews().size() != world.contacts().size()) return "views of contacts";
        if (world.castRay({-20.0f, 0.7f}, {20.0f, 0.7f}).size() > world.shapes().size()) {
            return "more hits than shapes";
        }
        static_cast<void>(world.fullRoot());
        const Result<World> again = World::restore(world.save());
        if (!again.ok()) return again.error().message;
    }
    return {};
}

TEST(Snapshot, WithAnyFieldSpoiledIsRefusedByRecordAndFieldOrCanBeLivedWith) {
    const std::vector<std::byte> bytes = richWorld().save();
    Result<WorldState> read = readSnapshot(bytes);
    ASSERT_TRUE(read.ok());
    const WorldState good = *read;
    std::size_t refused = 0, taken = 0;
    forEachArray(good, [&](std::string_view array, const auto& records) {
        using Record = typename std::remove_cvref_t<decltype(records)>::value_type;
        for (std::size_t i = 0; i < std::min<std::size_t>(records.size(), 4); ++i) {
            for (const Field& field : fieldsOf<Record>) {
                for (std::uint32_t k = 0; k < field.count; ++k) {
                    for (const std::uint32_t bits : nastyBits(field.type)) {
                        WorldState bad = good;
                        forEachArray(bad, [&](std::string_view name, auto& others) {
                            if constexpr (std::is_same_v<decltype(others), std::vector<Record>&>) {
                                if (name != array) return;
                                auto* base = reinterpret_cast<char*>(&others[i]);
                                const std::uint32_t size = std::min(sizeOf(field.type), 4u);
                                std::memcpy(base + field.offset + k * sizeOf(field.type), &bits,
                                            size);
                            }
                        });
                        const std::string where = std::string(array) + " " + std::to_string(i) +
                                                  " " + field.name + " = " + std::to_string(bits);
                        const Result<World> world = World::restore(writeSnapshot(bad));
                        if (world.ok()) {
                            ++taken;
                            EXPECT_EQ(liveOn(*world), "") << where;
                            continue;
                        }
                        ++refused;
                        const std::string& sentence = world.error().message;
                        EXPECT_EQ(sentence.rfind("snapshot: ", 0), 0u) << sentence;
                        const bool special =
                            field.type == FieldType::F32 && (bits & 0x7fffffffu) >= 0x7f800000u;
                        if (!special && bits != 0x80000000u) continue;
                        if (field.type != FieldType::F32) continue;
                        EXPECT_NE(sentence.find(std::string(array) + " " + std::to_string(i)),
                                  std::string::npos)
                            << where << ": " << sentence;
                        EXPECT_NE(sentence.find(field.name), std::string::npos)
                            << where << ": " << sentence;
                    }
                }
            }
        }
    });
    EXPECT_GT(refused, 500u);
    EXPECT_GT(taken, 500u);
}

/// What validate says of a state after a change.
template <class Change>
std::string saidOf(const Change& change) {
    const std::vector<std::byte> bytes = richWorld().save();
    WorldState state = *readSnapshot(bytes);
    change(state);
    const Status valid = validate(state);
    const Result<World> world = World::restore(writeSnapshot(state));
    EXPECT_EQ(valid.ok(), world.ok());
    return valid.ok() ? std::string() : valid.error().message;
}

TEST(Snapshot, ThatContradictsItselfIsRefusedByRecordAndField) {
    EXPECT_EQ(saidOf([](WorldState&) {}), "");
    const auto expect = [](const std::string& words, const auto& change) {
        const std::string sentence = saidOf(change);
        EXPECT_NE(sentence.find(words), std::string::npos) << '"' << sentence << '"';
    };
    expect("world", [](WorldState& s) { s.world.clear(); });
    expect("world", [](WorldState& s) { s.world.push_back(s.world[0]); });
    expect("motion", [](WorldState& s) { s.motions.pop_back(); });
    expect("jointImpulse", [](WorldState& s) { s.jointImpulses.push_back({}); });
    expect("playerBody", [](WorldState& s) { s.playerBody.push_back(s.playerBody[0]); });
    expect("playerMotion", [](WorldState& s) { s.playerMotion.clear(); });
    expect("body 2 id", [](WorldState& s) { s.bodies[2].id = s.bodies[1].id; });
    expect("body 4 id", [](WorldState& s) { s.bodies[4].id = s.info().nextBody; });
    expect("shape 2 id", [](WorldState& s) { s.shapes[2].id = 1; });
    expect("joint 0 id", [](WorldState& s) { s.joints[0].id = 0; });
    expect("shape 1 body", [](WorldState& s) { s.shapes[1].body = 99; });
    expect("shape 3 body", [](WorldState& s) { s.shapes[3].body = 1; });
    expect("motion 1 rotation", [](WorldState& s) { s.motions[1].rotation = {0.5f, 0.5f}; });
    expect("motion 1 position.x", [](WorldState& s) { s.motions[1].position.x = 2.0e6f; });
    expect("body 1 flags", [](WorldState& s) { s.bodies[1].flags = 3; });
    expect("body 1 inverseMass", [](WorldState& s) { s.bodies[1].inverseMass = 0; });
    expect("body 0 inverseMass", [](WorldState& s) { s.bodies[0].inverseMass = 1; });
    expect("shape 1 kind", [](WorldState& s) { s.shapes[1].kind = 9; });
    expect("shape 1 kind", [](WorldState& s) { s.shapes[1].kind = 4 | (2 << 8); });
    expect("shape 1 vertices", [](WorldState& s) {
        s.shapes[1].kind = 4 | (4 << 8);
        s.shapes[1].vertices[3] = s.shapes[1].vertices[2];
    });
    expect("shape 1 kind", [](WorldState& s) { s.shapes[1].kind = 2 | (9 << 8); });
    expect("shape 1 kind", [](WorldState& s) { s.shapes[1].kind = 0 | (4 << 8); });
    expect("shape 1 vertices",
           [](WorldState& s) { s.shapes[1].vertices[1] = s.shapes[1].vertices[0]; });
    expect("shape 1 vertices",
           [](WorldState& s) { std::swap(s.shapes[1].vertices[1], s.shapes[1].vertices[2]); });
    expect("shape 1 friction", [](WorldState& s) { s.shapes[1].friction = -1.0f; });
    expect("joint 0 bodyB", [](WorldState& s) { s.joints[0].bodyB = 88; });
    expect("joint 0 bodyB", [](WorldState& s) { s.joints[0].bodyB = s.joints[0].bodyA; });
    expect("joint 0 bodyA", [](WorldState& s) { s.joints[0].bodyA = 88; });
    expect("joint 1 bodyA", [](WorldState& s) { s.joints[1].bodyA = 1; });
    expect("joint 0 flags", [](WorldState& s) { s.joints[0].flags = 7; });
    expect("joint 0 reference", [](WorldState& s) { s.joints[0].reference = {0.0f, 0.0f}; });
    expect("contact 1 shapeA", [](WorldState& s) { std::swap(s.contacts[0], s.contacts[1]); });
    expect("contact 0 shapeB", [](WorldState& s) { s.contacts[0].shapeB = 77; });
    expect("contact 0 relative", [](WorldState& s) { s.contacts[0].relative.q = {2.0f, 0.0f}; });
    expect("contact 0 shapeB", [](WorldState& s) {
        s.shapes[s.contacts[0].shapeA - 1].mask = 0;  // shape ids of this world count from 1
    });
    expect("player 0", [](WorldState& s) { s.players.clear(); });
    expect("player 1 id", [](WorldState& s) { s.players[1].id = 0; });
    expect("player 1 body", [](WorldState& s) { s.players[1].body = 66; });
    expect("player 1 grab", [](WorldState& s) { s.players[1].grab = 66; });
    expect("world stepSeconds", [](WorldState& s) { s.info().stepSeconds = 0.0f; });
    expect("world substeps", [](WorldState& s) { s.info().substeps = 65; });
    expect("shape 1 vertices", [](WorldState& s) {
        // Twice around: every corner is a left turn, and edges cross.
        s.shapes[1].kind = 2 | (5 << 8);
        for (std::size_t i = 0; i < 5; ++i) {
            const double turn = 0.8 * std::numbers::pi * static_cast<double>(i);
            s.shapes[1].vertices[i] = {static_cast<float>(std::cos(turn)),
                                       static_cast<float>(std::sin(turn))};
        }
    });
    expect("joint 0 anchorA", [](WorldState& s) { s.joints[0].anchorA.x = 2.0e6f; });
    expect("joint 0 anchorB", [](WorldState& s) { s.joints[0].anchorB.y = -2.0e6f; });
    expect("joint 1 target", [](WorldState& s) { s.joints[1].target.x = 2.0e6f; });
    expect("joint 0 lower", [](WorldState& s) {
        s.joints[0].flags |= JointInfo::limit;
        s.joints[0].lower = -4.0f;
    });
    expect("joint 0 upper", [](WorldState& s) {
        s.joints[0].flags |= JointInfo::limit;
        s.joints[0].upper = 4.0f;
    });
    expect("joint 0 flags", [](WorldState& s) {
        s.joints[0].flags = static_cast<std::uint32_t>(JointKind::Weld) | JointInfo::limit;
    });
    expect("joint 0 target", [](WorldState& s) {
        s.joints[0].flags = static_cast<std::uint32_t>(JointKind::Prismatic);
        s.joints[0].target = {0.5f, 0.5f};
    });
    expect("joint 0 lower", [](WorldState& s) {
        s.joints[0].flags = static_cast<std::uint32_t>(JointKind::Prismatic) | JointInfo::limit;
        s.joints[0].target = {0.0f, 1.0f};
        s.joints[0].lower = -2.0f * caps::maxJointLength;
    });
    expect("world maxCommandsPerTick", [](WorldState& s) { s.info().maxCommandsPerTick = 0; });
    expect("world maxPlayers", [](WorldState& s) { s.info().maxPlayers = 1u << 20; });
    expect("world maxSpawned", [](WorldState& s) { s.info().maxSpawned = 1u << 20; });
    expect("world maxImpulse", [](WorldState& s) { s.info().maxImpulse = 3.0e38f; });
    expect("world maxForce", [](WorldState& s) { s.info().maxForce = -1.0f; });
    expect("world penetrationNeed", [](WorldState& s) { s.info().penetrationNeed = 2.0f; });
    expect("world jointNeed", [](WorldState& s) { s.info().jointNeed = -0.001f; });
    expect("motion 1 effort", [](WorldState& s) { s.motions[1].effort = highestEffort + 1; });
    expect("motion 1 calm", [](WorldState& s) { s.motions[1].calm = calmSteps; });
    expect("motion 1 calm", [](WorldState& s) { s.motions[1].calm = -128; });
    expect("world method", [](WorldState& s) { s.info().method = 200; });
}

TEST(Snapshot, OfABodyWhoseCentreIsBeyondTheRimOfItsOriginCanBeRestored) {
    BodyDef body = bodyAt(BodyType::Static, {maxCoordinate, -maxCoordinate},
                          ShapeDef::box(1.0f, 1.0f, {5000.0f, -5000.0f}));
    World world = worldOf(sceneOf({body, ground()}));
    body.type = BodyType::Dynamic;
    world.step(std::vector<Command>{{0, 1, Spawn{{body}, {}}}});
    EXPECT_EQ(world.events().commands[0].reason, Rejection::None);
    EXPECT_EQ(refusal(world.save()), "");
}

TEST(Snapshot, OfAShapeWiderThanAnySceneAllowsIsRefused) {
    // Such a circle would put NaN into the broad phase's cells.
    EXPECT_NE(saidOf([](WorldState& s) { s.shapes[3].vertices[0] = {3.0e38f, -3.0e38f}; }), "");
}

}  // namespace
}  // namespace huestep::test
