/// How a batch is solved: the product's soft step, and the methods it is charted against.
///
/// All methods share the plan, the rows and the stages around them; what differs is how a batch's
/// rows are gone over between the start of the step and its end (physics page, "Methods in the
/// chart").
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "core/parallel/executor.h"
#include "core/scene/scene.h"
#include "core/solver/rows.h"

namespace huestep {

struct ContactKernels;
struct RevoluteKernels;
class JointTrees;

/// Who works on a batch: one of `workers` that all come here, and meet at barriers.
struct Team {
    int worker = 0;
    int workers = 1;
    Executor* executor = nullptr;  ///< of more than one worker

    void barrier() const {
        if (workers > 1) executor->barrier(worker);
    }
};

/// A worker's share of [0, count): contiguous, sizes differing by at most one.
struct Share {
    std::uint32_t begin, end;
    Share(std::uint32_t count, const Team& team) {
        const auto w = static_cast<std::uint64_t>(team.worker);
        const auto n = static_cast<std::uint64_t>(team.workers);
        begin = static_cast<std::uint32_t>(count * w / n);
        end = static_cast<std::uint32_t>(count * (w + 1) / n);
    }
};

/// A batch whose rows are made: bodies at the start of the step with the velocities they had
/// before its forces, impulses those of the last step.
struct BatchTask {
    const Plan& plan;
    const Batch& batch;
    Rows& rows;
    float stepSeconds;         ///< s
    std::uint32_t substeps;    ///< n; of methods without substeps: iterations
    float ramp;                ///< share of their frequency that rows have: (0, 1]
    bool gentle;               ///< whether contacts may be stiffer
    ContactFeatures features;  ///< of all contact rows
    const ContactKernels& contacts;
    const RevoluteKernels& revolutes;
    JointTrees* trees = nullptr;  ///< of the batch, if it has any
};

/// Brings the batch's bodies to the end of the step and leaves the impulses in its rows.
using BatchSolver = void (*)(const BatchTask& task, const Team& team);

/// What a method is and needs.
struct MethodTraits {
    Method method;
    std::string_view name;     ///< as on the command line
    std::string_view summary;  ///< a line for people
    BatchSolver solve;
    bool colours;             ///< else the plan has key order alone: overflow, then fixed overflow
    bool teams;               ///< whether several workers may go through one batch together
    bool deterministic;       ///< else the bits depend on how threads meet
    bool substepping = true;  ///< else one step of Δt; a scene's substeps are iterations
    bool recovers = false;    ///< brings bodies apart as recovery.h has it
    bool hubs = true;         ///< as in `PlanDemand`, the next three too
    bool pinLanes = false;
    bool incidence = false;
    bool trees = false;
    /// Makes room for what the method needs, before its batches; null: nothing.
    void (*fit)(MethodMemory& memory, const Plan& plan) = nullptr;
};

/// What a method asks of the plan of a step.
PlanDemand demandOf(const MethodTraits& method, std::uint32_t substeps);

const MethodTraits& traitsOf(Method method);
std::span<const MethodTraits> allMethods();
std::optional<Method> methodNamed(std::string_view name);

}  // namespace huestep
