// Checkpoints: going back and on again gives the same hashes, whatever was done in between.
//
// The oracle is the world itself, which ran through without ever going back. A failing run is
// repeated with HUESTEP_SEED=… as printed.

#include <array>
#include <cstdlib>
#include <new>

#include "tests/determinism/random_scene.h"
#include "tests/determinism/script.h"

// A sanitizer brings its own operators; g++ and clang say each in its way that there is one.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#elif defined(__has_feature)
#if !__has_feature(address_sanitizer) && !__has_feature(thread_sanitizer)
#define HUESTEP_COUNT_ALLOCATIONS 1
#endif
#else
#define HUESTEP_COUNT_ALLOCATIONS 1
#endif

#ifdef HUESTEP_COUNT_ALLOCATIONS

namespace {
std::size_t allocations = 0;
}

// Counted for one test; they do what the standard's do.
[[gnu::noinline]] void* operator new(std::size_t size) {
    ++allocations;
    if (void* memory = std::malloc(size != 0 ? size : 1)) return memory;
    throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
    ++allocations;
    const auto unit = static_cast<std::size_t>(alignment);
    if (void* memory = std::aligned_alloc(unit, (size + unit - 1) / unit * unit)) return memory;
    throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
    std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept {
    std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
    std::free(memory);
}
#endif

namespace huestep::test {
namespace {

/// What a world was told and what came of it, tick by tick.
struct Past {
    std::vector<std::vector<Command>> commands;  // of the step that leads from a tick
    std::vector<std::uint64_t> roots;            // full, by tick
    std::vector<Events> events;                  // of the step that led to a tick

    explicit Past(const World& start) : roots{start.fullRoot()}, events{start.events()} {}
};

/// Goes through the ticks of a past that the world has before it.
void follow(World& world, const Past& past, const StepResources& with, const char* when) {
    while (world.tick() + 1 < past.roots.size()) {
        world.step(past.commands[world.tick()], with);
        ASSERT_EQ(world.fullRoot(), past.roots[world.tick()]) << when << ", tick " << world.tick();
        ASSERT_EQ(world.events(), past.events[world.tick()]) << when << ", tick " << world.tick();
    }
}

/// Runs a world with checkpoints in few vessels; goes back at random, takes wrong ways, comes back.
void goBackAndForth(const World& start, std::uint64_t ticks, int threads, Random& random) {
    Executor executor(threads, random.roll());
    const StepResources with{&executor};
    World straight = start;  // never goes back
    World world = start;
    Past past(start);
    std::array<Checkpoint, 5> vessels;
    std::uint64_t sequence = 0;
    while (straight.tick() < ticks) {
        past.commands.push_back(randomCommands(random, straight, sequence));
        straight.step(past.commands.back(), with);
        past.roots.push_back(straight.fullRoot());
        past.events.push_back(straight.events());
        ASSERT_NO_FATAL_FAILURE(follow(world, past, with, "going on"));
        if (random.once(3)) world.checkpoint(vessels[random.below(vessels.size())]);
        if (random.once(40)) world.dropAccelerators();
        if (!random.once(6)) continue;
        const Checkpoint& back = vessels[random.below(vessels.size())];
        if (back.empty()) continue;
        // A wrong prediction first, with a checkpoint on its way that must not matter.
        std::uint64_t wrong = sequence;
        for (std::uint32_t i = random.below(6); i > 0; --i) {
            world.step(randomCommands(random, world, wrong), with);
        }
        Checkpoint onTheWay;
        if (random.once(2)) world.checkpoint(onTheWay);
        world.restore(back);
        ASSERT_EQ(world.tick(), back.tick());
        ASSERT_EQ(world.fullRoot(), past.roots[world.tick()]) << "back at tick " << world.tick();
        ASSERT_EQ(world.events(), past.events[world.tick()]);
        ASSERT_NO_FATAL_FAILURE(follow(world, past, with, "after going back"));
        ASSERT_EQ(differenceOf(straight, world), "");
    }
}

class RandomCheckpoints : public testing::TestWithParam<int> {};

TEST_P(RandomCheckpoints, LeadToTheSameFutureWhateverHappenedInBetween) {
    Random random(31'000 + static_cast<std::uint64_t>(GetParam()));
    SCOPED_TRACE(random.trace());
    const World start = worldOf(randomScene(random));
    goBackAndForth(start, 160, 1, random);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomCheckpoints, testing::Range(0, 16));

TEST(Checkpoint, OfAWorldThatManyThreadsStepLeadsToTheSameFuture) {
    for (const int threads : {1, 2, 8}) {
        Random random(32'000);
        SCOPED_TRACE(random.trace() + ", threads " + std::to_string(threads));
        for (const char* scene : {"pyramid:base=36", "mixed", "many_pyramids:rows=3,columns=4"}) {
            SCOPED_TRACE(scene);
            ASSERT_NO_FATAL_FAILURE(
                goBackAndForth(worldOf(scene), threads < 8 ? 60 : 15, threads, random));
        }
    }
}

TEST(Checkpoint, LeadsBackFromEveryTickAlsoWhereThePlanHasStayed) {
    // Leaning columns of hinged boxes: their levels of effort rise on a ramp of many ticks in which
    // no contact comes or goes, so that the plan of the undone ticks is the one gone back to.
    for (const char* scene : {"hinges", "chain", "mixed"}) {
        World straight = worldOf(scene);
        World world = straight;
        Checkpoint back;
        while (straight.tick() < 240) {
            world.checkpoint(back);
            run(world, 7);
            world.restore(back);
            world.step({});
            straight.step({});
            ASSERT_EQ(world.fullRoot(), straight.fullRoot())
                << scene << ", tick " << straight.tick();
        }
    }
}

TEST(Checkpoint, OfAWorldThatWasNeverSteppedIsItsBeginning) {
    World world = worldOf("mixed");
    Checkpoint start;
    EXPECT_TRUE(start.empty());
    world.checkpoint(start);
    EXPECT_FALSE(start.empty());
    EXPECT_EQ(start.tick(), 0u);
    const std::uint64_t root = world.fullRoot();
    run(world, 30);
    const std::uint64_t later = world.fullRoot();
    world.restore(start);
    EXPECT_EQ(world.fullRoot(), root);
    run(world, 30);
    EXPECT_EQ(world.fullRoot(), later);
}

TEST(Checkpoint, MayBeTakenOverByAnotherWorldAndOutliveItsOwn) {
    Random random(33'000);
    SCOPED_TRACE(random.trace());
    for (int round = 0; round < 4; ++round) {
        World other = worldOf(randomScene(random));
        run(other, static_cast<int>(random.below(60)));
        // The other's own checkpoints stay its own, and good.
        Checkpoint own;
        other.checkpoint(own);
        const std::uint64_t ownRoot = other.fullRoot();

        Checkpoint taken;
        std::vector<std::uint64_t> roots;
        {
            World world = worldOf(randomScene(random));
            run(world, 20 + static_cast<int>(random.below(60)));
            world.checkpoint(taken);
            for (int tick = 0; tick < 30; ++tick) {
                roots.push_back(world.fullRoot());
                world.step({});
            }
        }
        // Stamps of two histories meet in one world: checkpoints on the way tell them apart.
        Checkpoint between;
        const auto goOn = [&](std::size_t from) {
            for (std::size_t tick = from; tick < roots.size(); ++tick) {
                ASSERT_EQ(other.fullRoot(), roots[tick]) << "tick " << tick;
                if (from == 0 && tick == 7) other.checkpoint(between);
                other.step({});
            }
        };
        for (int again = 0; again < 2; ++again) {
            other.restore(taken);
            ASSERT_NO_FATAL_FAILURE(goOn(0));
            other.restore(between);
            ASSERT_NO_FATAL_FAILURE(goOn(7));
        }
        other.restore(own);
        EXPECT_EQ(other.fullRoot(), ownRoot);
    }
}

TEST(Checkpoint, CarriesEventsReportAndContactViews) {
    World world = worldOf("pyramid:base=6");
    run(world, 20);
    const Events events = world.events();
    const std::size_t views = world.contactViews().size();
    const std::uint32_t contacts = world.report().contacts;
    ASSERT_GT(views, 0u);
    Checkpoint here;
    world.checkpoint(here);
    world.step(std::vector<Command>{{0, 1, RemoveBody{2}}});
    world.restore(here);
    EXPECT_EQ(world.events(), events);
    EXPECT_EQ(world.contactViews().size(), views);
    EXPECT_EQ(world.report().contacts, contacts);
}

#ifdef HUESTEP_COUNT_ALLOCATIONS
TEST(Checkpoint, AllocatesNothingOnceItIsWarm) {
    World world = worldOf("pyramid:base=20");
    run(world, 30);
    std::array<Checkpoint, 2> vessels;
    for (Checkpoint& vessel : vessels) world.checkpoint(vessel);
    for (int round = 0; round < 3; ++round) {
        run(world, 1);
        const std::size_t before = allocations;
        world.checkpoint(vessels[round % 2 == 0 ? 0 : 1]);
        world.restore(vessels[round % 2 == 0 ? 1 : 0]);
        EXPECT_EQ(allocations, before) << "round " << round;
    }
}
#endif

}  // namespace
}  // namespace huestep::test
