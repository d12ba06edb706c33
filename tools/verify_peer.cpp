/// `huestep verify --engine box2d`: where a peer's world depends on how it came to be.
///
/// The same scene is run again, and with `--reorder` created in other orders and after other bodies
/// came and went. The peer's hash of all motions, which are listed by the scene's ids whatever the
/// order of creation, is compared after every tick. A difference is no defect of the report: it is
/// what a user of that engine has to know.
#include <algorithm>
#include <cstdio>

#include "tools/definitions.h"
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
    bool ended = false;                      // compared to its end; false: stopped by Ctrl-C
    [[nodiscard]] bool decided() const { return ended || differsAt; }
};

/// The first body, by place, whose motion differs, and its first different field.
std::string nameMotion(const std::vector<BodyMotion>& left, const std::vector<BodyMotion>& right,
                       std::span<const BodyInfo> bodies) {
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
            return "body " + std::to_string(bodies[i].id) + " " + field.name + values;
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
    Definitions definitions(ids);
    for (std::uint64_t tick = 1; tick <= ticks && !interrupted(); ++tick) {
        const std::vector<Command> commands = named.script.commands(tick - 1);
        definitions.apply(commands);
        if (const Status stepped = (*left)->step(commands); !stepped) return stepped;
        if (const Status stepped = (*right)->step(commands); !stepped) return stepped;
        progress.advance();
        ++run.compared;
        run.hash = (*right)->hash();
        if (run.hash == (*left)->hash()) continue;
        run.differsAt = tick;
        run.difference = nameMotion((*left)->motions(), (*right)->motions(), definitions.bodies());
        break;
    }
    for (std::string& note : (*left)->notes())
        if (std::find(notes.begin(), notes.end(), note) == notes.end())
            notes.push_back(std::move(note));
    run.ended = !run.differsAt && run.compared == ticks;
    return Done{};
}

std::size_t decidedOf(const std::vector<PeerRun>& runs) {
    const auto count =
        std::count_if(runs.begin(), runs.end(), [](const PeerRun& run) { return run.decided(); });
    return static_cast<std::size_t>(count);
}

bool anyDiffers(const std::vector<PeerRun>& runs) {
    return std::any_of(runs.begin(), runs.end(),
                       [](const PeerRun& run) { return run.differsAt.has_value(); });
}

Json asJson(const VerifyOptions& options, const std::vector<PeerRun>& runs,
            const std::vector<std::string>& notes) {
    const bool finished = decidedOf(runs) == runs.size();
    Json rows = Json::array();
    for (const PeerRun& run : runs) {
        Json row = {{"story", run.name},
                    {"hashes_compared", run.compared},
                    {"equal", run.decided() ? Json(run.ended) : Json()}};
        if (run.compared != 0) row["hash"] = hex(run.hash);
        if (run.differsAt) {
            row["differs_at"] = *run.differsAt;
            row["difference"] = run.difference;
        }
        rows.push_back(row);
    }
    return {{"source", options.source},
            {"engine", options.engine},
            {"notes", notes},
            {"combinations", rows},
            {"finished", finished},
            {"equal", anyDiffers(runs) ? Json(false)
                      : finished       ? Json(true)
                                       : Json()}};
}

/// A line a run, for those that had their turn, and what they say together.
void printText(const VerifyOptions& options, const std::vector<PeerRun>& runs) {
    for (const PeerRun& run : runs) {
        if (run.compared == 0) continue;
        const auto ticks = static_cast<unsigned long long>(run.compared);
        std::printf("%s, %s: ", options.engine.c_str(), run.name.c_str());
        if (run.differsAt)
            std::printf("differs at tick %llu: %s\n", ticks, run.difference.c_str());
        else
            std::printf("equal at %s %llu ticks, hash %s\n", run.ended ? "all" : "the first", ticks,
                        hex(run.hash).c_str());
    }
    if (decidedOf(runs) != runs.size())
        std::printf("stopped before all was compared\n");
    else
        std::printf("%s\n", anyDiffers(runs)
                                ? "different: this engine's result depends on its history"
                                : "equal");
}

}  // namespace

Answer verifyPeer(const VerifyOptions& options, const NamedScene& named) {
    std::vector<PeerRun> runs = {{"run again", {}, 0, 0, {}, {}, false}};
    if (options.reorder) {
        runs.push_back({"created in order 1", {1, false}, 0, 0, {}, {}, false});
        runs.push_back({"created in order 2", {2, false}, 0, 0, {}, {}, false});
        runs.push_back({"created after noise", {0, true}, 0, 0, {}, {}, false});
    }
    const Result<World> ids = World::create(named.scene);
    if (!ids) return ids.error();
    const std::uint64_t ticks = options.ticks != 0 ? options.ticks : named.ticks;
    Progress progress("comparing", ticks * runs.size());
    std::vector<std::string> notes;  // the same for every order of creation
    for (PeerRun& run : runs) {
        if (interrupted()) break;
        const Status compared = compareRun(options, named, ticks, *ids, progress, run, notes);
        if (!compared) return compared.error();
    }
    progress.clear();
    for (const std::string& note : notes) std::fprintf(stderr, "note: %s\n", note.c_str());

    if (options.json)
        print(asJson(options, runs, notes));
    else
        printText(options, runs);
    if (const std::size_t decided = decidedOf(runs); decided != runs.size())
        return stopped("with " + std::to_string(decided) + " of " + std::to_string(runs.size()) +
                       " runs compared");
    return anyDiffers(runs) ? Exit::Differs : Exit::Done;
}

}  // namespace huestep::tools
