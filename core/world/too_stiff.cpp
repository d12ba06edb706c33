// What the budget did not reach, for the step's report: which islands, and which row of the worst.

#include "core/solver/effort.h"
#include "core/world/row_strains.h"
#include "core/world/world_data.h"

namespace huestep {

namespace {

/// What of a row's strain more substeps would help.
float helped(const RowStrain& strain) {
    return maxOf(strain.contacts, strain.swept);
}

const Batch* batchOf(const Plan& plan, std::uint32_t island) {
    for (const Batch& batch : plan.batches) {
        for (std::uint32_t p = batch.firstPlace; p < batch.endPlace; ++p) {
            if (plan.islandOf[plan.bodyOfPlace[p]] == island) return &batch;
        }
    }
    return nullptr;
}

}  // namespace

void World::Data::reportTooStiff() {
    const Plan& plan = accelerators.plan;
    TooStiff& worst = report.tooStiff;
    std::uint32_t worstIsland = none;
    for (const std::uint32_t body : plan.awake) {
        if (plan.islandOf[body] != body || plan.constraintsOf[body] == 0) continue;
        const float most = helped(islandEfforts[body].strain);
        const std::uint8_t level = levelOf(state.motions[body].effort);
        if (!(most > 1.0f) || level < affordableEffort(plan.constraintsOf[body])) continue;
        ++worst.islands;
        const std::uint32_t needed = substepsOf(neededEffort(level, most));
        if (needed <= worst.neededSubsteps) continue;
        worstIsland = body;
        worst.body = state.bodies[body].id;
        worst.substeps = substepsOf(level);
        worst.neededSubsteps = needed;
    }
    if (worstIsland != none) nameWorstRow(worstIsland);
}

/// Of equally strained rows the first in the plan, which is the same on every machine.
void World::Data::nameWorstRow(std::uint32_t island) {
    const Plan& plan = accelerators.plan;
    const Batch* batch = batchOf(plan, island);
    if (batch == nullptr) return;
    const RowStrains strains(*this, *batch);
    TooStiff& worst = report.tooStiff;
    const auto idAt = [&](BodyPlace place) {
        // The far end of what holds to the world has no place of its own.
        const auto at = static_cast<std::size_t>(readPlace(place));
        return at == 0 ? BodyId{0} : state.bodies[plan.bodyOfPlace[at]].id;
    };
    float most = 0.0f;
    strains.over([&](BodyPlace a, BodyPlace b, const RowStrain& strain) {
        if (!(helped(strain) > most) || strains.islandOf(a, b) != island) return;
        most = helped(strain);
        worst.joint = strain.swept > strain.contacts;
        worst.bodyA = idAt(a);
        worst.bodyB = idAt(b);
    });
}

}  // namespace huestep
