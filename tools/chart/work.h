/// Work-precision: how wrong each method is on scenes whose truth is known, and what that costs.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tools/chart/run.h"

namespace huestep::tools::chart {

/// A line of a diagram that no point can be expected to pass.
struct Floor {
    std::string label;
    double error = 0.0;  ///< in the case's unit
};

/// How a contender did on a case.
struct Verdict {
    double error = 0.0;   ///< in the case's unit, ≥ 0; infinite if it failed
    std::string failure;  ///< what went wrong, for people; empty: nothing
};

/// A scene whose right outcome is known.
struct Case {
    std::string id;         ///< of letters, digits and hyphens: names files
    std::string group;      ///< joint, stack, friction, impact or mixed
    std::string metric;     ///< of the physics page: A1 to A20
    std::string title;      ///< a few words
    std::string what;       ///< what the error is the error of, a sentence
    std::string reference;  ///< what it is held against
    std::string unit;       ///< "m", "J/J", …
    std::shared_ptr<const NamedScene> scene;
    std::uint64_t ticks = 60;  ///< judged and timed
    std::vector<Floor> floors;
    std::function<bool(const Contender&)> applies;  ///< whether it says anything of one
    std::function<Result<Verdict>(const Contender&)> judge;
};

/// The groups, in the order of their diagrams.
std::vector<std::string> workGroups();

/// What is charted at this extent.
std::vector<Case> workCases(Extent extent);

/// Substeps that Huestep's methods are charted with.
std::vector<std::uint32_t> workSubsteps(Extent extent);

/// A point of a diagram.
struct WorkPoint {
    const Case* of = nullptr;
    Run run;
    Verdict verdict;
    bool front = false;  ///< no other point of the case beats it

    [[nodiscard]] bool failed() const { return !verdict.failure.empty(); }
};

/// The same, as a failure if it is no number.
Verdict settled(Verdict verdict);

/// Judges and times all contenders on a case. False: interrupted.
Result<bool> measureCase(const Case& of, std::span<const Contender> contenders, Extent extent,
                         std::vector<WorkPoint>& points);

/// A contender over all cases: its errors and times against those of the product as it comes, so
/// that units cancel.
struct Overall {
    Contender contender;
    double error = 0.0;  ///< median over the cases of the ratio; failures count as infinite
    double time = 0.0;   ///< likewise, of CPU time a step
    std::size_t cases = 0;
    std::size_t failures = 0;
    bool front = false;
};

/// `points` of one or more cases; those of a case without a point of the product are left out.
std::vector<Overall> overall(std::span<const WorkPoint> points);

Json asJson(const Case& of);
Json asJson(const WorkPoint& point);
Json asJson(const Overall& row);

}  // namespace huestep::tools::chart
