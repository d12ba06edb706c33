// The broad phase against all pairs: it may find more than overlap tightly, never less, never one
// that is forbidden, and what it finds does not depend on how it got there.

#include "core/collision/broad_phase.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/core/support.h"

namespace huestep::test {
namespace {

struct Scatter {
    std::vector<Bounds> tight;
    std::vector<Vec2> travel;
    std::vector<ShapeProxy> proxies;
    std::vector<ShapePair> forbidden;
    std::vector<std::uint32_t> all;

    explicit Scatter(std::size_t shapes) : tight(shapes), travel(shapes), proxies(shapes) {
        for (std::uint32_t i = 0; i < shapes; ++i) all.push_back(i);
    }

    bool update(BroadPhase& phase, std::span<const std::uint32_t> active,
                Executor* executor = nullptr) const {
        std::vector<std::uint32_t> left;
        for (const std::uint32_t i : active) {
            if (!proxies[i].alone && !phase.holds(i, tight[i])) left.push_back(i);
        }
        return phase.update(tight, travel, left, proxies, forbidden, executor);
    }

    [[nodiscard]] bool may(std::uint32_t a, std::uint32_t b) const {
        const ShapeProxy& p = proxies[a];
        const ShapeProxy& q = proxies[b];
        if (p.body == q.body || (!p.dynamic && !q.dynamic)) return false;
        if (!mayTouch(p.filter, q.filter)) return false;
        const ShapePair bodies{std::min(p.body, q.body), std::max(p.body, q.body)};
        return !std::binary_search(forbidden.begin(), forbidden.end(), bodies);
    }

    /// The pairs whose tight bounds overlap, by trying all.
    [[nodiscard]] std::vector<ShapePair> tightPairs() const {
        std::vector<ShapePair> pairs;
        for (std::uint32_t a = 0; a < tight.size(); ++a) {
            for (std::uint32_t b = a + 1; b < tight.size(); ++b) {
                if (may(a, b) && overlaps(tight[a], tight[b])) pairs.push_back({a, b});
            }
        }
        return pairs;
    }

