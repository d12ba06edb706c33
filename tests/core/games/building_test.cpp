// The sandbox's rules: how much, how fast and how far a player may build.

#include "core/games/building.h"

#include "core/state/snapshot.h"
#include "tests/core/support.h"

namespace huestep::test {
namespace {

using games::BuildingState;

BuildingState stateOf(const World& world) {
    return rulesStateOf<BuildingState>(world.rulesState());
}

/// A site with builders 1 and 2.
class Site {
 public:
    explicit Site(const std::string& scene) : world(worldOf(scene)) {
        world.step(std::vector<Command>{{0, 1, AddPlayer{1}}, {0, 2, AddPlayer{2}}});
        run(world, 1);
    }
    CommandOutcome say(PlayerId author, Action action) {
        world.step(std::vector<Command>{{author, ++m_sequence, std::move(action)}});
        return world.events().commands[0];
    }
    [[nodiscard]] Vec2 above(PlayerId player, float by) const {
        return motionOf(world, world.players()[player].body).position + Vec2{0.0f, by};
    }
    CommandOutcome put(PlayerId player, std::uint32_t kind, std::int32_t size, float by = -4.0f) {
        return say(player, Custom{kind, 0, size, above(player, by)});
    }
    [[nodiscard]] std::vector<BodyId> piecesOf(PlayerId player) const {
        std::vector<BodyId> pieces;
        for (const BodyInfo& body : world.bodies()) {
            if (body.owner == player && body.id != world.players()[player].body) {
                pieces.push_back(body.id);
            }
        }
        return pieces;
    }

    World world;

