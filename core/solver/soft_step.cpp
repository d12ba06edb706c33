#include "core/solver/soft_step.h"

#include <algorithm>
#include <array>

#include "core/math/lanes.h"
#include "core/math/trig.h"
#include "core/parallel/over_range.h"
#include "core/solver/contact_kernels.h"

namespace huestep {

namespace {

// Frequencies follow the substep; at n = 4 and 60 Hz they are the 30 and 60 Hz that the field has
// settled on (physics page, 2 and "Starting point"). Damping of joints by measurement: with 2 a
// pendulum loses 0.33 % of its energy in 10 s, with 1 it loses 0.19 %.
constexpr float contactFrequency = 0.125f;  // of the substep rate
constexpr float jointFrequency = 0.25f;
constexpr float contactDamping = 10.0f;
constexpr float jointDamping = 1.0f;
constexpr float pushSpeed = 3.0f;  // m/s

constexpr std::uint32_t bodyGrain = 256;
constexpr std::uint32_t blockGrain = 16;
constexpr std::uint32_t jointGrain = 128;
constexpr std::uint32_t jointsAsLanes = 8;  // a joint one by one takes as long as so many in lanes

/// Worker's share of [0, count): contiguous, sizes differing by at most one.
struct Share {
    std::uint32_t begin, end;
    Share(std::uint32_t count, int worker, int workers) {
        const auto w = static_cast<std::uint64_t>(worker);
        const auto n = static_cast<std::uint64_t>(workers);
        begin = static_cast<std::uint32_t>(count * w / n);
        end = static_cast<std::uint32_t>(count * (w + 1) / n);
    }
};

}  // namespace

bool isShared(const Plan& plan, const ColourRun& run) {
    return !isSerial(run.colour) && !isHub(run.colour) &&
           run.contactCount + run.revoluteCount + jointsAsLanes * run.jointCount >= plan.sharedFrom;
}

/// Constants of all passes over one batch.
struct SoftStep::Pass {
    const ContactKernels* contacts;
    const RevoluteKernels* revolutes;
    float h;
    std::uint32_t substeps;
    ContactPass moving;  // between two bodies that move
    ContactPass fixed;   // against a body that does not
    JointPass biased, relaxed;