    void expectComplete(const BroadPhase& phase) const {
        const auto found = phase.pairs();
        ASSERT_TRUE(std::is_sorted(found.begin(), found.end()));
        ASSERT_EQ(std::adjacent_find(found.begin(), found.end()), found.end()) << "twice";
        std::vector<ShapePair> close;
        for (const ShapePair& p : found) {
            ASSERT_LT(p.a, p.b);
            ASSERT_TRUE(may(p.a, p.b)) << p.a << " " << p.b;
            if (overlaps(tight[p.a], tight[p.b])) close.push_back(p);
        }
        const std::vector<ShapePair> exact = tightPairs();
        ASSERT_EQ(close.size(), exact.size());
        ASSERT_TRUE(close == exact);
    }
};

Bounds boxAround(Vec2 center, float halfX, float halfY) {
    return {{center.x - halfX, center.y - halfY}, {center.x + halfX, center.y + halfY}};
}

/// Shapes of sizes from a millimetre to kilometres, some bodies with several, some filtered.
Scatter randomField(Random& random, std::size_t shapes, double span, bool allSizes) {
    Scatter field(shapes);
    for (std::uint32_t i = 0; i < shapes; ++i) {
        const double size = allSizes
                                ? std::pow(10.0, random.between(-3.0, random.once(20) ? 4.0 : 0.5))
                                : random.between(0.2, 1.0);
        field.tight[i] = boxAround(random.point(-span, span), static_cast<float>(size),
                                   static_cast<float>(size * random.between(0.1, 1.0)));
        ShapeProxy& proxy = field.proxies[i];
        proxy.body = i > 0 && random.once(5) ? field.proxies[i - 1].body : i;
        proxy.dynamic = i > 0 && proxy.body != i ? field.proxies[i - 1].dynamic : !random.once(6);
        if (random.once(6)) proxy.filter.mask = 2u;
        if (random.once(6)) proxy.filter.group = random.once(2) ? -3 : 3;
        if (random.once(9)) proxy.filter.mask = 0u;
        field.travel[i] = random.once(4) ? random.point(-3.0, 3.0) : Vec2{};
    }
    std::set<ShapePair> pairs;
    for (std::size_t k = 0; k < shapes / 4; ++k) {
        const std::uint32_t a = field.proxies[random.below(shapes)].body;
        const std::uint32_t b = field.proxies[random.below(shapes)].body;
        if (a != b) pairs.insert({std::min(a, b), std::max(a, b)});
    }
    field.forbidden.assign(pairs.begin(), pairs.end());
    for (ShapeProxy& proxy : field.proxies) {
        for (const ShapePair& p : field.forbidden) {
            proxy.jointed = proxy.jointed || p.a == proxy.body || p.b == proxy.body;
        }
    }
    sortIntoKinds(field.proxies);
    return field;
}

TEST(BroadPhase, MarksOnlyShapesThatNoOtherMayTouch) {
    Random random(70);
    SCOPED_TRACE(random.trace());
    std::size_t alone = 0;
    for (int trial = 0; trial < 30; ++trial) {
        const Scatter field = randomField(random, 1 + random.below(60), 3.0, false);
        for (const std::uint32_t a : field.all) {
            bool any = false;
            for (const std::uint32_t b : field.all) {
                const ShapeProxy& p = field.proxies[a];
                const ShapeProxy& q = field.proxies[b];
                any = any || (p.body != q.body && (p.dynamic || q.dynamic) &&
                              mayTouch(p.filter, q.filter));
            }
            // Shapes of one kind on one body may be taken for a pair's: more work, same pairs.
            EXPECT_FALSE(any && field.proxies[a].alone);
            alone += field.proxies[a].alone;
        }
    }
    EXPECT_GT(alone, 50u);
}

TEST(BroadPhase, MarksNobodyWhereFiltersAreOfVeryManyKinds) {
    std::vector<ShapeProxy> proxies(200);
    for (std::uint32_t i = 0; i < proxies.size(); ++i) {
        proxies[i].body = i;
        proxies[i].dynamic = true;
        proxies[i].filter.group = -1 - static_cast<std::int32_t>(i);
    }
    proxies[7].filter.mask = 0;
    sortIntoKinds(proxies);
    for (const ShapeProxy& proxy : proxies) EXPECT_FALSE(proxy.alone);
}

TEST(BroadPhase, FindsEveryAllowedOverlapOfMovingShapesHoweverTheyMove) {
    Random random(71);
    SCOPED_TRACE(random.trace());
    for (int trial = 0; trial < 12; ++trial) {
        Scatter field = randomField(random, 40 + random.below(300), 12.0, trial % 2 == 0);
        BroadPhase phase;
        field.update(phase, field.all);
        field.expectComplete(phase);
        for (int tick = 0; tick < 25 && !HasFatalFailure(); ++tick) {
            std::vector<std::uint32_t> active;
            const std::uint32_t share = 1 + random.below(12);  // many move, or few
            for (const std::uint32_t i : field.all) {
                if (!random.once(share)) continue;
                active.push_back(i);
                const double far = random.once(30) ? 20.0 : 0.4;
                const Vec2 by = random.point(-far, far);
                field.tight[i] = {field.tight[i].low + by, field.tight[i].high + by};
            }
            const std::vector<ShapePair> before(phase.pairs().begin(), phase.pairs().end());
            const bool changed = field.update(phase, active);
            field.expectComplete(phase);
            EXPECT_EQ(changed, !std::equal(before.begin(), before.end(), phase.pairs().begin(),
                                           phase.pairs().end()));
        }
        if (HasFatalFailure()) return;
    }
}

/// Takes shapes out of a field at random, with whole bodies or not, and puts new ones behind the
/// others; says where the old ones are now, and whom the broad phase must be told of.
struct Exchange {
    Scatter field;
    std::vector<std::uint32_t> placeOf, fresh;

