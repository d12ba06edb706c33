// How the last step was laid out, for people: the plan once more, island by island.

#include <algorithm>
#include <bitset>

#include "core/solver/sweep.h"
#include "core/world/world_data.h"

namespace huestep {

namespace {

/// Islands by their lowest body, with what the links say of them.
struct Collector {
    const Plan& plan;
    const WorldState& state;
    std::vector<std::uint32_t> viewOf;  // by body, of the lowest of an island
    std::vector<IslandView> views{};
    std::vector<std::bitset<colourCount>> colours{};

    std::uint32_t viewFor(std::uint32_t lowest) {
        if (viewOf[lowest] == none) {
            viewOf[lowest] = static_cast<std::uint32_t>(views.size());
            views.emplace_back().body = state.bodies[lowest].id;
            colours.emplace_back();
        }
        return viewOf[lowest];
    }

    /// The island of a link: of whichever of its bodies is solved.
    [[nodiscard]] std::uint32_t islandOf(const Link& link, std::span<const std::uint8_t> awake) {
        return plan.islandOf[awake[link.a] ? link.a : link.b];
    }
};

}  // namespace

StepLayout World::stepLayout() const {
    const Accelerators& acc = m_data->accelerators;
    const Plan& plan = acc.plan;
    StepLayout layout;
    if (!acc.rowsHold) return layout;
    const std::size_t bodies = m_data->state.bodies.size();
    std::vector<std::uint8_t> awake(bodies, 0);
    for (const std::uint32_t body : plan.awake) awake[body] = 1;

    Collector all{plan, m_data->state, std::vector<std::uint32_t>(bodies, none)};
    for (std::size_t i = 0; i < plan.links.size(); ++i) {
        const std::uint32_t at = all.viewFor(all.islandOf(plan.links[i], awake));
        IslandView& view = all.views[at];
        ++(i < plan.jointLinks ? view.joints : view.contacts);
        view.overflow += isSerial(plan.colourOfLink[i]);
        all.colours[at].set(plan.colourOfLink[i]);
    }
    for (const std::uint32_t body : plan.awake) {
        const std::uint32_t at = all.viewOf[plan.islandOf[body]];
        if (at != none) ++all.views[at].bodies;
    }
    for (std::uint32_t b = 0; b < plan.batches.size(); ++b) {
        const Batch& batch = plan.batches[b];
        for (std::uint32_t place = batch.firstPlace; place < batch.endPlace; ++place) {
            const std::uint32_t body = plan.bodyOfPlace[place];
            if (!awake[body] || plan.islandOf[body] != body) continue;
            IslandView& view = all.views[all.viewOf[body]];
            view.giant = batch.giant;
            view.batch = b;
            view.batchConstraints = batch.constraints;
            view.substeps = batch.substeps;
            view.gentle = batch.gentle;
            if (!m_data->state.info().planned()) continue;
            view.trees = batch.trees && plan.jointsOf[body] > 0;
            if (body < m_data->islandEfforts.size()) {
                const RowStrain& strain = m_data->islandEfforts[body].strain;
                view.strain = maxOf(strain.contacts, maxOf(strain.swept, strain.direct));
                view.strainedJoint = maxOf(strain.swept, strain.direct) > strain.contacts;
            }
        }
        if (!batch.giant) continue;
        ++layout.giants;
        layout.colours += batch.endColour - batch.firstColour;
        for (std::uint32_t c = batch.firstColour; c < batch.endColour; ++c) {
            layout.sharedColours += isShared(plan, plan.runs[c]);
        }
    }
    for (std::size_t i = 0; i < all.views.size(); ++i) {
        all.views[i].colours = static_cast<std::uint32_t>(all.colours[i].count());
    }
    const auto size = [](const IslandView& view) { return view.contacts + view.joints; };
    std::stable_sort(all.views.begin(), all.views.end(), [&](const auto& x, const auto& y) {
        return size(x) != size(y) ? size(x) > size(y) : x.body < y.body;
    });
    layout.islands = std::move(all.views);
    layout.freeBodies = static_cast<std::uint32_t>(plan.freeBodies.size());
    layout.batchConstraints = m_data->limitsOf(acc.planSharesAll).batchSize;
    layout.bytesTouched =
        acc.rows.bytes() + bodies * (sizeof(BodyMotion) + sizeof(BodyInfo)) +
        acc.tight.size() * (sizeof(Bounds) + sizeof(Vec2) + sizeof(Hull) + sizeof(Bounds)) +
        acc.candidates.size() * (sizeof(Candidate) + sizeof(std::uint8_t)) +
        plan.jointLinks * (sizeof(JointInfo) + sizeof(JointImpulses));
    return layout;
}

}  // namespace huestep
