/// The recent past of a session: frames, snapshots, and worlds rebuilt from them.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "core/world/world.h"
#include "protocol/messages.h"
#include "server/limits.h"

namespace huestep::server {

/// Bytes that several connections send at their own pace without a copy each.
using SharedBytes = std::shared_ptr<const std::vector<std::byte>>;

/// A saved world: for joiners, for the journal, and as a keyframe.
struct Snapshot {
    std::uint64_t tick = 0;
    std::uint64_t hash = 0;  ///< of the bytes
    std::vector<std::byte> bytes;
};
using SharedSnapshot = std::shared_ptr<const Snapshot>;

SharedSnapshot takeSnapshot(const World& world);

/// The newest frames of a session, without a gap, the newest leading to the session's tick.
class FrameRing {
 public:
    FrameRing(std::uint32_t most, std::size_t mostBytes) : m_most(most), m_mostBytes(mostBytes) {}

    /// The next frame: its tick follows the newest one's.
    void push(protocol::Frame frame);

    /// Null: too old, or not yet closed.
    [[nodiscard]] const protocol::Frame* find(std::uint64_t tick) const;
    [[nodiscard]] SharedBytes encoded(std::uint64_t tick) const;
    /// First tick whose frame is here; with none here, a tick that will never be.
    [[nodiscard]] std::uint64_t oldest() const;
    [[nodiscard]] std::size_t bytes() const { return m_bytes; }
    [[nodiscard]] std::size_t size() const { return m_entries.size(); }

 private:
    struct Entry {
        protocol::Frame frame;
        SharedBytes encoded;
    };
    [[nodiscard]] const Entry* entry(std::uint64_t tick) const;

    std::uint32_t m_most;
    std::size_t m_mostBytes;
    std::size_t m_bytes = 0;
    std::deque<Entry> m_entries;
};

/// Snapshots at intervals, from which a tick in between is a few steps away.
class Keyframes {
 public:
    explicit Keyframes(std::uint32_t most) : m_most(most) {}
    void push(SharedSnapshot snapshot);
    /// The newest at or before the tick; null: none.
    [[nodiscard]] SharedSnapshot before(std::uint64_t tick) const;
    [[nodiscard]] SharedSnapshot newest() const;

 private:
    std::uint32_t m_most;
    std::deque<SharedSnapshot> m_snapshots;
};

/// Rebuilds the world of a recent tick from a keyframe and the recorded frames, one step a call,
/// so that the session's own ticks never wait for it. Used when a client's world differs: both
/// ends then compare worlds of the very same tick.
class Rebuilder {
 public:
    Rebuilder(const FrameRing& frames, const Keyframes& keyframes, const Limits& limits)
        : m_frames(frames),
          m_keyframes(keyframes),
          m_mostWaiting(limits.rebuildsWaiting),
          m_mostKept(limits.rebuiltWorlds) {}

    enum class Answer : std::uint8_t { Ready, Coming, Gone };
    /// Asks for the world after `tick` steps. Gone: too old, or too many wait: never mind.
    Answer ask(std::uint64_t tick);
    /// The rebuilt world, if it was asked for and is done; the newest ones are kept.
    [[nodiscard]] const World* find(std::uint64_t tick) const;

    /// One step of the work that waits. False: none waits.
    bool work(const StepResources& with);

 private:
    struct Job {
        std::uint64_t tick = 0;
        std::optional<World> world;
    };
    const FrameRing& m_frames;
    const Keyframes& m_keyframes;
    std::uint32_t m_mostWaiting;
    std::uint32_t m_mostKept;
    std::deque<Job> m_waiting;
    std::deque<World> m_done;
};

}  // namespace huestep::server
