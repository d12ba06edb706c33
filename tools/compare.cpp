#include "tools/compare.h"

#include <algorithm>
#include <atomic>
#include <functional>
#include <thread>

#include "tools/interrupt.h"
#include "tools/progress.h"

namespace huestep::tools {
namespace {

/// Full roots by step: place i after step i + 1.
using Roots = std::vector<std::uint64_t>;

bool contradicts(const std::map<std::uint64_t, std::uint64_t>& recorded, std::uint64_t tick,
                 std::uint64_t root, std::uint64_t& compared) {
    const auto entry = recorded.find(tick);
    if (entry == recorded.end()) return false;
    ++compared;
    return entry->second != root;
}

/// Plays one combination to its end or its first difference. Without `expected` it is a reference
/// and its roots are put into `made`.
Outcome play(const Story& story, const Way& way, const Roots* expected, Roots* made,
             Progress& progress) {
    Outcome outcome;
    if (interrupted()) return outcome;  // a world for nothing takes time as well
    Playback playback(story, way);
    const World& world = playback.world();
    const std::uint64_t start = story.start->tick();
    while (!playback.done() && !interrupted()) {
        if (const Status stepped = playback.step(); !stepped) {
            outcome.failure = stepped.error().message;
            break;
        }
        progress.advance();
        const std::uint64_t tick = world.tick();
        const std::uint64_t root = world.fullRoot();
        if (made != nullptr) made->push_back(root);
        const bool wrongRecord =
            contradicts(story.motionRoots, tick, world.motionRoot(), outcome.rootsCompared) ||
            contradicts(story.fullRoots, tick, root, outcome.rootsCompared);
        const bool compared =
            expected != nullptr && tick >= story.comparedFrom && tick - start <= expected->size();
        outcome.rootsCompared += compared ? 1 : 0;
        if (wrongRecord || (compared && root != (*expected)[tick - start - 1])) {
            outcome.differsAt = tick;
            outcome.recordDiffers = wrongRecord;
            break;
        }
    }
    // A reference that was stopped has no hashes for the ticks after it.
    const bool whole = expected == nullptr || expected->size() >= world.tick() - start;
    outcome.ended = playback.done() && whole;
    outcome.tick = world.tick();
    outcome.motionRoot = world.motionRoot();
    outcome.fullRoot = world.fullRoot();
    return outcome;
}

/// Calls `f(i)` for every i below `count`, up to `jobs` at a time.
void sideBySide(std::size_t count, int jobs, const std::function<void(std::size_t)>& f) {
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
        for (std::size_t i = next++; i < count; i = next++) f(i);
    };
    std::vector<std::thread> team;
    const std::size_t size = std::min(count, static_cast<std::size_t>(std::max(jobs, 1)));
    for (std::size_t t = 1; t < size; ++t) team.emplace_back(work);
    work();
    for (std::thread& thread : team) thread.join();
}

}  // namespace

bool Comparison::finished() const {
    return decided() == outcomes.size();
}

std::size_t Comparison::decided() const {
    const auto count = std::count_if(outcomes.begin(), outcomes.end(),
                                     [](const Outcome& outcome) { return outcome.decided(); });
    return static_cast<std::size_t>(count);
}

Comparison playAll(const std::vector<Story>& stories, const std::vector<Combination>& combinations,
                   int jobs) {
    // The first combination of a story that is its own reference goes first; then all others.
    std::vector<std::size_t> first;
    std::vector<std::size_t> others;
    std::vector<bool> referenced(stories.size(), false);
    std::uint64_t steps = 0;
    for (std::size_t i = 0; i < combinations.size(); ++i) {
        const std::size_t story = combinations[i].story;
        const bool leads = stories[story].reference == story && !referenced[story];
        if (leads) referenced[story] = true;
        (leads ? first : others).push_back(i);
        steps += stories[story].steps();
    }

    Comparison result;
    result.outcomes.resize(combinations.size());
    std::vector<Roots> roots(stories.size());
    Progress progress("comparing", steps);
    sideBySide(first.size(), jobs, [&](std::size_t k) {
        const Combination& c = combinations[first[k]];
        result.outcomes[first[k]] =
            play(stories[c.story], c.way, nullptr, &roots[c.story], progress);
    });
    sideBySide(others.size(), jobs, [&](std::size_t k) {
        const Combination& c = combinations[others[k]];
        const Story& story = stories[c.story];
        result.outcomes[others[k]] = play(story, c.way, &roots[story.reference], nullptr, progress);
    });
    return result;
}

Result<std::optional<Difference>> nameDifference(const std::vector<Story>& stories,
                                                 const Combination& reference,
                                                 const Combination& other, std::uint64_t tick) {
    const Result<World> left = worldAt(stories[reference.story], reference.way, tick);
    if (!left) return left.error();
    const Result<World> right = worldAt(stories[other.story], other.way, tick);
    if (!right) return right.error();
    return firstDifference(*left, *right);
}

}  // namespace huestep::tools
