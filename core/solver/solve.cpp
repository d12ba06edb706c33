#include "core/solver/solve.h"

#include <algorithm>

#include "core/parallel/over_range.h"
#include "core/solver/contact_kernels.h"
#include "core/solver/effort.h"

namespace huestep {

namespace {

constexpr std::uint32_t bodyGrain = 256;
constexpr std::uint32_t blockGrain = 16;
constexpr std::uint32_t jointGrain = 128;

/// What solving a plan's batches takes.
struct Job {
    Rows& rows;
    const Plan& plan;
    const SolverWorld& world;
    const MethodTraits& method;
    Simd simd;

    [[nodiscard]] float secondsOf(const Batch& batch) const {
        if (!method.substepping) return world.stepSeconds;
        return world.stepSeconds / static_cast<float>(batch.substeps);
    }
    [[nodiscard]] JointTrees* treesOf(const Batch& batch) const {
        if (!batch.trees || batch.firstJoint == batch.endJoint) return nullptr;
        return &rows.trees[static_cast<std::size_t>(&batch - plan.batches.data())];
    }
    /// Of joints whose rows are made.
    void buildTrees(const Batch& batch) const {
        if (JointTrees* trees = treesOf(batch)) trees->build(plan, batch, rows);
    }
    [[nodiscard]] BatchTask taskOf(const Batch& batch, ContactFeatures features) const {
        return {plan,
                batch,
                rows,
                world.stepSeconds,
                batch.substeps,
                rampShare(batch.ramp),
                batch.gentle,
                features,
                contactKernels(simd),
                revoluteKernels(simd),
                treesOf(batch)};
    }
};

/// One island that is larger than a batch: every stage on all threads.
void solveGiant(const Job& job, const Batch& batch, Executor* executor,
                std::vector<ContactHit>& hits, StageTimer& timer) {
    const auto over = [&](std::uint32_t first, std::uint32_t last, std::uint32_t grain, auto&& f) {
        overRange(executor, last - first, grain, [&](std::uint32_t begin, std::uint32_t end) {
            f(Rows::Range{first + begin, first + end}, begin / grain);
        });
    };
    const float h = job.secondsOf(batch);
    over(batch.firstPlace, batch.endCopy, bodyGrain, [&](Rows::Range range, std::uint32_t) {
        job.rows.prepareBodies(job.plan, job.world, h, range);
    });
    over(batch.firstJoint, batch.endJoint, jointGrain, [&](Rows::Range range, std::uint32_t) {
        job.rows.prepareJoints(job.plan, job.world, batch, h, range);
    });
    over(batch.firstRevoluteBlock, batch.endRevoluteBlock, blockGrain,
         [&](Rows::Range range, std::uint32_t) {
             job.rows.prepareRevolutes(job.plan, job.world, batch, h, range);
         });
    job.buildTrees(batch);
    const std::uint32_t blocks = batch.endBlock - batch.firstBlock;
    const ContactKernels& kernels = contactKernels(job.simd);
    auto features = perBlock<ContactFeatures>(blocks, blockGrain);
    over(batch.firstBlock, batch.endBlock, blockGrain, [&](Rows::Range range, std::uint32_t index) {
        job.rows.prepareContacts(job.plan, job.world, batch, kernels, range, features[index]);
    });
    ContactFeatures all;
    for (const ContactFeatures& f : features) all = all | f;
    timer.done(Stage::Prepare);

    const BatchTask task = job.taskOf(batch, all);
    const int workers = executor != nullptr && job.method.teams ? executor->workersNow() : 1;
    if (workers == 1) {
        job.method.solve(task, {});
    } else {
        executor->onAllWorkers([&](int worker) {
            job.method.solve(task, {worker, workers, executor});
        });
    }
    timer.done(Stage::Solve);

    auto found = perBlock<std::vector<ContactHit>>(blocks, blockGrain);
    over(batch.firstBlock, batch.endBlock, blockGrain, [&](Rows::Range range, std::uint32_t index) {
        job.rows.settleContacts(job.plan, job.world, kernels, range, found[index]);
    });
    for (const auto& part : found) hits.insert(hits.end(), part.begin(), part.end());
    over(batch.firstJoint, batch.endJoint, jointGrain,
         [&](Rows::Range range, std::uint32_t) { job.rows.storeJoints(job.world, range); });
    over(batch.firstRevoluteBlock, batch.endRevoluteBlock, blockGrain,
         [&](Rows::Range range, std::uint32_t) {
             job.rows.storeRevolutes(job.plan, job.world, revoluteKernels(job.simd), range);
         });
    timer.done(Stage::Store);
}

/// A batch of whole islands on one thread, from its rows to its impulses.
void solveWhole(const Job& job, const Batch& batch, std::vector<ContactHit>& hits) {
    Rows& rows = job.rows;
    const float h = job.secondsOf(batch);
    const ContactKernels& kernels = contactKernels(job.simd);
    const Rows::Range blocks{batch.firstBlock, batch.endBlock};
    const Rows::Range joints{batch.firstJoint, batch.endJoint};
    const Rows::Range revolutes{batch.firstRevoluteBlock, batch.endRevoluteBlock};
    ContactFeatures features;
    rows.prepareBodies(job.plan, job.world, h, {batch.firstPlace, batch.endCopy});
    rows.prepareJoints(job.plan, job.world, batch, h, joints);
    rows.prepareRevolutes(job.plan, job.world, batch, h, revolutes);
    job.buildTrees(batch);
    rows.prepareContacts(job.plan, job.world, batch, kernels, blocks, features);
    job.method.solve(job.taskOf(batch, features), {});
    rows.settleContacts(job.plan, job.world, kernels, blocks, hits);
    rows.storeJoints(job.world, joints);
    rows.storeRevolutes(job.plan, job.world, revoluteKernels(job.simd), revolutes);
}

}  // namespace

void solve(Rows& rows, const Plan& plan, const SolverWorld& world, const MethodTraits& method,
           Simd simd, Executor* executor, std::vector<ContactHit>& hits, StageTimer& timer) {
    rows.fit(plan);
    if (method.fit != nullptr) method.fit(rows.memory, plan);
    const Job job{rows, plan, world, method, simd};
    std::vector<std::uint32_t> small;
    for (std::uint32_t i = 0; i < plan.batches.size(); ++i) {
        if (plan.batches[i].giant) {
            solveGiant(job, plan.batches[i], executor, hits, timer);
        } else {
            small.push_back(i);
        }
    }
    // Whoever is free takes the next batch; none touches what another writes.
    std::vector<std::vector<ContactHit>> found(small.size());
    overRange(executor, small.size(), 1, [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t i = begin; i < end; ++i) {
            solveWhole(job, plan.batches[small[i]], found[i]);
        }
    });
    for (const auto& part : found) hits.insert(hits.end(), part.begin(), part.end());
    std::sort(hits.begin(), hits.end(), keyBefore<ContactHit>);
    timer.done(Stage::Batches);
}

}  // namespace huestep
