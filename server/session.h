/// One hosted session: a world, its players, their commands, and its recent past.
///
/// Sans-I/O: time comes in as an argument; journal entries come out of `closeTick` and the news
/// that they are on disk comes back by `committed`. Nobody waits for the slowest: a tick closes
/// when its host says so, with the commands that are there.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/script.h"
#include "core/world/world.h"
#include "protocol/drawing.h"
#include "protocol/journal.h"
#include "protocol/messages.h"
#include "server/command_queue.h"
#include "server/history.h"
#include "server/limits.h"
#include "server/seats.h"

namespace huestep::server {

/// What a session goes on from; made by `recoverSession`.
struct SessionStart {
    std::string name;
    std::uint32_t epoch = 1;  ///< counts the starts of this session
    ResumeKey key{};
    SharedSnapshot base;                ///< newest snapshot, or the scene's world
    std::vector<protocol::Frame> tail;  ///< recorded frames that lead from `base` to `world`
    World world;
    Script script{};  ///< what the host does to the world by itself, from its tick on
};

/// For the journal, in this order: the entries in one batch, then the snapshot.
struct ClosedTick {
    std::vector<protocol::JournalEntry> entries;
    SharedSnapshot snapshot;    ///< null unless one is due
    bool newSegment = false;    ///< the journal goes on in a new file after this
    std::uint64_t commits = 0;  ///< what to hand to `committed` once the entries are on disk
};

class Session {
 public:
    Session(SessionStart start, const Limits& limits, Instant now);
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    [[nodiscard]] const std::string& name() const { return m_name; }
    [[nodiscard]] std::uint32_t epoch() const { return m_epoch; }
    [[nodiscard]] const World& world() const { return m_world; }
    [[nodiscard]] std::uint64_t tick() const { return m_world.tick(); }
    [[nodiscard]] std::uint64_t committedTick() const { return m_committed; }
    /// When the last tick closed, or when the session began.
    [[nodiscard]] Instant closedAt() const { return m_closedAt; }
    [[nodiscard]] double ticksPerSecond() const;
    /// Whether the scene lets players in at all; without, everyone watches.
    [[nodiscard]] bool hasPlayers() const;

    /// False: too much waits for the disk, or the journal failed: the session stands still.
    [[nodiscard]] bool mayClose() const;
    /// Closes a tick: orders what waits, records it, steps the world. Requires `mayClose()`.
    ClosedTick closeTick(Instant now, const StepResources& with);
    /// Frames below this tick are on disk.
    void committed(std::uint64_t below);
    /// The journal failed, with this sentence: no tick closes any more.
    void fail(std::string sentence);
    [[nodiscard]] const std::optional<std::string>& failure() const { return m_failure; }
    /// A snapshot of now for the journal, as at a clean stop.
    [[nodiscard]] ClosedTick finalRecord() const;

    Seats& seats() { return m_seats; }
    [[nodiscard]] const Seats& seats() const { return m_seats; }

    /// Puts a player's command in the queue; the author is the seat's, whatever was sent.
    /// `asked`: the tick it is for, or 0; see `protocol::Intent`.
    CommandQueue::Admission queue(PlayerId player, Command command, std::uint64_t asked = 0);
    /// Sequence of the player's last command, queued or ordered.
    [[nodiscard]] std::uint64_t lastSequence(PlayerId player) const;
    [[nodiscard]] std::size_t queued() const { return m_queue.size(); }

    [[nodiscard]] const FrameRing& frames() const { return m_frames; }
    /// Motion root of a recent tick, or of now.
    [[nodiscard]] std::optional<std::uint64_t> rootAt(std::uint64_t tick) const;
    /// A snapshot for a joiner: at most `freshTicks` old, its frames still in the ring. Many
    /// joiners share one, so that they cost the session one save. Not before `notBefore`, where
    /// the client has been, if the session has come so far. While `lentSnapshots` different ones
    /// are held by clients, it is the newest of those, however old; null: none of them will do,
    /// ask again later.
    SharedSnapshot snapshotForJoin(std::uint64_t notBefore = 0);
    /// A snapshot of a rebuilt world, for one client; null: too many are held.
    SharedSnapshot snapshotOf(const World& world);
    /// Worlds of recent ticks, for comparing with a client whose world differs.
    Rebuilder& rebuilder() { return m_rebuilder; }

    /// What to draw now. `withShapes`: also what does not move; needed when `definitions` rose.
    [[nodiscard]] protocol::View view(bool withShapes) const;
    /// Rises when a body or a shape came or went.
    [[nodiscard]] std::uint32_t definitions() const { return m_definitions; }

 private:
    void gather(protocol::Frame& frame, Instant now);
    void noteDefinitions();
    /// The same snapshot, counted for as long as anybody holds it; null: too many are held.
    SharedSnapshot lend(const SharedSnapshot& snapshot);
    std::vector<SharedSnapshot> lentNow();

    std::string m_name;
    std::uint32_t m_epoch;
    Limits m_limits;
    World m_world;
    Script m_script;
    Seats m_seats;
    CommandQueue m_queue;
    FrameRing m_frames;
    Keyframes m_keyframes;
    Rebuilder m_rebuilder;
    SharedSnapshot m_fresh;  ///< the last one made for a joiner
    std::vector<std::weak_ptr<const Snapshot>> m_lent;
    std::uint64_t m_committed;
    Instant m_closedAt;
    std::optional<std::string> m_failure;
    std::uint32_t m_definitions = 1;
    protocol::DefinitionsMark m_definitionMark;
};

}  // namespace huestep::server