    Exchange(Random& random, const Scatter& old, const Scatter& source) : field(0) {
        const std::uint32_t share = 2 + random.below(20);  // many go, or few
        std::vector<std::uint32_t> bodyPlace(old.proxies.back().body + 1, noPlace);
        std::uint32_t bodies = 0;
        const auto add = [&](const Scatter& from, std::uint32_t i, std::uint32_t body) {
            field.all.push_back(static_cast<std::uint32_t>(field.all.size()));
            field.tight.push_back(from.tight[i]);
            field.travel.push_back(from.travel[i]);
            field.proxies.push_back(from.proxies[i]);
            field.proxies.back().body = body;
        };
        for (const std::uint32_t i : old.all) {
            placeOf.push_back(random.once(share) ? noPlace
                                                 : static_cast<std::uint32_t>(field.all.size()));
            if (placeOf[i] == noPlace) continue;
            std::uint32_t& place = bodyPlace[old.proxies[i].body];
            if (place == noPlace) place = bodies++;
            add(old, i, place);
        }
        for (std::uint32_t i = random.below(30); i > 0; --i) {
            fresh.push_back(static_cast<std::uint32_t>(field.all.size()));
            add(source, random.below(source.all.size()), bodies++);
        }
        field.forbidden = old.forbidden;
        renumberPairs(field.forbidden, bodyPlace);
        sortIntoKinds(field.proxies);
    }
};

TEST(BroadPhase, CarriesItsPairsOverWhenShapesComeAndGo) {
    Random random(75);
    SCOPED_TRACE(random.trace());
    for (int trial = 0; trial < 40; ++trial) {
        Scatter field = randomField(random, 60 + random.below(300), 12.0, trial % 2 == 0);
        BroadPhase phase;
        field.update(phase, field.all);
        for (int tick = 0; tick < 10; ++tick) {
            const Scatter source = randomField(random, 40, 12.0, trial % 2 == 0);
            Exchange exchange(random, field, source);
            std::vector<std::uint32_t> left = exchange.fresh;
            bool sameAlone = true;
            for (const std::uint32_t i : field.all) {
                const std::uint32_t now = exchange.placeOf[i];
                if (now == noPlace) continue;
                sameAlone =
                    sameAlone && field.proxies[i].alone == exchange.field.proxies[now].alone;
            }
            field = exchange.field;
            if (sameAlone) {
                phase.renumber(exchange.placeOf, field.proxies);
                // A joint is gone: two bodies may touch again.
                if (!field.forbidden.empty()) {
                    const ShapePair freed = field.forbidden.back();
                    field.forbidden.pop_back();
                    for (const std::uint32_t i : field.all) {
                        const std::uint32_t body = field.proxies[i].body;
                        if (body != freed.a && body != freed.b) continue;
                        phase.letGo(i);
                        left.push_back(i);
                    }
                }
            } else {
                phase.clear();
                left = field.all;
            }
            field.update(phase, left);
            field.expectComplete(phase);
            if (HasFatalFailure()) return;
        }
    }
}

TEST(BroadPhase, FindsTheSamePairsOnAnyNumberOfThreads) {
    Random random(72);
    SCOPED_TRACE(random.trace());
    const Scatter field = randomField(random, 5'000, 60.0, false);
    BroadPhase alone;
    field.update(alone, field.all);
    field.expectComplete(alone);
    for (const int threads : {1, 2, 5}) {
        Executor executor(threads, 7);
        BroadPhase phase;
        field.update(phase, field.all, &executor);
        ASSERT_TRUE(std::equal(alone.pairs().begin(), alone.pairs().end(), phase.pairs().begin(),
                               phase.pairs().end()));
    }
}

TEST(BroadPhase, FindsOverlapsFarFromTheOriginAndAtTheRimOfTheWorld) {
    Random random(73);
    SCOPED_TRACE(random.trace());
    for (const double far : {1.0e4, 9.9e5}) {
        Scatter field = randomField(random, 300, 10.0, false);
        for (Bounds& b : field.tight) {
            b = {b.low + Vec2{static_cast<float>(far), static_cast<float>(-far)},
                 b.high + Vec2{static_cast<float>(far), static_cast<float>(-far)}};
        }
        BroadPhase phase;
        field.update(phase, field.all);
        field.expectComplete(phase);
    }
}

TEST(BroadPhase, FindsEveryPairOfAsManyShapesOnOneSpotAsThereMayBe) {
    for (const std::size_t shapes : {64u, 65u, 66u, 129u, 130u, 200u}) {
        // All of one size, and fine ones under as many coarse ones.
        for (const bool twoSizes : {false, true}) {
            Scatter field(shapes * (twoSizes ? 2 : 1));
            for (std::uint32_t i = 0; i < field.all.size(); ++i) {
                const float half = i < shapes ? 0.3f : 5.0f;
                field.tight[i] = boxAround({0.1f, 0.1f}, half, half);
                field.proxies[i].body = i;
                field.proxies[i].dynamic = i % 3 != 0;
            }
            BroadPhase phase;
            field.update(phase, field.all);
            field.expectComplete(phase);
            if (testing::Test::HasFatalFailure()) return;
        }
    }
}

TEST(BroadPhase, FindsPairsOfShapesThatAreFasterThanAnyGridIsWide) {
    // A host may push a body to any speed below the rim of the world a tick: its fat box is then
    // wider than the widest cell. Pairs must not depend on whether it was built or updated.
    Random random(74);
    SCOPED_TRACE(random.trace());
    Scatter field = randomField(random, 60, 100.0, false);
    field.forbidden.clear();
    for (std::uint32_t i = 0; i < field.all.size(); ++i) {
        field.proxies[i] = {i, {}, true, false};
        const float far = i % 2 ? 6.0e6f : -6.0e6f;
        field.travel[i] = {far * random.betweenF(0.1, 1.0), far * random.betweenF(-1.0, 1.0)};
    }
    BroadPhase phase;
    field.update(phase, field.all);
    field.expectComplete(phase);
    for (int tick = 0; tick < 10; ++tick) {
        for (Bounds& b : field.tight) {
            const Vec2 by = random.point(-9.0e5, 9.0e5);
            const float half = 0.5f * (b.high.x - b.low.x);
            b = boxAround(by, half, half);
        }
        // Some meet at one place.
        for (std::uint32_t i = 0; i < 10; ++i) field.tight[i] = boxAround({5.0f, 5.0f}, 1.0f, 1.0f);
        field.update(phase, field.all);
        field.expectComplete(phase);
        if (HasFatalFailure()) return;
    }
}

TEST(BroadPhase, OfNothingHasNoPairsAndAfterClearStartsAgain) {
    BroadPhase phase;
    Scatter none(0);
    none.update(phase, {});
    EXPECT_TRUE(phase.pairs().empty());
    Scatter two(2);
    two.proxies = {{0, {}, true, false}, {1, {}, false, false}};
    two.tight = {boxAround({}, 1.0f, 1.0f), boxAround({0.5f, 0.0f}, 1.0f, 1.0f)};
    two.update(phase, two.all);
    EXPECT_EQ(phase.pairs().size(), 1u);
    phase.clear();
    EXPECT_TRUE(phase.pairs().empty());
    two.update(phase, two.all);
    EXPECT_EQ(phase.pairs().size(), 1u);
    EXPECT_EQ(phase.movedCount(), 2u);
    two.update(phase, two.all);
    EXPECT_EQ(phase.movedCount(), 0u) << "nothing left its fat box";
}

}  // namespace
}  // namespace huestep::test
