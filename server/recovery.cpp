#include "server/recovery.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "core/solver/method.h"
#include "core/state/hash.h"
#include "protocol/codec.h"
#include "protocol/scene_file.h"
#include "server/log.h"

namespace huestep::server {

namespace {

using protocol::JournalContents;
using protocol::LogStore;

bool holds(const std::vector<std::string>& names, const char* name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

/// Clients step their own copies: a method whose bits depend on how threads meet cannot be hosted.
Status checkMethod(const Scene& scene, const std::string& session) {
    const MethodTraits& method = traitsOf(scene.method);
    if (method.deterministic) return Done{};
    return Error{"session " + session + ": its scene is solved by '" + std::string(method.name) +
                 "', whose results differ from run to run; only deterministic methods are hosted"};
}

Result<Scene> storedScene(LogStore& store, const std::vector<std::string>& names,
                          const RecoveryRequest& request, bool& created) {
    if (holds(names, sceneFile)) {
        Result<std::vector<std::byte>> bytes = store.read(sceneFile);
        if (!bytes) return bytes.error();
        Result<Scene> scene = protocol::readScene(*bytes);
        if (!scene) return Error{store.describe(sceneFile) + ": " + scene.error().message};
        if (const Status fine = checkMethod(*scene, request.name); !fine) return fine.error();
        return scene;
    }
    if (!request.scene) {
        return Error{"session " + request.name +
                     " has no scene to start from: " + store.describe(sceneFile) + " is not there"};
    }
    if (const Status fine = checkMethod(*request.scene, request.name); !fine) return fine.error();
    created = true;
    const Status written = store.replace(sceneFile, protocol::writeSceneBinary(*request.scene));
    if (!written) return written.error();
    return *request.scene;
}

/// Whether the request names another scene than the folder keeps. Both as they are read back: what
/// a file leaves out counts for nothing.
bool isOther(const Scene& kept, const Scene* wanted) {
    if (wanted == nullptr) return false;
    const Result<Scene> readBack = protocol::readScene(protocol::writeSceneBinary(*wanted));
    return !readBack || !(*readBack == kept);
}

Result<ResumeKey> storedKey(LogStore& store, const std::vector<std::string>& names,
                            const RecoveryRequest& request) {
    if (!holds(names, keyFile)) {
        const Status written = store.replace(keyFile, std::as_bytes(std::span(request.freshKey)));
        if (!written) return written.error();
        return request.freshKey;
    }
    Result<std::vector<std::byte>> bytes = store.read(keyFile);
    if (!bytes) return bytes.error();
    ResumeKey key{};
    if (bytes->size() != key.size()) {
        return Error{
            store.describe(keyFile) + ": has " + std::to_string(bytes->size()) +
            " bytes where a key has 16; delete it, and players who are away must join anew"};
    }
    std::transform(bytes->begin(), bytes->end(), key.begin(),
                   [](std::byte b) { return std::to_integer<std::uint8_t>(b); });
    return key;
}

/// The world to replay from, and its snapshot: the newest one that reads back, or tick 0's.
Result<World> baseWorld(LogStore& store, const JournalContents& contents, const Scene& scene,
                        SharedSnapshot& base) {
    Result<World> world = Error{"no snapshot"};
    if (contents.snapshotTick) {
        Result<std::vector<std::byte>> bytes =
            protocol::readSnapshot(store, *contents.snapshotTick);
        if (!bytes) return bytes.error();
        world = World::restore(*bytes);
        if (!world) {
            const std::string file = protocol::snapshotFile(*contents.snapshotTick);
            return Error{store.describe(file) + ": " + world.error().message};
        }
    } else {
        world = World::create(scene);
        if (!world) return Error{store.describe(sceneFile) + ": " + world.error().message};
    }
    base = takeSnapshot(*world);
    return world;
}

std::string differs(const std::string& session, const char* what, std::uint64_t tick,
                    std::uint64_t recorded, std::uint64_t computed) {
    return "session " + session + ": the " + what + " of tick " + std::to_string(tick) + " is " +
           hexOf(computed) + " where the journal has " + hexOf(recorded) +
           ": it was written by a build that steps otherwise, or its snapshot is damaged";
}

Status replayTail(const RecoveryRequest& request, JournalContents& contents, World& world,
                  std::vector<protocol::Frame>& tail) {
    for (protocol::JournalEntry& entry : contents.entries) {
        if (const auto* full = std::get_if<protocol::FullRoot>(&entry.content)) {
            if (full->tick != world.tick()) continue;
            const std::uint64_t root = world.fullRoot();
            if (root == full->root) continue;
            return Error{differs(request.name, "full root", full->tick, full->root, root)};
        }
        auto& frame = std::get<protocol::Frame>(entry.content);
        if (frame.tick < world.tick()) continue;
        if (frame.tick > world.tick()) {
            return Error{"session " + request.name + ": the journal has no frame of tick " +
                         std::to_string(world.tick()) + ", the next one is of tick " +
                         std::to_string(frame.tick)};
        }
        const std::uint64_t root = world.motionRoot();
        if (root != frame.previousRoot) {
            return Error{
                differs(request.name, "motion root", frame.tick, frame.previousRoot, root)};
        }
        world.step(frame.commands, request.resources);
        tail.push_back(std::move(frame));
    }
    contents.entries.clear();
    return Done{};
}

}  // namespace

Status checkSessionName(const std::string& name) {
    if (protocol::isSessionName(name)) return Done{};
    return Error{"a session's name is 1 to 64 of a-z, 0-9, _ and -; this is not: '" +
                 name.substr(0, 80) + "'"};
}

Result<RecoveredSession> recoverSession(LogStore& store, const RecoveryRequest& request) {
    if (Status named = checkSessionName(request.name); !named) return named.error();
    if (Status locked = store.lockForWriting(); !locked) return locked.error();
    Result<std::vector<std::string>> names = store.list();
    if (!names) return names.error();
    bool created = false;
    const Result<Scene> scene = storedScene(store, *names, request, created);
    if (!scene) return scene.error();
    const Result<ResumeKey> key = storedKey(store, *names, request);
    if (!key) return key.error();

    // Two passes, so that only the frames after the snapshot are ever in memory.
    Result<JournalContents> contents = protocol::readJournal(store, ~std::uint64_t{0});
    if (!contents) return contents.error();
    contents = protocol::readJournal(store, contents->snapshotTick.value_or(0));
    if (!contents) return contents.error();
    const protocol::JournalIdentity& old = contents->identity;
    const bool same = old.fingerprint.selfTest == request.fingerprint.selfTest &&
                      old.fingerprint.scene == request.fingerprint.scene;
    if (old.epoch > 0 && !same) {
        return Error{"session " + request.name +
                     ": its journal was written by a build whose self-test gives " +
                     hexOf(old.fingerprint.selfTest) + ", this one gives " +
                     hexOf(request.fingerprint.selfTest) + ": it would not go on as it was"};
    }

    SharedSnapshot base;
    Result<World> world = baseWorld(store, *contents, *scene, base);
    if (!world) return world.error();
    std::vector<protocol::Frame> tail;
    if (Status replayed = replayTail(request, *contents, *world, tail); !replayed) {
        return replayed.error();
    }
    const std::uint32_t epoch = old.epoch + 1;
    return RecoveredSession{
        {request.name, epoch, *key, std::move(base), std::move(tail), std::move(*world)},
        std::move(*contents),
        {request.name, request.fingerprint, epoch},
        scene->name,
        created,
        !created && isOther(*scene, request.scene)};
}

}  // namespace huestep::server
