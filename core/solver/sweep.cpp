#include "core/solver/sweep.h"

#include <algorithm>
#include <array>

#include "core/math/lanes.h"
#include "core/solver/contact_kernels.h"

namespace huestep {

namespace {

constexpr std::uint32_t jointsAsLanes = 8;  // a joint one by one takes as long as so many in lanes

}  // namespace

/// A hub's contacts, bucket by bucket: each lane works on a copy of the hub, and the mean of the
/// copies is what becomes of the hub. Lanes that act share its mass; those that do not would make
/// it the heavier. The sum has a fixed shape of eight lanes, whatever the kernel's width.
void ColourSweeper::sweepHub(const ColourRun& run, ContactKernel kernel, ContactPass pass) {
    pass.relaxedBefore = false;  // blocks in which nothing acts are left out, when relaxing too
    const ContactKernels& kernels = m_task.contacts;
    Rows& rows = m_task.rows;
    std::vector<SolverBody>& bodies = rows.bodies;
    constexpr std::uint32_t sumLanes = 8;
    SolverBody& hub = bodies[run.hub];
    SolverBody* copies = bodies.data() + run.firstCopy;
    for (std::uint32_t first = 0; first < run.contactCount; first += blockLanes) {
        const std::uint32_t lanes =
            std::min(run.contactCount - first, static_cast<std::uint32_t>(blockLanes));
        ContactBlock& block = rows.blocks[run.firstBlock + first / blockLanes];
        std::fill_n(copies, lanes, hub);
        const std::uint32_t acting = kernels.countActive(bodies.data(), block, pass);
        if (acting == 0) continue;
        const auto shares = static_cast<float>(acting);
        for (std::uint32_t i = 0; i < lanes; ++i) copies[i].inverseMass = shares * hub.inverseMass;
        if (block.shares != acting) {
            block.shares = acting;
            std::array<std::int32_t, blockLanes> hubIsA{};
            const auto firstCopy = static_cast<BodyPlace>(run.firstCopy);
            for (std::uint32_t i = 0; i < lanes; ++i) {
                hubIsA[i] = block.bodyA[i] == firstCopy + static_cast<BodyPlace>(i) ? -1 : 0;
            }
            kernels.shareHub(bodies.data(), block, hubIsA.data(),
                             shares * rows.sources[run.hub].inverseInertia);
        }
        const LaneF<4> before = loadLanes<4>(&hub.vx);
        kernel(bodies.data(), &block, lanes, pass);
        std::array<LaneF<4>, sumLanes> sum{};
        for (std::uint32_t i = 0; i < lanes; ++i) {
            sum[i % sumLanes] += changeOf<4>(before, loadLanes<4>(&copies[i].vx));
        }
        const LaneF<4> change =
            ((sum[0] + sum[4]) + (sum[2] + sum[6])) + ((sum[1] + sum[5]) + (sum[3] + sum[7]));
        const LaneF<4> after = before + change / splat<4>(shares);
        hub.vx = after[0];
        hub.vy = after[1];
        hub.w = after[2];
    }
}

/// This worker's share of one colour; of a colour that is not shared, all of it on one.
void ColourSweeper::sweepColour(const ColourRun& run, const Sweep& sweep, const SweepPass& pass,
                                const Team& team) {
    const ContactPass& contactPass = contactPassOf(pass, run.colour);
    if (isHub(run.colour)) {
        sweepHub(run, m_task.contacts.*sweep.contact, contactPass);
        return;
    }
    // Constraints of the overflow share bodies: one by one, in key order.
    const bool serial = isSerial(run.colour);
    Rows& rows = m_task.rows;
    SolverBody* bodies = rows.bodies.data();
    const Share joints(sweep.joint != nullptr ? run.jointCount : 0, team);
    for (std::uint32_t i = joints.begin; i < joints.end; ++i) {
        sweep.joint(bodies, rows.joints[run.firstJoint + i], pass.joint);
    }
    // Whole blocks are shared out; padding of the last one is left out.
    const auto overBlocks = [&](std::uint32_t count, auto&& f) {
        const Share blocks(blocksOf(count), team);
        if (blocks.begin == blocks.end) return;
        const std::uint32_t last = std::min(blocks.end * blockLanes, count);
        f(blocks.begin, last - blocks.begin * blockLanes);
    };
    overBlocks(sweep.revolute != nullptr ? run.revoluteCount : 0, [&](std::uint32_t first,
                                                                      std::uint32_t n) {
        (m_task.revolutes.*sweep.revolute)(
            bodies, rows.revolutes.data() + run.firstRevoluteBlock + first, n, pass.joint);
    });
    const ContactKernels& contacts = serial ? contactKernels(Simd::Scalar) : m_task.contacts;
    overBlocks(run.contactCount, [&](std::uint32_t first, std::uint32_t n) {
        (contacts.*sweep.contact)(bodies, rows.blocks.data() + run.firstBlock + first, n,
                                  contactPass);
    });
}

void ColourSweeper::sweep(const Sweep& sweep, const SweepPass& pass) {
    const Plan& plan = m_task.plan;
    const Batch& batch = m_task.batch;
    for (std::uint32_t c = batch.firstColour; c < batch.endColour; ++c) {
        // Colours too small to share go through one worker, one after another, without a barrier
        // between: a hub has dozens of them.
        const bool shared = m_team.workers > 1 && isShared(plan, plan.runs[c]);
        if (shared) {
            sweepColour(plan.runs[c], sweep, pass, m_team);
        } else if (m_team.worker == 0) {
            sweepColour(plan.runs[c], sweep, pass, {});
        }
        if (c + 1 == batch.endColour || shared || isShared(plan, plan.runs[c + 1])) {
            m_team.barrier();
        }
    }
}

bool isShared(const Plan& plan, const ColourRun& run) {
    return !isSerial(run.colour) && !isHub(run.colour) &&
           run.contactCount + run.revoluteCount + jointsAsLanes * run.jointCount >= plan.sharedFrom;
}

}  // namespace huestep
