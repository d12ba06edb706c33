#include "core/solver/method.h"

#include <array>
#include <cassert>

#include "core/solver/avbd.h"
#include "core/solver/jacobi.h"
#include "core/solver/pgs.h"
#include "core/solver/shared_bodies.h"
#include "core/solver/soft_step.h"

namespace huestep {

namespace {

/// Place i: the method whose number is i.
constexpr std::array methods{
    MethodTraits{.method = Method::SoftStep,
                 .name = "soft-step",
                 .summary = "coloured Gauss-Seidel with soft rows and substeps: the product",
                 .solve = solveSoftStep,
                 .colours = true,
                 .teams = true,
                 .deterministic = true,
                 .recovers = true},
    MethodTraits{.method = Method::Sequential,
                 .name = "sequential",
                 .summary = "the same in key order, one constraint after another",
                 .solve = solveSoftStep,
                 .colours = false,
                 .teams = false,
                 .deterministic = true,
                 .recovers = true},
    MethodTraits{.method = Method::Jacobi,
                 .name = "jacobi",
                 .summary = "the same with all constraints of a sweep side by side",
                 .solve = solveJacobi,
                 .colours = false,
                 .teams = true,
                 .deterministic = true,
                 .pinLanes = true,
                 .incidence = true,
                 .fit = fitJacobi},
    MethodTraits{.method = Method::JacobiSplit,
                 .name = "jacobi-split",
                 .summary = "likewise, each with its share of its bodies' mass",
                 .solve = solveJacobiSplit,
                 .colours = false,
                 .teams = true,
                 .deterministic = true,
                 .pinLanes = true,
                 .incidence = true,
                 .fit = fitJacobi},
    MethodTraits{.method = Method::Pgs,
                 .name = "pgs",
                 .summary = "projected Gauss-Seidel over one step, errors in the velocity rows",
                 .solve = solvePgs,
                 .colours = true,
                 .teams = true,
                 .deterministic = true,
                 .substepping = false,
                 .hubs = false},
    MethodTraits{.method = Method::PgsNgs,
                 .name = "pgs-ngs",
                 .summary = "the same without errors in velocities; sweeps over positions follow",
                 .solve = solvePgsNgs,
                 .colours = true,
                 .teams = true,
                 .deterministic = true,
                 .substepping = false,
                 .hubs = false},
    MethodTraits{.method = Method::Locks,
                 .name = "locks",
                 .summary = "the soft step in key order on all threads, a spin lock a body",
                 .solve = solveWithLocks,
                 .colours = false,
                 .teams = true,
                 .deterministic = false,
                 .fit = fitLocks},
    MethodTraits{.method = Method::Atomics,
                 .name = "atomics",
                 .summary = "likewise, with atomic additions to bodies instead of locks",
                 .solve = solveWithAtomics,
                 .colours = false,
                 .teams = true,
                 .deterministic = false},
    MethodTraits{.method = Method::Avbd,
                 .name = "avbd",
                 .summary = "augmented vertex block descent: positions body by body",
                 .solve = solveAvbd,
                 .colours = false,
                 .teams = false,
                 .deterministic = true,
                 .substepping = false,
                 .incidence = true},
    MethodTraits{.method = Method::Direct,
                 .name = "direct",
                 .summary = "block LDLT of joint trees in every substep, all else as in soft-step",
                 .solve = solveSoftStep,
                 .colours = true,
                 .teams = true,
                 .deterministic = true,
                 .recovers = true,
                 .trees = true},
};

}  // namespace

PlanDemand demandOf(const MethodTraits& method, std::uint32_t substeps) {
    PlanDemand demand;
    demand.substeps = substeps;
    demand.colours = method.colours;
    demand.hubs = method.hubs;
    demand.pinLanes = method.pinLanes;
    demand.incidence = method.incidence;
    demand.trees = method.trees;
    return demand;
}

std::span<const MethodTraits> allMethods() {
    return methods;
}

const MethodTraits& traitsOf(Method method) {
    const auto place = static_cast<std::size_t>(method);
    assert(place < methods.size());
    assert(methods[place].method == method);
    return methods[place];
}

std::optional<Method> methodNamed(std::string_view name) {
    for (const MethodTraits& m : methods) {
        if (m.name == name) return m.method;
    }
    return std::nullopt;
}

}  // namespace huestep
