/// `huestep replay`: runs a journal again and checks every recorded hash.
#include <cstdio>
#include <memory>

#include "tools/clock.h"
#include "tools/command.h"
#include "tools/files.h"
#include "tools/interrupt.h"
#include "tools/journal_story.h"
#include "tools/progress.h"
#include "tools/text.h"
#include "tools/whole_number.h"

namespace huestep::tools {
namespace {

struct Options {
    std::string log;
    std::uint64_t from = 0;
    std::optional<std::uint64_t> to;
    int threads = 1;
    std::string snapshot;
    bool json = false;
};

struct Replay {
    std::uint64_t compared = 0;  // recorded hashes
    std::optional<std::uint64_t> differsAt;
    std::uint64_t recorded = 0;  // what stands there …
    std::uint64_t made = 0;      // … and what came out
    std::uint64_t nanoseconds = 0;
};

/// Compares a root with the record of the tick, if there is one; false: they differ.
bool holds(const std::map<std::uint64_t, std::uint64_t>& record, std::uint64_t tick,
           std::uint64_t root, Replay& replay) {
    const auto entry = record.find(tick);
    if (entry == record.end()) return true;
    ++replay.compared;
    if (entry->second == root) return true;
    replay.differsAt = tick;
    replay.recorded = entry->second;
    replay.made = root;
    return false;
}

Status play(const Story& story, Playback& playback, Replay& replay) {
    Progress progress("replaying", story.steps());
    const std::uint64_t begin = nanoseconds();
    const World& world = playback.world();
    while (!playback.done() && !interrupted()) {
        if (const Status stepped = playback.step(); !stepped) return stepped;
        progress.advance();
        const std::uint64_t tick = world.tick();
        if (!holds(story.motionRoots, tick, world.motionRoot(), replay)) break;
        // A full root costs several times a motion root, so it is made only where one is recorded.
        const bool full = story.fullRoots.contains(tick);
        if (full && !holds(story.fullRoots, tick, world.fullRoot(), replay)) break;
    }
    replay.nanoseconds = nanoseconds() - begin;
    return Done{};
}

Json asJson(const Options& options, const JournalStory& journal, const World& world,
            const Replay& replay) {
    Json json = {{"log", options.log},
                 {"session", journal.session},
                 {"started_from", journal.startedFrom},
                 {"first_tick", journal.story.start->tick()},
                 {"tick", world.tick()},
                 {"threads", options.threads},
                 {"hashes_compared", replay.compared},
                 {"mismatches", replay.differsAt ? 1 : 0},
                 {"hash", {{"motion", hex(world.motionRoot())}, {"full", hex(world.fullRoot())}}},
                 {"seconds", static_cast<double>(replay.nanoseconds) * 1e-9},
                 {"torn_bytes", journal.tornBytes},
                 {"finished", world.tick() == journal.story.end}};
    if (replay.differsAt)
        json["difference"] = {{"tick", *replay.differsAt},
                              {"recorded", hex(replay.recorded)},
                              {"made", hex(replay.made)}};
    return json;
}

void printText(const JournalStory& journal, const World& world, const Replay& replay) {
    const auto number = [](std::uint64_t n) { return static_cast<unsigned long long>(n); };
    std::printf("session      %s, opened %u time%s\n", journal.session.c_str(), journal.epoch,
                journal.epoch == 1 ? "" : "s");
    std::printf("ticks        %llu to %llu, from %s\n", number(journal.story.start->tick()),
                number(world.tick()), journal.startedFrom.c_str());
    if (journal.tornBytes != 0)
        std::printf("torn tail    %llu bytes, not played\n", number(journal.tornBytes));
    std::printf("hash         motion %s  full %s\n", hex(world.motionRoot()).c_str(),
                hex(world.fullRoot()).c_str());
    std::printf("time         %s s\n",
                tools::number(static_cast<double>(replay.nanoseconds) * 1e-9).c_str());
    if (replay.differsAt)
        std::printf("different at tick %llu: recorded %s, made %s\n", number(*replay.differsAt),
                    hex(replay.recorded).c_str(), hex(replay.made).c_str());
    else if (world.tick() != journal.story.end)
        std::printf("stopped before the end; %llu recorded hashes were equal\n",
                    number(replay.compared));
    else if (replay.compared == 0)
        std::printf("nothing was compared: the journal has no recorded hash of these ticks\n");
    else
        std::printf("equal: %llu recorded hashes, mismatches: 0\n", number(replay.compared));
}

Answer replayLog(const Options& options) {
    const Result<JournalStory> journal = loadJournal(options.log, options.from, options.to);
    if (!journal) return journal.error();
    Result<OutputFile> snapshot = OutputFile::open(options.snapshot);
    if (!snapshot) return snapshot.error();
    Playback playback(journal->story, {options.threads, Simd::Auto, 0, 0});
    Replay replay;
    if (const Status played = play(journal->story, playback, replay); !played)
        return played.error();
    const World& world = playback.world();
    if (options.json)
        print(asJson(options, *journal, world, replay));
    else
        printText(*journal, world, replay);
    if (snapshot->named())
        if (const Status written = snapshot->write(world.save()); !written) return written.error();
    if (replay.differsAt) return Exit::Differs;
    if (world.tick() == journal->story.end) return Exit::Done;
    return stopped("at tick " + std::to_string(world.tick()) + " of " +
                   std::to_string(journal->story.end));
}

}  // namespace

void addReplay(Menu& menu) {
    const auto o = std::make_shared<Options>();
    CLI::App* sub =
        menu.add("replay", "Runs a journal again and checks every recorded hash.",
                 "huestep replay huestep-data/play --threads 8", [o] { return replayLog(*o); });
    sub->add_option("LOG", o->log, "The folder of a journal")->required();
    sub->add_option("--from", o->from,
                    "Start at the newest snapshot that is not after this tick (default: 0)")
        ->transform(wholeNumber(0));
    sub->add_option("--to", o->to, "Stop at this tick (default: the end)")
        ->transform(wholeNumber(0));
    sub->add_option("--threads", o->threads, "Threads, 1 to 64 (default: 1)")
        ->transform(wholeNumber(1, maxThreads));
    sub->add_option("--snapshot", o->snapshot, "Write the state at the end to this file");
    sub->add_flag("--json", o->json, "Print one JSON document");
}

}  // namespace huestep::tools