    void use(ContactFeatures features) { moving.features = fixed.features = features; }
};

SoftStep::Pass SoftStep::makePass(const SolverWorld& world, Simd simd) {
    Pass pass{};
    pass.contacts = &contactKernels(simd);
    pass.revolutes = &revoluteKernels(simd);
    pass.h = world.stepSeconds / static_cast<float>(world.substeps);
    pass.substeps = world.substeps;
    const float rate = 1.0f / pass.h;
    pass.moving.soft = softness(contactFrequency * rate, contactDamping, pass.h);
    pass.moving.inverseH = rate;
    pass.moving.pushSpeed = pushSpeed;
    pass.fixed = pass.moving;
    pass.fixed.soft = softness(2.0f * contactFrequency * rate, contactDamping, pass.h);
    pass.relaxed.h = pass.h;
    pass.relaxed.inverseH = rate;
    pass.biased = pass.relaxed;
    pass.biased.soft = softness(jointFrequency * rate, jointDamping, pass.h);
    return pass;
}

/// What one pass over all colours does with each kind of constraint; null: nothing.
struct SoftStep::Sweep {
    void (*joint)(SolverBody* bodies, JointRow& row, const JointPass& pass);
    RevoluteKernel RevoluteKernels::*revolute;
    ContactKernel ContactKernels::*contact;
};
const SoftStep::Sweep SoftStep::warmStartSweep{
    [](SolverBody* bodies, JointRow& row, const JointPass&) { warmStartJoint(bodies, row); },
    &RevoluteKernels::warmStart, &ContactKernels::warmStart};
const SoftStep::Sweep SoftStep::warmStartAgainSweep{
    warmStartSweep.joint, &RevoluteKernels::warmStart, &ContactKernels::warmStartAgain};
const SoftStep::Sweep SoftStep::solveSweep{solveJoint, &RevoluteKernels::solve,
                                           &ContactKernels::solve};
const SoftStep::Sweep SoftStep::relaxSweep{solveJoint, &RevoluteKernels::solve,
                                           &ContactKernels::relax};
const SoftStep::Sweep SoftStep::restituteSweep{nullptr, nullptr, &ContactKernels::restitute};

/// A hub's contacts, bucket by bucket: each lane works on a copy of the hub, and the mean of the
/// copies is what becomes of the hub. Lanes that act share its mass; those that do not would make
/// it the heavier. The sum has a fixed shape of eight lanes, whatever the kernel's width.
void SoftStep::sweepHub(const ColourRun& run, ContactKernel kernel, const ContactKernels& kernels,
                        const ContactPass& pass) {
    constexpr std::uint32_t sumLanes = 8;
    SolverBody& hub = m_bodies[run.hub];
    SolverBody* copies = m_bodies.data() + run.firstCopy;
    for (std::uint32_t first = 0; first < run.contactCount; first += blockLanes) {
        const std::uint32_t lanes =
            std::min(run.contactCount - first, static_cast<std::uint32_t>(blockLanes));
        ContactBlock& block = m_blocks[run.firstBlock + first / blockLanes];
        std::fill_n(copies, lanes, hub);
        const std::uint32_t acting = kernels.countActive(m_bodies.data(), block, pass);
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
            kernels.shareHub(m_bodies.data(), block, hubIsA.data(),
                             shares * m_sources[run.hub].inverseInertia);
        }
        const LaneF<4> before = loadLanes<4>(&hub.vx);
        kernel(m_bodies.data(), &block, lanes, pass);
        std::array<LaneF<4>, sumLanes> sum{};
        for (std::uint32_t i = 0; i < lanes; ++i) {
            sum[i % sumLanes] += loadLanes<4>(&copies[i].vx) - before;
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
void SoftStep::sweepColour(const ColourRun& run, const Sweep& sweep, const JointPass& joint,
                           const Pass& pass, int worker, int workers) {
    const ContactPass& contactPass = run.colour >= firstFixedColour ? pass.fixed : pass.moving;
    if (isHub(run.colour)) {
        sweepHub(run, pass.contacts->*sweep.contact, *pass.contacts, contactPass);
        return;
    }
    // Constraints of the overflow share bodies: one by one, in key order.
    const bool serial = isSerial(run.colour);
    const auto shareOf = [&](std::uint32_t count) { return Share(count, worker, workers); };
    SolverBody* bodies = m_bodies.data();
    const Share joints = shareOf(sweep.joint != nullptr ? run.jointCount : 0);
    for (std::uint32_t i = joints.begin; i < joints.end; ++i) {
        sweep.joint(bodies, m_joints[run.firstJoint + i], joint);
    }
    // Whole blocks are shared out; padding of the last one is left out.
    const auto overBlocks = [&](std::uint32_t count, auto&& f) {
        const Share blocks = shareOf(blocksOf(count));
        if (blocks.begin == blocks.end) return;
        const std::uint32_t last = std::min(blocks.end * blockLanes, count);
        f(blocks.begin, last - blocks.begin * blockLanes);
    };
    overBlocks(sweep.revolute != nullptr ? run.revoluteCount : 0,
               [&](std::uint32_t first, std::uint32_t n) {
                   (pass.revolutes->*sweep.revolute)(
                       bodies, m_revolutes.data() + run.firstRevoluteBlock + first, n, joint);
               });
    const ContactKernels& contacts = serial ? contactKernels(Simd::Scalar) : *pass.contacts;
    overBlocks(run.contactCount, [&](std::uint32_t first, std::uint32_t n) {
        (contacts.*sweep.contact)(bodies, m_blocks.data() + run.firstBlock + first, n, contactPass);
    });
}

/// The substeps of one batch. With several workers every stage is shared out and ends in a barrier;
/// with one the same stages run through without.
void SoftStep::substeps(const Plan& plan, const Batch& batch, const Pass& pass, int worker,
                        int workers, Executor* executor) {
    const auto barrier = [&] {
        if (workers > 1) executor->barrier(worker);
    };
    const Share places(batch.endPlace - batch.firstPlace, worker, workers);
    const auto overBodies = [&](auto&& f) {
        for (std::uint32_t i = places.begin; i < places.end; ++i) {
            f(batch.firstPlace + i);
        }
        barrier();
    };
    const auto overColours = [&](const Sweep& sweep, const JointPass& joint) {
        for (std::uint32_t c = batch.firstColour; c < batch.endColour; ++c) {
            // Colours too small to share go through one worker, one after another, without a
            // barrier between: a hub has dozens of them.
            const bool shared = workers > 1 && isShared(plan, plan.runs[c]);
            if (shared) {
                sweepColour(plan.runs[c], sweep, joint, pass, worker, workers);
            } else if (worker == 0) {
                sweepColour(plan.runs[c], sweep, joint, pass, 0, 1);
            }
            if (c + 1 == batch.endColour || shared || isShared(plan, plan.runs[c + 1])) barrier();
        }
    };
    const bool hasJoints =
        batch.firstJoint < batch.endJoint || batch.firstRevoluteBlock < batch.endRevoluteBlock;
    const float h = pass.h;
    for (std::uint32_t substep = 0; substep < pass.substeps; ++substep) {
        // The last impulses start the substep. Contact rows keep their arms over the step, so what
        // they would do to a body is what they did to it in the last substep, and a body without
        // joints carries that over by itself (performance page, 5). Joints turn their arms.
        overBodies([&, first = substep == 0](std::uint32_t place) {
            SolverBody& b = m_bodies[place];
            const Source& s = m_sources[place];
            Velocity& before = m_pushed[place];
            const Velocity pushed{b.vx - before.x, b.vy - before.y, b.w - before.w};
            b.vx = (b.vx + h * s.acceleration.x) * s.linearFactor;
            b.vy = (b.vy + h * s.acceleration.y) * s.linearFactor;
            b.w = (b.w + h * s.angularAcceleration) * s.angularFactor;
            before = {b.vx, b.vy, b.w};
            if (first || !s.carries) return;
            b.vx += pushed.x;
            b.vy += pushed.y;
            b.w += pushed.w;
        });
        if (substep == 0) {
            overColours(warmStartSweep, pass.biased);
        } else if (hasJoints) {
            overColours(warmStartAgainSweep, pass.biased);
        }
        overColours(solveSweep, pass.biased);
        overBodies([&](std::uint32_t place) {
            SolverBody& b = m_bodies[place];
            const Source& s = m_sources[place];
            b.dx += h * (b.vx - s.lag.x);
            b.dy += h * (b.vy - s.lag.y);
            const Rotation q = compose(cayley(0.5f * h * b.w), Rotation{b.dc, b.ds});
            b.dc = q.c;
            b.ds = q.s;
        });
        overColours(relaxSweep, pass.relaxed);
    }
    if (pass.moving.features.restitution) {
        overColours(restituteSweep, pass.relaxed);
    }
}

/// One island that is larger than a batch: every stage on all threads.
void SoftStep::solveGiant(const Plan& plan, const SolverWorld& world, const Batch& batch, Pass pass,
                          Executor* executor, std::vector<ContactHit>& hits, StageTimer& timer) {
    const auto over = [&](std::uint32_t first, std::uint32_t last, std::uint32_t grain, auto&& f) {
        overRange(executor, last - first, grain, [&](std::uint32_t begin, std::uint32_t end) {
            f(Range{first + begin, first + end}, begin / grain);
        });
    };
    over(batch.firstPlace, batch.endCopy, bodyGrain,
         [&](Range range, std::uint32_t) { prepareBodies(plan, world, range); });
    over(batch.firstJoint, batch.endJoint, jointGrain,
         [&](Range range, std::uint32_t) { prepareJoints(plan, world, range); });
    over(batch.firstRevoluteBlock, batch.endRevoluteBlock, blockGrain,
         [&](Range range, std::uint32_t) { prepareRevolutes(plan, world, range); });
    const std::uint32_t blocks = batch.endBlock - batch.firstBlock;
    auto features = perBlock<ContactFeatures>(blocks, blockGrain);
    over(batch.firstBlock, batch.endBlock, blockGrain, [&](Range range, std::uint32_t index) {
        prepareBlocks(plan, world, *pass.contacts, range, features[index]);
    });
    ContactFeatures all;
    for (const ContactFeatures& f : features) all = all | f;
    pass.use(all);
    timer.done(Stage::Prepare);

    const int workers = executor != nullptr ? executor->threads() : 1;
    if (workers == 1) {
        substeps(plan, batch, pass, 0, 1, nullptr);
    } else {
        executor->onAllWorkers(
            [&](int worker) { substeps(plan, batch, pass, worker, workers, executor); });
    }
    timer.done(Stage::Solve);

    auto found = perBlock<std::vector<ContactHit>>(blocks, blockGrain);
    over(batch.firstBlock, batch.endBlock, blockGrain, [&](Range range, std::uint32_t index) {
        settleBlocks(plan, world, *pass.contacts, range, found[index]);
    });
    for (const auto& part : found) hits.insert(hits.end(), part.begin(), part.end());
    over(batch.firstJoint, batch.endJoint, jointGrain,
         [&](Range range, std::uint32_t) { storeJoints(world, range); });
    over(batch.firstRevoluteBlock, batch.endRevoluteBlock, blockGrain,
         [&](Range range, std::uint32_t) { storeRevolutes(plan, world, range); });
    timer.done(Stage::Store);
}

void SoftStep::solve(const Plan& plan, const SolverWorld& world, Simd simd, Executor* executor,
                     std::vector<ContactHit>& hits, StageTimer& timer) {
    m_bodies.resize(plan.bodyOfPlace.size());
    m_poses.resize(plan.bodyOfPlace.size());
    m_sources.resize(plan.bodyOfPlace.size());
    m_pushed.resize(plan.bodyOfPlace.size());
    m_joints.resize(plan.jointOrder.size());
    m_revolutes.resize(plan.revoluteOfLane.size() / blockLanes);
    m_blocks.resize(plan.contactOfLane.size() / blockLanes);
    m_blockFeatures.resize(m_blocks.size());
    prepareBodies(plan, world, {0, 1});  // the fixed world
    const Pass pass = makePass(world, simd);

    std::vector<std::uint32_t> small;
    for (std::uint32_t i = 0; i < plan.batches.size(); ++i) {
        if (plan.batches[i].giant) {
            solveGiant(plan, world, plan.batches[i], pass, executor, hits, timer);
        } else {
            small.push_back(i);
        }
    }
    // Whoever is free takes the next batch; none touches what another writes.
    std::vector<std::vector<ContactHit>> found(small.size());
    overRange(executor, small.size(), 1, [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t i = begin; i < end; ++i) {
            const Batch& batch = plan.batches[small[i]];
            Pass mine = pass;
            ContactFeatures features;
            prepareBodies(plan, world, {batch.firstPlace, batch.endCopy});
            prepareJoints(plan, world, {batch.firstJoint, batch.endJoint});
            prepareRevolutes(plan, world, {batch.firstRevoluteBlock, batch.endRevoluteBlock});
            prepareBlocks(plan, world, *pass.contacts, {batch.firstBlock, batch.endBlock},
                          features);
            mine.use(features);
            substeps(plan, batch, mine, 0, 1, nullptr);
            settleBlocks(plan, world, *pass.contacts, {batch.firstBlock, batch.endBlock}, found[i]);
            storeJoints(world, {batch.firstJoint, batch.endJoint});
            storeRevolutes(plan, world, {batch.firstRevoluteBlock, batch.endRevoluteBlock});
        }
    });
    for (const auto& part : found) hits.insert(hits.end(), part.begin(), part.end());
    std::sort(hits.begin(), hits.end(), keyBefore<ContactHit>);
    timer.done(Stage::Batches);
}

}  // namespace huestep