 private:
    std::uint64_t m_sequence = 10;
};

TEST(BuildingGame, PutsWhatIsAskedForWhereItIsAskedFor) {
    Site site("building:pause=0");
    const Vec2 at = site.above(1, -4.0f);
    ASSERT_EQ(site.put(1, games::putBox, 100).reason, Rejection::None);
    ASSERT_EQ(site.put(1, games::putDisc, 60).reason, Rejection::None);
    ASSERT_EQ(site.put(1, games::putPolygon, 0).reason, Rejection::None);
    const std::vector<BodyId> pieces = site.piecesOf(1);
    ASSERT_EQ(pieces.size(), 3u);
    EXPECT_LT(length(motionOf(site.world, pieces[0]).position - at), 0.1f);
    const ShapeInfo box = site.world.shapesOf(pieces[0])[0];
    EXPECT_EQ(box.shapeKind(), ShapeKind::Polygon);
    EXPECT_NEAR(wide(length(box.vertices[0])), 0.5 * 1.41421356, 1e-5) << "1 m across";
    const ShapeInfo disc = site.world.shapesOf(pieces[1])[0];
    EXPECT_EQ(disc.shapeKind(), ShapeKind::Circle);
    EXPECT_NEAR(wide(disc.radius), 0.3, 1e-6);
    EXPECT_EQ(stateOf(site.world).placed, 3u);
    EXPECT_EQ(site.world.score(), "3 pieces of 3 placed");
}

TEST(BuildingGame, RefusesWhatIsTooFarTooLargeTooSoonOrNotThroughIt) {
    Site site("building");
    EXPECT_EQ(site.put(1, 9, 0).reason, Rejection::UnknownAction);
    EXPECT_EQ(site.put(1, games::putBox, 0, -16.0f).reason, Rejection::TooFar);
    EXPECT_EQ(site.put(1, games::putBox, 19).reason, Rejection::BadDefinition);
    EXPECT_EQ(site.put(1, games::putBox, 161).reason, Rejection::BadDefinition);
    EXPECT_EQ(site.put(1, games::putBox, -100).reason, Rejection::BadDefinition);
    EXPECT_EQ(site.say(1, Spawn{{boxAt({0.0f, 20.0f})}, {}}).reason, Rejection::AgainstRules);
    EXPECT_EQ(site.say(0, Custom{games::putBox, 0, 0, {0.0f, 20.0f}}).reason,
              Rejection::AgainstRules)
        << "the host builds by commands of its own";
    ASSERT_EQ(site.put(1, games::putBox, 0).reason, Rejection::None);
    ASSERT_EQ(site.put(2, games::putBox, 0).reason, Rejection::None) << "each by its own clock";
    for (int tick = 1; tick < 14; ++tick) {
        ASSERT_EQ(site.put(1, games::putBox, 0).reason, Rejection::AgainstRules) << tick;
    }
    EXPECT_EQ(site.put(1, games::putBox, 0).reason, Rejection::None) << "15 ticks after";
}

TEST(BuildingGame, WhoHasAsManyAsTheBudgetLosesTheOldest) {
    Site site("building:budget=3,pause=0");
    std::vector<BodyId> put;
    for (int i = 0; i < 5; ++i) {
        ASSERT_EQ(site.put(1, games::putDisc, 40).reason, Rejection::None);
        put.push_back(site.piecesOf(1).back());
        const std::vector<BodyId> there = site.piecesOf(1);
        ASSERT_EQ(there.size(), std::min<std::size_t>(put.size(), 3));
        EXPECT_EQ(there, std::vector<BodyId>(put.end() - static_cast<std::ptrdiff_t>(there.size()),
                                             put.end()));
    }
    ASSERT_EQ(site.say(1, RemoveBody{put[3]}).reason, Rejection::None) << "its own, by command";
    ASSERT_EQ(site.put(1, games::putDisc, 40).reason, Rejection::None);
    EXPECT_EQ(site.piecesOf(1).size(), 3u) << "what went by itself made room";
    EXPECT_TRUE(site.piecesOf(2).empty());
    site.say(0, RemovePlayer{1});
    EXPECT_EQ(stateOf(site.world).pieces[0], 0u);
    EXPECT_EQ(stateOf(site.world).player[0], 0u);
}

TEST(BuildingGame, PiecesGoWhenTheirTimeIsOver) {
    Scene scene = *sceneFromCatalog("building:pause=0");
    scene.rules->parameters = {{"budget", 4.0f}, {"life", 0.5f}, {"pause", 0.0f}};
    World world = worldOf(scene);
    world.step(std::vector<Command>{{0, 1, AddPlayer{1}}});
    world.step({});
    const Vec2 at = motionOf(world, world.players()[1].body).position;
    world.step(std::vector<Command>{{1, 1, Custom{games::putDisc, 0, 40, at - Vec2{0, 4}}}});
    const BodyId piece = world.bodies().back().id;
    run(world, 28);
    EXPECT_TRUE(world.find(piece).has_value());
    run(world, 1);  // 30 ticks, with that in which it came
    EXPECT_FALSE(world.find(piece).has_value());
}

TEST(BuildingGame, AStateThatNoGameComesToIsRefused) {
    Site site("building");
    ASSERT_EQ(site.put(1, games::putBox, 0).reason, Rejection::None);
    const WorldState good = *readSnapshot(site.world.save());
    const auto taken = [&](auto&& spoil) {
        BuildingState s = stateOf(site.world);
        spoil(s);
        WorldState bad = good;
        std::memcpy(bad.rulesWords.data(), &s, sizeof s);
        Result<World> world = World::restore(writeSnapshot(bad));
        if (world.ok()) run(*world, 5);
        return world.ok();
    };
    EXPECT_TRUE(taken([](BuildingState&) {}));
    EXPECT_FALSE(taken([](BuildingState& s) { s.budget = 0; }));
    EXPECT_FALSE(taken([](BuildingState& s) { s.budget = 33; }));
    EXPECT_FALSE(taken([](BuildingState& s) { s.pieces[7] = 13; }));
    EXPECT_TRUE(taken([](BuildingState& s) { s.pieces[7] = 12; })) << "of bodies there are none";
}

}  // namespace
}  // namespace huestep::test
