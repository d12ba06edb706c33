/// A session from its folder: the newest snapshot and the frames recorded after it.
///
/// Beside the journal a folder holds `scene.bin`, what tick 0 was built from, and `resume.key`,
/// the secret of the resume tokens. Both are written before the journal's first segment.
#pragma once

#include <string>

#include "core/result.h"
#include "core/scene/scene.h"
#include "protocol/journal.h"
#include "server/session.h"

namespace huestep::server {

inline constexpr const char* sceneFile = "scene.bin";
inline constexpr const char* keyFile = "resume.key";

struct RecoveredSession {
    SessionStart start;
    protocol::JournalContents contents;  ///< for `JournalWriter::open`
    protocol::JournalIdentity identity;  ///< of this start: its epoch is one up
    std::string scene;                   ///< the name of the scene that tick 0 was built from
    bool created = false;                ///< the folder was new
    bool otherScene = false;             ///< the request's scene is not the folder's, which stays
};

struct RecoveryRequest {
    std::string name;
    protocol::Fingerprint fingerprint;
    const Scene* scene = nullptr;  ///< for a new folder; a folder with a scene keeps its own
    ResumeKey freshKey{};          ///< random bytes, used if the folder has no key
    StepResources resources;
};

/// Locks the folder, reads, replays and checks: every frame's `previousRoot` and every full root
/// must be what this build computes. The sentence names the file, or the tick that differs.
Result<RecoveredSession> recoverSession(protocol::LogStore& store, const RecoveryRequest& request);

/// Whether a session may be called so: 1 to 64 of [a-z0-9_-].
Status checkSessionName(const std::string& name);

}  // namespace huestep::server
