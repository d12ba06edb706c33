/// `huestep diff`: the first difference of two snapshots or of two journals.
#include <cstdio>
#include <filesystem>
#include <memory>

#include "tools/command.h"
#include "tools/interrupt.h"
#include "tools/journal_story.h"
#include "tools/progress.h"
#include "tools/text.h"

namespace huestep::tools {
namespace {

/// What was found; `what` empty: nothing.
struct Finding {
    std::string what;  // "state", "commands", "recorded hash", "length"
    std::uint64_t tick = 0;
    std::string sentence;
    std::optional<Difference> field;
    bool stopped = false;  // by Ctrl-C, with nothing found so far
};

Finding compareWorlds(const World& left, const World& right) {
    const std::optional<Difference> difference = firstDifference(left, right);
    if (!difference) return {};
    return {"state", left.tick(), difference->sentence(), difference, false};
}

std::string describe(const Command& command) {
    static constexpr const char* names[] = {
        "AddPlayer", "RemovePlayer", "ApplyImpulse", "ApplyForce", "Grab",
        "MoveGrab",  "Release",      "Spawn",        "RemoveBody", "RemoveJoint",
        "SetMotor",  "SetVelocity",  "SetTarget",    "Custom"};
    static_assert(std::size(names) == std::variant_size_v<huestep::Action>);
    return std::string(names[command.action.index()]) + " of author " +
           std::to_string(command.author) + ", sequence " + std::to_string(command.sequence);
}

const std::vector<Command>& commandsOf(const Story& story, std::uint64_t tick) {
    static const std::vector<Command> none;
    const auto entry = story.commands.find(tick);
    return entry == story.commands.end() ? none : entry->second;
}

/// The first command that is not the same on both sides.
std::string compareCommands(const std::vector<Command>& left, const std::vector<Command>& right) {
    for (std::size_t i = 0; i < std::max(left.size(), right.size()); ++i) {
        const bool here = i < left.size();
        const bool there = i < right.size();
        if (here && there && left[i] == right[i]) continue;
        const std::string a = here ? describe(left[i]) : "nothing";
        const std::string b = there ? describe(right[i]) : "nothing";
        return "command " + std::to_string(i) + ": " + a + " here, " + b + " there" +
               (a == b ? ", with other values" : "");
    }
    return "";
}

std::optional<std::uint64_t> recordedAt(const Story& story, std::uint64_t tick) {
    const auto entry = story.motionRoots.find(tick);
    if (entry == story.motionRoots.end()) return std::nullopt;
    return entry->second;
}

/// Steps both journals side by side to the first tick in which commands, worlds or records differ.
Result<Finding> compareStories(const Story& left, const Story& right) {
    Playback a(left, {});
    Playback b(right, {});
    if (Finding start = compareWorlds(a.world(), b.world()); !start.what.empty()) return start;
    Progress progress("comparing", std::min(left.steps(), right.steps()));
    while (!a.done() && !b.done() && !interrupted()) {
        const std::uint64_t tick = a.world().tick();
        const auto x = recordedAt(left, tick);
        const auto y = recordedAt(right, tick);
        if (x && y && *x != *y)
            return Finding{"recorded hash",
                           tick,
                           hex(*x) + " here, " + hex(*y) + " there; run again, both worlds are " +
                               hex(a.world().motionRoot()),
                           {},
                           false};
        const std::string commands =
            compareCommands(commandsOf(left, tick), commandsOf(right, tick));
        const Status stepped = a.step();
        if (!stepped) return stepped.error();
        const Status steppedToo = b.step();
        if (!steppedToo) return steppedToo.error();
        progress.advance();
        if (commands.empty()) continue;
        Finding found = compareWorlds(a.world(), b.world());
        const std::string after =
            found.what.empty() ? "; no field differs after it" : "; then " + found.sentence;
        return Finding{"commands", tick, commands + after, found.field, false};
    }
    if (!a.done() && !b.done()) return Finding{"", a.world().tick(), "", {}, true};
    if (left.end == right.end) return Finding{};
    return Finding{"length",
                   std::min(left.end, right.end),
                   "here the journal ends at tick " + std::to_string(left.end) + ", there at " +
                       std::to_string(right.end),
                   {},
                   false};
}

Result<Finding> find(const std::string& a, const std::string& b) {
    for (const std::string& path : {a, b}) {
        std::error_code wrong;
        if (!std::filesystem::exists(path, wrong))
            return Error{path + ": there is no such file or folder"};
    }
    if (looksLikeJournal(a) != looksLikeJournal(b))
        return Error{"a snapshot and a journal cannot be compared; give two of a kind"};
    if (looksLikeJournal(a)) {
        const Result<JournalStory> left = loadJournal(a);
        if (!left) return left.error();
        const Result<JournalStory> right = loadJournal(b);
        if (!right) return right.error();
        return compareStories(left->story, right->story);
    }
    const Result<World> left = loadSnapshot(a);
    if (!left) return left.error();
    const Result<World> right = loadSnapshot(b);
    if (!right) return right.error();
    return compareWorlds(*left, *right);
}

Answer diff(const std::string& a, const std::string& b, bool json) {
    const Result<Finding> finding = find(a, b);
    if (!finding) return finding.error();
    const bool equal = finding->what.empty() && !finding->stopped;
    if (json) {
        Json document = {{"left", a},
                         {"right", b},
                         {"finished", !finding->stopped},
                         {"equal", finding->stopped ? Json() : Json(equal)}};
        if (!finding->what.empty()) {
            Json found = {
                {"what", finding->what}, {"tick", finding->tick}, {"sentence", finding->sentence}};
            if (const auto& field = finding->field)
                found.update({{"record", field->record},
                              {"name", field->name},
                              {"field", field->field},
                              {"body", field->body},
                              {"left", field->left},
                              {"right", field->right}});
            document["difference"] = found;
        }
        print(document);
    } else if (equal) {
        std::printf("equal\n");
    } else if (finding->stopped) {
        std::printf("stopped before all was compared\n");
    } else {
        std::printf("%s differs at tick %llu: %s\n", finding->what.c_str(),
                    static_cast<unsigned long long>(finding->tick), finding->sentence.c_str());
    }
    if (finding->stopped) return stopped("at tick " + std::to_string(finding->tick));
    return equal ? Exit::Done : Exit::Differs;
}

}  // namespace

void addDiff(Menu& menu) {
    struct Options {
        std::string a;
        std::string b;
        bool json = false;
    };
    const auto o = std::make_shared<Options>();
    CLI::App* sub = menu.add(
        "diff", "Names the first difference of two snapshots or journals: tick, body, field.",
        "huestep diff before.snap after.snap", [o] { return diff(o->a, o->b, o->json); });
    sub->add_option("A", o->a, "A snapshot file, or the folder of a journal")->required();
    sub->add_option("B", o->b, "The other")->required();
    sub->add_flag("--json", o->json, "Print one JSON document");
}

}  // namespace huestep::tools
