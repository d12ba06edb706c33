// Storms of edits: bodies and joints come and go in every tick, by dozens. A world that carries
// what it derived over to the new places goes on as one that derives everything anew.

#include "tests/determinism/together.h"

namespace huestep::test {
namespace {

/// Boxes that lie on each other, some asleep from the start, some hinged to their neighbour, some
/// that filters keep apart; enough that threads share the work.
Scene crowd(Random& random) {
    constexpr std::uint32_t columns = 30, rows = 20;
    std::vector<BodyDef> bodies{
        bodyAt(BodyType::Static, {0.0f, -1.0f}, ShapeDef::box(60.0f, 1.0f)),
        bodyAt(BodyType::Kinematic, {-18.0f, 2.0f}, ShapeDef::box(1.0f, 2.0f))};
    bodies[1].velocity = {1.0f, 0.0f};
    std::vector<JointDef> joints;
    for (std::uint32_t i = 0; i < columns * rows; ++i) {
        const auto column = static_cast<float>(i % columns), row = static_cast<float>(i / columns);
        BodyDef box = boxAt({column - 15.0f, row + 0.5f}, 0.5f);
        box.asleep = column > 24.0f;
        if (random.once(10)) box.shapes[0].filter.group = -1 - static_cast<int>(random.below(3));
        if (random.once(8)) box.shapes.push_back(ShapeDef::circle({0.0f, 0.3f}, 0.3f));
        bodies.push_back(box);
        const auto self = static_cast<std::uint32_t>(bodies.size() - 1);
        if (i % columns > 0 && random.once(4)) {
            joints.push_back(hinge(self - 1, {0.5f, 0.0f}, self, {-0.5f, 0.0f}));
        }
    }
    return sceneOf(bodies, joints);
}

/// Removals, spawns (alone, hinged in pairs, asleep, static) and removals of joints, in no order.
std::vector<Command> storm(Random& random, const World& world) {
    std::vector<Command> commands;
    const auto say = [&](Action action) {
        commands.push_back({0, hostSequence(world.tick(), commands.size()), std::move(action)});
    };
    for (std::uint32_t i = random.below(40); i > 0; --i) {
        const BodyId newest = world.info().nextBody + 4;  // some come in this very tick
        switch (random.below(6)) {
            case 0:
            case 1:
                say(RemoveBody{3 + random.below(newest)});
                break;
            case 2:
                say(RemoveJoint{1 + random.below(world.info().nextJoint)});
                break;
            case 3: {
                const Vec2 at = random.point(-14.0, 22.0);
                say(Spawn{{boxAt(at, 0.3f), discAt(at + Vec2{0.8f, 0.0f}, 0.4f)},
                          {hinge(0, {0.4f, 0.0f}, 1, {-0.4f, 0.0f})}});
                break;
            }
            default: {
                BodyDef body = boxAt(random.point(-14.0, 22.0), random.betweenF(0.1, 0.8));
                if (random.once(8)) body.type = BodyType::Static;
                body.asleep = body.type == BodyType::Dynamic && random.once(4);
                if (random.once(8)) body.shapes[0].filter.mask = 2;  // touches nobody here
                say(Spawn{{body}, {}});
            }
        }
    }
    return commands;
}

TEST(Storm, OfSpawnsAndRemovalsIsTheSameWhetherDerivedDataIsCarriedOverOrMadeAnew) {
    Random random(8100);
    SCOPED_TRACE(random.trace());
    const World start = worldOf(crowd(random));
    std::vector<Configuration> configurations = allConfigurations();
    configurations.push_back({.name = "from nothing in every tick", .dropOnceIn = 1});
    std::size_t contacts = 0, ends = 0;
    runTogether(
        start, 60, [&](const World& world) { return storm(random, world); }, 9,
        [&](const World& world) {
            contacts = std::max<std::size_t>(contacts, world.report().contacts);
            ends += world.events().ends.size();
        },
        configurations);
    EXPECT_GT(contacts, 1000u);
    EXPECT_GT(ends, 1000u);
}

TEST(Spawn, OfTheFirstThatMayTouchAShapeThatWasAloneComesToRestOnIt) {
    BodyDef shelf = bodyAt(BodyType::Static, {0.0f, 5.0f}, ShapeDef::box(3.0f, 0.5f));
    shelf.shapes[0].filter.mask = 2;
    World world = worldOf(sceneOf({ground(), shelf, boxAt({0.0f, 8.0f}), boxAt({0.1f, 9.0f})}));
    run(world, 100);
    ASSERT_LT(motionOf(world, 3).position.y, 2.0f) << "the shelf held a box that may not touch it";
    BodyDef box = boxAt({0.0f, 8.0f});
    box.shapes[0].filter.category = 2;
    world.step(std::vector<Command>{{0, 1, Spawn{{box}, {}}}});
    run(world, 100);
    EXPECT_NEAR(motionOf(world, 5).position.y, 6.0f, 0.05f);
}

}  // namespace
}  // namespace huestep::test
