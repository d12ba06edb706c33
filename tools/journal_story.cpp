#include "tools/journal_story.h"

#include <cstring>
#include <filesystem>
#include <string_view>

#include "protocol/bytes.h"
#include "protocol/journal.h"
#include "protocol/journal_format.h"
#include "protocol/scene_file.h"
#include "tools/files.h"

namespace huestep::tools {
namespace {

constexpr std::size_t maxSnapshotBytes = std::size_t{1} << 30;
const std::string sceneFile = "scene.bin";
constexpr std::string_view journalMark = "HSTEPSNP";  // of a snapshot as a journal wraps it
constexpr std::size_t tickOffset = 16;                // in its header

bool beginsWith(std::span<const std::byte> bytes, std::string_view mark) {
    return bytes.size() >= mark.size() && std::memcmp(bytes.data(), mark.data(), mark.size()) == 0;
}

/// The tick that a journal's snapshot must be of: that of its name, if it has one, or its own word.
std::uint64_t tickOf(const std::string& path, std::span<const std::byte> bytes) {
    const std::string name = std::filesystem::path(path).filename().string();
    if (const auto tick = protocol::journal::tickOfSnapshot(name)) return *tick;
    return bytes.size() < tickOffset + 8 ? 0 : protocol::load<std::uint64_t>(bytes, tickOffset);
}

Result<World> worldOfScene(const std::string& folder) {
    const std::string path = folder + "/" + sceneFile;
    const Result<std::vector<std::byte>> bytes = readFile(path, protocol::maxSceneFileBytes);
    if (!bytes) return bytes.error();
    const Result<Scene> scene = protocol::readScene(*bytes);
    if (!scene) return Error{path + ": " + scene.error().message};
    Result<World> world = World::create(*scene);
    if (!world) return Error{path + ": " + world.error().message};
    return world;
}

/// The world to start from, and its source's name.
Result<World> startWorld(protocol::LogStore& store, const std::string& folder, std::uint64_t from,
                         std::string& source) {
    const Result<std::vector<std::string>> names = store.list();
    if (!names) return names.error();
    std::optional<std::uint64_t> best;
    for (const std::string& name : *names) {
        const std::optional<std::uint64_t> tick = protocol::journal::tickOfSnapshot(name);
        if (tick && *tick <= from && (!best || *tick > *best)) {
            best = tick;
            source = name;
        }
    }
    if (!best || from == 0) {
        source = sceneFile;
        return worldOfScene(folder);
    }
    const Result<std::vector<std::byte>> bytes = protocol::readSnapshot(store, *best);
    if (!bytes) return bytes.error();
    Result<World> world = World::restore(*bytes);
    if (!world) return Error{store.describe(source) + ": " + world.error().message};
    return world;
}

/// Takes the entries from `first` on, which must follow each other without a gap.
Status takeEntries(const std::string& folder, const protocol::JournalContents& contents,
                   std::uint64_t first, Story& story) {
    story.end = first;
    for (const protocol::JournalEntry& entry : contents.entries) {
        if (const auto* full = std::get_if<protocol::FullRoot>(&entry.content)) {
            if (full->tick > first) story.fullRoots[full->tick] = full->root;
            continue;
        }
        const auto& frame = std::get<protocol::Frame>(entry.content);
        if (frame.tick < first) continue;
        if (frame.tick != story.end)
            return Error{folder + ": after the frame of tick " + std::to_string(story.end) +
                         " comes that of tick " + std::to_string(frame.tick)};
        story.motionRoots[frame.tick] = frame.previousRoot;
        if (!frame.commands.empty()) story.commands[frame.tick] = frame.commands;
        ++story.end;
    }
    return Done{};
}

Status cutAt(const std::string& folder, std::uint64_t from, std::optional<std::uint64_t> to,
             Story& story) {
    if (from > story.end)
        return Error{"--from: the journal " + folder + " ends at tick " +
                     std::to_string(story.end)};
    if (!to) return Done{};
    if (*to > story.end)
        return Error{"--to: the journal " + folder + " ends at tick " + std::to_string(story.end)};
    if (*to < from) return Error{"--to: lies before --from"};
    story.end = *to;
    return Done{};
}

}  // namespace

Result<World> loadSnapshot(const std::string& path) {
    Result<std::vector<std::byte>> bytes = readFile(path, maxSnapshotBytes);
    if (!bytes) return bytes.error();
    // A journal wraps its snapshots; which form this is, the file says and not its name.
    if (beginsWith(*bytes, journalMark))
        bytes = protocol::journal::unwrapSnapshot(tickOf(path, *bytes), *bytes);
    if (!bytes) return Error{path + ": " + bytes.error().message};
    Result<World> world = World::restore(*bytes);
    if (!world) return Error{path + ": " + world.error().message};
    return world;
}

bool looksLikeJournal(const std::string& path) {
    std::error_code wrong;
    return std::filesystem::is_directory(path, wrong);
}

Result<JournalStory> loadJournal(const std::string& path, std::uint64_t from,
                                 std::optional<std::uint64_t> to) {
    // openFolder would make the folder; a reader must not.
    if (!looksLikeJournal(path)) return Error{path + ": no folder, so no journal"};
    std::error_code wrong;
    if (!std::filesystem::exists(path + "/" + sceneFile, wrong))
        return Error{path + " is no journal: it has no " + sceneFile};
    Result<std::unique_ptr<protocol::LogStore>> store = protocol::openFolder(path);
    if (!store) return store.error();
    const Result<protocol::JournalContents> contents = protocol::readJournal(**store);
    if (!contents) return contents.error();

    JournalStory out;
    out.session = contents->identity.session;
    out.epoch = contents->identity.epoch;
    out.tornBytes = contents->tornBytes;
    Result<World> start = startWorld(**store, path, from, out.startedFrom);
    if (!start) return start.error();
    Story& story = out.story;
    story.name = path;
    story.start = std::make_shared<const World>(std::move(start).value());
    const std::uint64_t first = story.start->tick();
    if (const Status taken = takeEntries(path, *contents, first, story); !taken)
        return taken.error();
    const auto recorded = story.motionRoots.find(first);
    if (recorded != story.motionRoots.end() && recorded->second != story.start->motionRoot())
        return Error{path + "/" + out.startedFrom +
                     ": its world is not the one that the frame of " + "tick " +
                     std::to_string(first) + " was recorded for"};
    if (const Status cut = cutAt(path, from, to, story); !cut) return cut.error();
    return out;
}

}  // namespace huestep::tools
