/// `huestep verify --engine box2d`: where a peer's world depends on how it came to be.
///
/// The same scene is run again, and with `--reorder` created in other orders and after other bodies
/// came and went. The peer's hash of all motions, which are listed by the scene's ids whatever the
/// order of creation, is compared after every tick. A difference is no defect of the report: it is
/// what a user of that engine has to know.
#include <cstdio>

#include "tools/engines.h"
#include "tools/interrupt.h"
#include "tools/progress.h"
#include "tools/text.h"
#include "tools/verify.h"

namespace huestep::tools {
namespace {

struct PeerRun {
    std::string name;
    BuildOrder order;
    std::uint64_t compared = 0;
    std::uint64_t hash = 0;                  // at the end, or where it differed
    std::optional<std::uint64_t> differsAt;  // tick
    std::string difference;                  // body and field
};

/// The first body, by place, whose motion differs, and its first different field.
std::string nameMotion(const std::vector<BodyMotion>& left, const std::vector<BodyMotion>& right,
                       const World& ids) {
    for (std::size_t i = 0; i < left.size() && i < right.size(); ++i) {
        const auto* a = reinterpret_cast<const std::byte*>(&left[i]);
        const auto* b = reinterpret_cast<const std::byte*>(&right[i]);
        for (const Field& field : fieldsOf<BodyMotion>) {
            if (std::equal(a + field.offset, a + field.offset + sizeOf(field.type),
                           b + field.offset))
                continue;
            std::string values;
            if (field.type == FieldType::F32) {
                float x = 0.0f;
                float y = 0.0f;
                std::copy_n(a + field.offset, sizeof x, reinterpret_cast<std::byte*>(&x));
                std::copy_n(b + field.offset, sizeof y, reinterpret_cast<std::byte*>(&y));
                char text[64];
                std::snprintf(text, sizeof text, ": %.9g and %.9g", static_cast<double>(x),
                              static_cast<double>(y));
                values = text;
            }
            return "body " + std::to_string(ids.bodies()[i].id) + " " + field.name + values;
        }
    }
    return "the number of bodies";
}

Status compareRun(const VerifyOptions& options, const NamedScene& named, std::uint64_t ticks,
                  const World& ids, Progress& progress, PeerRun& run,
                  std::vector<std::string>& notes) {
    auto left = makeEngine(options.engine, named.scene, {}, &notes);
    if (!left) return left.error();
    auto right = makeEngine(options.engine, named.scene, {1, Simd::Auto, run.order, nullptr});
    if (!right) return right.error();
    for (std::uint64_t tick = 1; tick <= ticks && !interrupted(); ++tick) {
        (*left)->step();
        (*right)->step();
        progress.advance();
        ++run.compared;
        run.hash = (*right)->hash();
        if (run.hash == (*left)->hash()) continue;
        run.differsAt = tick;
        run.difference = nameMotion((*left)->motions(), (*right)->motions(), ids);
        break;
    }
    return Done{};
}

Json asJson(const VerifyOptions& options, const std::vector<PeerRun>& runs,
            const std::vector<std::string>& notes, bool equal) {
    Json rows = Json::array();
    for (const PeerRun& run : runs) {
        Json row = {{"story", run.name},
                    {"hashes_compared", run.compared},
                    {"equal", !run.differsAt},
                    {"hash", hex(run.hash)}};
        if (run.differsAt) {
            row["differs_at"] = *run.differsAt;
            row["difference"] = run.difference;
        }
        rows.push_back(row);
    }
    return {{"source", options.source}, {"engine", options.engine},   {"notes", notes},
            {"combinations", rows},     {"finished", !interrupted()}, {"equal", equal}};
}

}  // namespace

Answer verifyPeer(const VerifyOptions& options, const NamedScene& named) {
    std::vector<PeerRun> runs = {{"run again", {}, 0, 0, {}, {}}};
    if (options.reorder) {
        runs.push_back({"created in order 1", {1, false}, 0, 0, {}, {}});
        runs.push_back({"created in order 2", {2, false}, 0, 0, {}, {}});
        runs.push_back({"created after noise", {0, true}, 0, 0, {}, {}});
    }
    const Result<World> ids = World::create(named.scene);
    if (!ids) return ids.error();
    const std::uint64_t ticks = options.ticks != 0 ? options.ticks : named.ticks;
    Progress progress("comparing", ticks * runs.size());
    bool equal = true;
    std::vector<std::string> notes;  // the same for every order of creation
    for (PeerRun& run : runs) {
        const Status compared = compareRun(options, named, ticks, *ids, progress, run, notes);
        if (!compared) return compared.error();
        equal = equal && !run.differsAt;
    }
    equal = equal && !interrupted();
    progress.clear();
    for (const std::string& note : notes) std::fprintf(stderr, "note: %s\n", note.c_str());

    if (options.json) {
        print(asJson(options, runs, notes, equal));
        return equal ? Exit::Done : Exit::Differs;
    }
    for (const PeerRun& run : runs) {
        if (run.differsAt)
            std::printf("%s, %s: differs at tick %llu: %s\n", options.engine.c_str(),
                        run.name.c_str(), static_cast<unsigned long long>(*run.differsAt),
                        run.difference.c_str());
        else
            std::printf("%s, %s: equal at all %llu ticks, hash %s\n", options.engine.c_str(),
                        run.name.c_str(), static_cast<unsigned long long>(run.compared),
                        hex(run.hash).c_str());
    }
    std::printf("%s\n", interrupted() ? "stopped before all was compared"
                        : equal       ? "equal"
                                      : "different: this engine's result depends on its history");
    return equal ? Exit::Done : Exit::Differs;
}

}  // namespace huestep::tools
