/// A session's journal as a story: the world it starts from, its commands, its recorded hashes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/result.h"
#include "tools/story.h"

namespace huestep::tools {

struct JournalStory {
    Story story;
    std::string session;
    std::uint32_t epoch = 0;      ///< how often the session was opened
    std::uint64_t tornBytes = 0;  ///< of a tail that a crash left half written; not played
    std::string startedFrom;      ///< "scene.bin" or the name of a snapshot
};

/// Whether the path is a folder, as a journal is.
bool looksLikeJournal(const std::string& path);

/// The world in a file: what `run --snapshot` wrote, or a snapshot of a journal's folder. The
/// sentence of a failure names file and offset.
Result<World> loadSnapshot(const std::string& path);

/// Reads the journal in a folder, which is not changed. Starts from the newest snapshot that is
/// not after `from`, else from the scene; ends at `to`, else at the last frame. The sentence of a
/// failure names file and offset.
Result<JournalStory> loadJournal(const std::string& path, std::uint64_t from = 0,
                                 std::optional<std::uint64_t> to = std::nullopt);

}  // namespace huestep::tools
