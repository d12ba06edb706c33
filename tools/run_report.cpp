#include "tools/run_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/solver/effort.h"
#include "tools/clock.h"
#include "tools/engines.h"

namespace huestep::tools {
namespace {

constexpr std::size_t stageCount = static_cast<std::size_t>(Stage::Count);
constexpr double nsPerMs = 1.0e6;

std::vector<double> milliseconds(const std::vector<std::uint64_t>& nanoseconds) {
    std::vector<double> ms(nanoseconds.size());
    std::transform(nanoseconds.begin(), nanoseconds.end(), ms.begin(),
                   [](std::uint64_t ns) { return static_cast<double>(ns) / nsPerMs; });
    return ms;
}

double share(std::uint64_t part, std::uint64_t whole) {
    return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

constexpr std::size_t shownIslands = 5;

/// Why an island was solved as it was.
std::string reasonOf(const IslandView& island, const StepLayout& layout) {
    const std::string own = std::to_string(island.contacts + island.joints);
    const std::string most = std::to_string(layout.batchConstraints);
    if (island.giant)
        return "all threads: " + own + " constraints are more than a batch of " + most;
    return "one thread, batch " + std::to_string(island.batch) + ": " + own +
           " constraints, with others " + std::to_string(island.batchConstraints) + " of at most " +
           most;
}

/// Why an island got its substeps.
std::string effortOf(const IslandView& island) {
    if (island.strain == 0.0f && !island.trees) return std::to_string(island.substeps);
    return std::to_string(island.substeps) + (island.gentle ? ", gentle" : "") +
           (island.trees ? ", joint trees at once" : "") + ": a " +
           (island.strainedJoint ? "joint" : "contact") + " gives way by " +
           number(static_cast<double>(island.strain)) + " of the need";
}

std::string nameOfBody(BodyId body) {
    return body == 0 ? "the world" : "body " + std::to_string(body);
}

/// What a budget did not reach; empty: nothing.
std::string sentenceOf(const TooStiff& stiff) {
    if (stiff.islands == 0) return {};
    return std::to_string(stiff.islands) + " island" + (stiff.islands == 1 ? "" : "s") +
           " too stiff for the budget: that of body " + std::to_string(stiff.body) +
           " has n = " + std::to_string(stiff.substeps) + ", a " +
           (stiff.joint ? "joint" : "contact") + " of it, of " + nameOfBody(stiff.bodyA) + " and " +
           nameOfBody(stiff.bodyB) + ", needs " + std::to_string(stiff.neededSubsteps);
}

Json explanation(const StepLayout& layout) {
    Json islands = Json::array();
    for (std::size_t i = 0; i < std::min(shownIslands, layout.islands.size()); ++i) {
        const IslandView& island = layout.islands[i];
        islands.push_back({{"lowest_body", island.body},
                           {"bodies", island.bodies},
                           {"contacts", island.contacts},
                           {"joints", island.joints},
                           {"colours", island.colours},
                           {"overflow", island.overflow},
                           {"all_threads", island.giant},
                           {"batch", island.batch},
                           {"batch_constraints", island.batchConstraints},
                           {"substeps", island.substeps},
                           {"gentle", island.gentle},
                           {"joint_trees_at_once", island.trees},
                           {"strain", island.strain},
                           {"strained_row", island.strainedJoint ? "joint" : "contact"},
                           {"why", reasonOf(island, layout)}});
    }
    return {{"bytes_touched", layout.bytesTouched},
            {"free_bodies", layout.freeBodies},
            {"giants", layout.giants},
            {"giant_colours", layout.colours},
            {"giant_colours_shared", layout.sharedColours},
            {"batch_constraints_most", layout.batchConstraints},
            {"largest_islands", islands}};
}

}  // namespace

StateCost measureState(const World& world) {
    constexpr int repeats = 7;
    StateCost cost;
    cost.snapshotBytes = world.save().size();
    cost.motionRootNs = cost.fullRootNs = std::numeric_limits<double>::max();
    const auto bodies = static_cast<double>(std::max<std::size_t>(world.bodies().size(), 1));
    for (int i = 0; i < repeats; ++i) {
        const std::uint64_t begin = nanoseconds();
        static_cast<void>(world.motionRoot());
        const std::uint64_t middle = nanoseconds();
        static_cast<void>(world.fullRoot());
        const std::uint64_t end = nanoseconds();
        cost.motionRootNs =
            std::min(cost.motionRootNs, static_cast<double>(middle - begin) / bodies);
        cost.fullRootNs = std::min(cost.fullRootNs, static_cast<double>(end - middle) / bodies);
    }
    return cost;
}

void RunReport::add(const StepReport& step) {
    if (!inside) inside.emplace();
    inside->last = step;
    for (std::size_t s = 0; s < stageCount; ++s) inside->stageNanoseconds[s] += step.nanoseconds[s];
    inside->constraints += step.contacts + step.joints;
    inside->overflow += step.overflow;
    inside->inBuckets += step.inBuckets;
    inside->mostColours = std::max(inside->mostColours, step.colours);
}

void RunReport::close(const Engine& peer, bool explain) {
    motionRoot = peer.hash();
    contacts = peer.contactCount();
    bodies = peer.motions().size();
    const auto* huestep = dynamic_cast<const HuestepEngine*>(&peer);
    if (huestep == nullptr) return;
    if (!inside) inside.emplace();
    const WorldInfo& info = huestep->world().info();
    inside->method = &traitsOf(info.solver());
    const bool given = info.planned() || info.substeps != 0;
    inside->substeps = given ? info.substeps : substepsOf(standardEffort);
    inside->fullRoot = huestep->world().fullRoot();
    inside->jointCount = huestep->world().joints().size();
    inside->waited = huestep->executor().waited();
    if (explain) inside->layout = huestep->world().stepLayout();
    inside->state = measureState(huestep->world());
}

Json RunReport::asJson() const {
    Json json = {{"scene", scene}, {"engine", engine}, {"threads", threads},
                 {"simd", simd},   {"ticks", ticks},   {"interrupted", ticks < ticksAsked}};
    json["hash"] = {{"motion", hex(motionRoot)}};
    if (inside) json["hash"]["full"] = hex(inside->fullRoot);
    json["ms_per_tick"] = {{"median", tickNanoseconds.quantile(0.5) / nsPerMs},
                           {"p99", tickNanoseconds.quantile(0.99) / nsPerMs}};
    json["bodies"] = bodies;
    json["contacts"] = contacts;
    json["accuracy"] = tools::asJson(accuracy);
    Json judged = Json::array();
    for (const Judged& m : metrics)
        judged.push_back({{"metric", m.metric->metric},
                          {"case", m.metric->name},
                          {"error", std::isfinite(m.error) ? Json(m.error) : Json()},
                          {"unit", m.metric->unit},
                          {"reference", m.metric->reference}});
    json["metrics"] = judged;
    Json every = Json::array();
    for (const TickHash& h : hashes) {
        Json row = {{"tick", h.tick}, {"motion", hex(h.motion)}};
        if (inside) row["full"] = hex(h.full);
        every.push_back(row);
    }
    json["hashes"] = every;
    if (!inside) return json;

    Json stages = Json::object();
    for (std::size_t s = 0; s < stageCount; ++s)
        stages[std::string(nameOf(static_cast<Stage>(s)))] =
            share(inside->stageNanoseconds[s], ticks) / nsPerMs;
    json["ms_by_stage"] = stages;
    json["method"] = inside->method->name;
    json["joints"] = inside->jointCount;
    json["awake_bodies"] = inside->last.awakeBodies;
    json["pairs"] = inside->last.pairs;
    json["recycled"] = inside->last.recycled;
    json["islands"] = inside->last.islands;
    json["batches"] = inside->last.batches;
    json["colours"] = inside->mostColours;
    json["overflow_share"] = share(inside->overflow, inside->constraints);
    json["bucket_share"] = share(inside->inBuckets, inside->constraints);
    const TooStiff& stiff = inside->last.tooStiff;
    json["too_stiff"] = {{"islands", stiff.islands},
                         {"lowest_body", stiff.body},
                         {"substeps", stiff.substeps},
                         {"needed_substeps", stiff.neededSubsteps},
                         {"row", stiff.joint ? "joint" : "contact"},
                         {"row_bodies", {stiff.bodyA, stiff.bodyB}}};
    json["waited_ms"] = milliseconds(inside->waited);
    if (inside->layout) json["explain"] = explanation(*inside->layout);
    json["state"] = {{"bytes_a_body", sizeof(BodyMotion)},
                     {"bytes_a_contact", sizeof(ContactState)},
                     {"bytes_a_joint", sizeof(JointImpulses)},
                     {"definition_bytes_a_body", sizeof(BodyInfo)},
                     {"definition_bytes_a_shape", sizeof(ShapeInfo)},
                     {"definition_bytes_a_joint", sizeof(JointInfo)},
                     {"snapshot_bytes", inside->state.snapshotBytes},
                     {"motion_root_ns_a_body", inside->state.motionRootNs},
                     {"full_root_ns_a_body", inside->state.fullRootNs}};
    return json;
}

void RunReport::print(const TickHash& hash, bool full) {
    std::printf("tick %llu  motion %s%s\n", static_cast<unsigned long long>(hash.tick),
                hex(hash.motion).c_str(), full ? ("  full " + hex(hash.full)).c_str() : "");
}

void RunReport::print() const {
    const std::string chosen =
        simd == "auto" ? " (" + std::string(nameOf(availableSimd().back())) + " here)" : "";
    std::printf("scene        %s on %s, %d thread%s%s\n", scene.c_str(), engine.c_str(), threads,
                threads == 1 ? "" : "s", inside ? (", simd " + simd + chosen).c_str() : "");
    std::printf("tick         %llu%s\n", static_cast<unsigned long long>(ticks),
                ticks < ticksAsked ? " (stopped before the end)" : "");
    std::printf("hash         motion %s%s\n", hex(motionRoot).c_str(),
                inside ? ("  full " + hex(inside->fullRoot)).c_str() : "");
    std::printf("ms a tick    median %.4f  p99 %.4f\n", tickNanoseconds.quantile(0.5) / nsPerMs,
                tickNanoseconds.quantile(0.99) / nsPerMs);
    std::printf("bodies       %llu\n", static_cast<unsigned long long>(bodies));
    std::printf("contacts     %u\n", contacts);
    if (inside) printInside();
    tools::print(accuracy);
    printMetrics();
}

void RunReport::printMetrics() const {
    for (const Judged& m : metrics)
        std::printf("metric %-5s %s%s: %s (against: %s)\n", std::string(m.metric->metric).c_str(),
                    number(m.error).c_str(),
                    m.metric->unit == "1" ? "" : (" " + std::string(m.metric->unit)).c_str(),
                    m.metric->what.c_str(), std::string(m.metric->reference).c_str());
}

void RunReport::printInside() const {
    const RunInside& in = *inside;
    std::string stages;
    for (std::size_t s = 0; s < stageCount; ++s) {
        if (in.stageNanoseconds[s] == 0) continue;  // had nothing to do
        char mean[32];
        std::snprintf(mean, sizeof mean, " %.4f", share(in.stageNanoseconds[s], ticks) / nsPerMs);
        stages += (stages.empty() ? "" : "  ") + std::string(nameOf(static_cast<Stage>(s))) + mean;
    }
    std::string waits;
    for (const double wait : milliseconds(in.waited)) waits += " " + number(wait);
    const std::string turns = in.substeps == 0 ? "planned" : std::to_string(in.substeps);
    std::printf("method       %s, %s %s\n", std::string(in.method->name).c_str(), turns.c_str(),
                in.method->substepping ? "substeps" : "iterations");
    std::printf("by stage     mean ms a tick: %s\n", stages.c_str());
    std::printf("awake        %u bodies, %u joints of %zu, %u pairs, %u contacts recycled\n",
                in.last.awakeBodies, in.last.joints, in.jointCount, in.last.pairs,
                in.last.recycled);
    std::printf(
        "graph        %u islands, %u batches, at most %u colours, hubs' buckets %s %%, overflow %s "
        "%%\n",
        in.last.islands, in.last.batches, in.mostColours,
        number(100.0 * share(in.inBuckets, in.constraints)).c_str(),
        number(100.0 * share(in.overflow, in.constraints)).c_str());
    const std::string stiff = sentenceOf(in.last.tooStiff);
    if (!stiff.empty()) std::printf("effort       %s\n", stiff.c_str());
    std::printf("waited, ms  %s (by thread, in all)\n", waits.c_str());
    if (in.layout) printLayout();
    std::printf(
        "state        %zu B a body, %zu a contact, %zu a joint; definitions %zu a body, "
        "%zu a shape, %zu a joint; snapshot %zu B\n",
        sizeof(BodyMotion), sizeof(ContactState), sizeof(JointImpulses), sizeof(BodyInfo),
        sizeof(ShapeInfo), sizeof(JointInfo), in.state.snapshotBytes);
    std::printf("hash cost    motion root %s ns a body, full root %s ns a body\n",
                number(in.state.motionRootNs).c_str(), number(in.state.fullRootNs).c_str());
}

/// The stages one a line with their share, then the largest islands and what was chosen for each.
void RunReport::printLayout() const {
    const RunInside& in = *inside;
    const StepLayout& layout = *in.layout;
    std::uint64_t all = 0;
    for (const std::uint64_t ns : in.stageNanoseconds) all += ns;
    std::printf("explained\n  %s: %s%s\n", std::string(in.method->name).c_str(),
                std::string(in.method->summary).c_str(),
                in.method->deterministic ? "" : "; not deterministic on more than one thread");
    Table stages({"  stage", "ms a tick", "share, %"});
    for (std::size_t s = 0; s < stageCount; ++s)
        if (in.stageNanoseconds[s] != 0)
            stages.add({"  " + std::string(nameOf(static_cast<Stage>(s))),
                        number(share(in.stageNanoseconds[s], ticks) / nsPerMs),
                        number(100.0 * share(in.stageNanoseconds[s], all))});
    stages.print();
    std::printf("  the last step goes over %s kB of records, each counted once: %s a body\n",
                number(static_cast<double>(layout.bytesTouched) / 1e3).c_str(),
                number(share(layout.bytesTouched, bodies)).c_str());
    std::printf("  %u awake bodies touch nothing: exact flight, no solver\n", layout.freeBodies);
    if (layout.giants > 0)
        std::printf(
            "  %u giant island%s: %u of %u colours are large enough to share, the rest on "
            "one thread\n",
            layout.giants, layout.giants == 1 ? "" : "s", layout.sharedColours, layout.colours);
    if (layout.islands.empty()) return;
    Table islands({"  island", "bodies", "contacts", "joints", "colours", "overflow", "substeps",
                   "solved by"});
    for (std::size_t i = 0; i < std::min(shownIslands, layout.islands.size()); ++i) {
        const IslandView& island = layout.islands[i];
        islands.add({"  of body " + std::to_string(island.body), std::to_string(island.bodies),
                     std::to_string(island.contacts), std::to_string(island.joints),
                     std::to_string(island.colours), std::to_string(island.overflow),
                     effortOf(island), reasonOf(island, layout)});
    }
    islands.print();
    if (layout.islands.size() > shownIslands)
        std::printf("  and %zu smaller ones\n", layout.islands.size() - shownIslands);
}

}  // namespace huestep::tools
