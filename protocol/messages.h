/// The messages between server and clients, as plain values.
///
/// `protocol/codec.h` turns them into Cap'n Proto bytes and back, with limits; `protocol/frame.h`
/// puts a checksummed header before them. The schema with its prose is `protocol/messages.capnp`.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/world/command.h"

namespace huestep::protocol {

inline constexpr std::uint32_t protocolVersion = 1;

/// What two builds must share to step the same bits. Compared before play.
struct Fingerprint {
    std::uint64_t selfTest = 0;  ///< full root of the built-in self-test scene after 120 ticks
    std::uint64_t schema = 0;    ///< hash of the message schema's text
    std::uint32_t scene = 0;     ///< version of the scene layout, of the snapshot's << 16
    friend bool operator==(const Fingerprint&, const Fingerprint&) = default;
};

/// One-time right to take up a player's seat again, bound to the session and its epoch.
using ResumeToken = std::array<std::uint8_t, 16>;

enum class Role : std::uint8_t { Player, Spectator };

/// Client → server, first message of a connection.
struct Hello {
    std::uint32_t version = protocolVersion;
    Fingerprint fingerprint;
    std::string session;  ///< name, 1 to 64 of [a-z0-9_-]
    Role role = Role::Player;
    std::optional<ResumeToken> resume;
    /// With `resume`: the last tick the client has stepped and holds a world for, so that the
    /// server may send the tail alone; 0: needs a snapshot.
    std::uint64_t haveTick = 0;
    std::uint64_t haveHash = 0;  ///< motion root after `haveTick`
    /// Sealed, as an issuer gave it (protocol/ticket.h); empty: none.
    std::vector<std::byte> ticket;
    /// The games that this build can step: see `rulesMark`.
    std::vector<std::uint64_t> rules;
    friend bool operator==(const Hello&, const Hello&) = default;
};

/// Server → client: the connection may play.
struct Welcome {
    std::string session;
    PlayerId player = 0;      ///< 0 for a spectator
    std::uint32_t epoch = 0;  ///< counts the server's starts of this session
    std::uint64_t tick = 0;   ///< the next tick the server will close
    float ticksPerSecond = 60.0f;
    /// Ticks between an intent's arrival and its earliest tick; for a client that predicts, between
    /// an input and the tick it asks for.
    std::uint32_t inputDelay = 0;
    std::uint32_t maxCommandsPerIntent = 16;
    std::uint64_t lastSequence = 0;  ///< of this player, as far as the server has put in order
    ResumeToken resume{};
    /// Of this player, waiting for their tick at the server; one more ends the connection with
    /// TooFast. In commands, and in bytes as `commandBytes` counts them.
    std::uint32_t maxQueuedCommands = 256;
    std::uint32_t maxQueuedBytes = 65'536;
    /// A client that predicts adapts its delay between `inputDelay` and this to its round trip; not
    /// above `inputDelay`: the delay is fixed.
    std::uint32_t maxInputDelay = 0;
    friend bool operator==(const Welcome&, const Welcome&) = default;
};

/// The hash of a world after a tick. For tick T: T steps have been taken.
struct Checkpoint {
    std::uint64_t tick = 0;
    std::uint64_t motionRoot = 0;
    friend bool operator==(const Checkpoint&, const Checkpoint&) = default;
};

/// Client → server: what the player wants, and what its world was.
struct Intent {
    std::vector<Command> commands;  ///< author is set by the server; sequences rise
    std::optional<Checkpoint> checkpoint;
    /// Of all the commands: the first frame that may have them; if that is closed when they come,
    /// the next. 0: they ask for none, and wait for Welcome's `inputDelay`.
    std::uint64_t tick = 0;
    friend bool operator==(const Intent&, const Intent&) = default;
};

/// Server → client: everything that decides one step. Also the record of the journal.
struct Frame {
    std::uint64_t tick = 0;         ///< this frame leads from `tick` to `tick + 1` steps taken
    std::vector<Command> commands;  ///< in key order
    /// Players whose input came too late for this tick: nothing is heard of them, or commands here
    /// asked for a frame before. By id.
    std::vector<PlayerId> substituted;
    std::uint64_t previousRoot = 0;  ///< motion root of the world this frame is applied to
    std::uint64_t committed = 0;     ///< frames below this tick are on disk
    friend bool operator==(const Frame&, const Frame&) = default;
};

/// Server → client: a snapshot follows in chunks.
struct SnapshotBegin {
    std::uint64_t tick = 0;
    std::uint64_t bytes = 0;
    std::uint64_t hash = 0;  ///< XXH3-64 of all bytes
    friend bool operator==(const SnapshotBegin&, const SnapshotBegin&) = default;
};
struct SnapshotChunk {
    std::uint64_t offset = 0;
    std::vector<std::byte> data;  ///< at most 60,000 bytes
    friend bool operator==(const SnapshotChunk&, const SnapshotChunk&) = default;
};
struct SnapshotEnd {
    std::uint64_t tick = 0;
    friend bool operator==(const SnapshotEnd&, const SnapshotEnd&) = default;
};

/// Client → server: my world differs, or I have none: send a snapshot.
struct SnapshotRequest {
    std::uint64_t tick = 0;
    friend bool operator==(const SnapshotRequest&, const SnapshotRequest&) = default;
};

/// Either way: what is the hash of each block of 64 bodies after this tick?
struct HashQuery {
    std::uint64_t tick = 0;
    friend bool operator==(const HashQuery&, const HashQuery&) = default;
};
/// The answer; empty if the peer no longer has that tick.
struct HashNodes {
    std::uint64_t tick = 0;
    std::vector<std::uint64_t> leaves;  ///< at most 4,096 a message, from `first`
    std::uint32_t first = 0;
    friend bool operator==(const HashNodes&, const HashNodes&) = default;
};

/// Client → server: what a client found when its world differed, for the log and its operators.
struct DesyncReport {
    std::uint64_t tick = 0;
    std::uint64_t mine = 0;
    std::uint64_t yours = 0;
    BodyId body = 0;
    std::string field;  ///< "velocity.x"
    std::string here;   ///< the client's value
    std::string there;  ///< the server's
    friend bool operator==(const DesyncReport&, const DesyncReport&) = default;
};

/// Either way; the answer is the same with `reply` set.
struct Ping {
    std::uint64_t nonce = 0;
    bool reply = false;
    // A server's reply, when the Ping came:
    std::uint64_t tick = 0;        ///< that it will close next, or 0
    std::uint32_t sinceClose = 0;  ///< µs since it closed the one before
    friend bool operator==(const Ping&, const Ping&) = default;
};

/// The numbers are part of the protocol: grow only at the end.
enum class ByeReason : std::uint16_t {
    Done,
    VersionMismatch,
    FingerprintMismatch,
    UnknownSession,
    SessionFull,
    BadMessage,
    UnexpectedMessage,
    TooSlow,
    TooFast,
    Timeout,
    ServerStops,
    ResumeRefused,
    TicketRefused,
};

/// Either way: the connection ends.
struct Bye {
    ByeReason reason = ByeReason::Done;
    std::string text;  ///< a sentence for a person, at most 256 bytes
    bool mayResume = false;
    friend bool operator==(const Bye&, const Bye&) = default;
};

/// Server → viewer: what to draw after a tick. Viewers do not step.
struct View {
    struct Shape {
        std::uint32_t body = 0;  ///< place in `poses`
        ShapeKind kind = ShapeKind::Circle;
        float radius = 0.0f;
        std::vector<Vec2> vertices;
        friend bool operator==(const Shape&, const Shape&) = default;
    };
    struct Contact {
        Vec2 point;
        std::uint8_t colour = 0;  ///< graph colour; 255: overflow
        friend bool operator==(const Contact&, const Contact&) = default;
    };
    /// The points that a joint holds together or apart; a mouse joint's first is its target.
    struct Joint {
        Vec2 a;
        Vec2 b;
        friend bool operator==(const Joint&, const Joint&) = default;
    };
    std::uint64_t tick = 0;
    std::uint64_t root = 0;
    std::uint32_t players = 0;
    std::uint32_t definitions = 0;  ///< rises when `shapes` changed; shapes are sent only then
    std::vector<Shape> shapes;
    std::vector<BodyId> bodies;       ///< with `shapes`
    std::vector<Pose> poses;          ///< of centres of mass
    std::vector<std::uint8_t> flags;  ///< a body: bit 0 asleep, bits 1–2 type, bit 3 a player's
    std::vector<Contact> contacts;
    std::vector<Joint> joints;
    std::string score;  ///< how the game stands, in a line for people
    friend bool operator==(const View&, const View&) = default;
};

using Message =
    std::variant<Hello, Welcome, Intent, Frame, SnapshotBegin, SnapshotChunk, SnapshotEnd,
                 SnapshotRequest, HashQuery, HashNodes, DesyncReport, Ping, Bye, View>;

}  // namespace huestep::protocol
