/// The limits of the server, but those of the page: see `WebLimits`. What a message may hold is
/// the protocol's, in protocol/codec.h.
#pragma once

#include <cstddef>
#include <cstdint>

namespace huestep::server {

/// ns since some fixed moment; never read from a clock in here, always an argument.
using Instant = std::uint64_t;

inline constexpr Instant millisecond = 1'000'000;
inline constexpr Instant second = 1'000'000'000;

struct Limits {
    // A process.
    std::uint32_t sessions = 256;
    std::uint32_t connections = 1'024;
    std::uint32_t halfOpen = 64;  ///< connections without a finished Hello; one more ends the
                                  ///< oldest of the address that has most of them
    // By address (server/visitors.h); of loopback there is one for many users, and these do not
    // hold.
    std::uint32_t connectionsPerAddress = 256;
    std::uint32_t halfOpenPerAddress = 16;
    double acceptsPerSecond = 20.0;  ///< token bucket of connections
    double acceptBurst = 128.0;
    std::size_t rateBuckets = 1'024;       ///< that addresses share by their hash
    double strangerNotesPerSecond = 20.0;  ///< token bucket of log lines about those who were
    double strangerNoteBurst = 100.0;      ///< not let in, all together
    std::uint32_t acceptsAtOnce = 16;      ///< then others have their turn
    int backlog = 128;                     ///< connections that the system holds for us to accept
    Instant farewellTime = 500 * millisecond;  ///< for clients to read their Bye at a stop
    Instant spareTime = 2 * millisecond;  ///< before a deadline, nothing else is begun any more

    // A connection.
    std::size_t helloBytes = 1'024;     ///< largest payload before Welcome
    std::size_t messageBytes = 16'384;  ///< largest payload after it: an Intent
    std::uint32_t commandsPerIntent = 16;
    Instant helloTime = 5 * second;          ///< from accept to a finished Hello
    Instant partialTime = 3 * second;        ///< for the rest of a message begun, and
    double partialBytesPerSecond = 1'024.0;  ///< beside it, for the whole message at this pace
    Instant pingEvery = 2 * second;          ///< of silence
    Instant silenceTime = 15 * second;       ///< without a byte from the client
    double messagesPerSecond = 240.0;        ///< token bucket of all messages
    double messageBurst = 1'200.0;
    double bytesPerSecond = 128.0 * 1024.0;  ///< token bucket of all bytes
    double byteBurst = 256.0 * 1024.0;
    double heavyPerSecond = 1.0;  ///< token bucket of requests that cost work:
    double heavyBurst = 6.0;      ///< snapshots, hash queries, reports
    double notesPerSecond = 1.0;  ///< token bucket of log lines that a client causes at will
    double noteBurst = 5.0;
    std::size_t ticketsUsed = 65'536;      ///< remembered until they expire; then none is taken
    std::uint32_t queriesWaiting = 4;      ///< hash queries
    Instant rebuildPatience = 2 * second;  ///< for a rebuilt world, before something else is sent
    Instant byeTime = 2 * second;          ///< for a client to read its Bye
    std::size_t byeBytes = 256u << 10;     ///< read and let go meanwhile, so that it is not lost

    // A slow consumer: what lies in the transport for one client, and how far behind it may be.
    std::size_t lowWater = 64u << 10;      ///< no more is handed out while so much is unsent
    std::size_t clientBytes = 256u << 10;  ///< hard: passing it ends the connection
    Instant resyncBehind = 2 * second;     ///< behind by more: a snapshot instead of the tail
    Instant dropBehind = 10 * second;     ///< behind for longer, or not a byte drained: Bye TooSlow
    Instant snapshotGrace = 10 * second;  ///< from the start of a snapshot, before its pace counts
    double snapshotBytesPerSecond = 16.0 * 1024.0;  ///< pace that a reader of one must keep
    int sendBufferBytes = 128 << 10;  ///< the kernel's share of what is unread; small: lag shows

    // A session.
    std::uint32_t queuedPerPlayer = 256;  ///< commands waiting, of one player
    std::size_t queuedBytesPerPlayer = 64u << 10;
    std::uint32_t queuedInTotal = 8'192;  ///< commands waiting, of all
    std::size_t queuedBytes = 2u << 20;
    std::uint32_t commandsPerFrame = 1'024;  ///< beside the host's own
    std::uint32_t perPlayerPerFrame = 32;
    std::size_t frameCommandBytes = 128u << 10;  ///< of players' commands in one frame
    std::uint32_t joinsPerFrame = 16;
    std::uint32_t seats = 1'024;
    std::uint32_t inputDelay = 0;        ///< ticks between an intent and its earliest frame
    std::uint32_t maxInputDelay = 0;     ///< clients that predict adapt theirs up to this
    std::uint32_t askedAhead = 150;      ///< ticks; a command that asks for a later one comes then
    std::uint32_t lateTicks = 60;        ///< a player silent for longer is `substituted`
    Instant seatKept = 30 * second;      ///< for a player whose connection broke
    std::uint32_t recentFrames = 1'800;  ///< frames kept for those who are behind
    std::size_t recentBytes = 4u << 20;  ///< the same in bytes; whichever is fewer
    std::uint32_t keyframeTicks = 60;    ///< from one snapshot in memory to the next
    std::uint32_t keyframes = 4;         ///< snapshots kept in memory
    std::uint32_t freshTicks = 30;       ///< a joiner takes a snapshot no older than this
    std::uint32_t lentSnapshots = 8;     ///< different ones under way to clients at a time
    std::uint32_t journalSnapshotTicks = 600;
    std::uint32_t segmentTicks = 36'000;     ///< the journal starts a new file after so many,
    std::uint64_t segmentBytes = 64u << 20;  ///< or when one has reached this size
    std::uint32_t uncommittedTicks = 600;    ///< the disk is behind by more: the session pauses
    std::size_t drawn = 32'768;              ///< bodies, shapes, contacts, joints each in a view
    std::uint32_t rebuildsWaiting = 4;       ///< ticks asked for and not yet rebuilt
    std::uint32_t rebuiltWorlds = 2;         ///< kept for those who asked
    std::uint32_t catchUpTicks = 4;          ///< late ticks closed at once; the rest is let go
};

}  // namespace huestep::server
