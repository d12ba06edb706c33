/// A page that steps the world itself: a connection of the hub whose transport is a WebSocket.
///
/// The bytes are those that go over TCP (server/connection.h), in binary messages cut anywhere, so
/// such a page is a client like any other, under the same limits. Thread rule: the host's thread.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "server/hub.h"

namespace huestep::server {

class WebPeer {
 public:
    /// Most bytes of one message, but for a single piece of the hub's that is longer.
    static constexpr std::size_t messageBytes = 32u << 10;

    /// None: the hub is over a limit.
    static std::optional<WebPeer> accept(Hub& hub, std::string address, Instant now);
    /// Tells the hub that the transport is closed.
    ~WebPeer();
    WebPeer(WebPeer&& other) noexcept
        : m_hub(std::exchange(other.m_hub, nullptr)), m_id(other.m_id) {}
    WebPeer& operator=(WebPeer&&) = delete;

    void receive(std::span<const std::byte> bytes, Instant now);

    /// The next message behind `room` bytes; nothing but the room if there is none. To be asked
    /// when all that was handed out before has been taken by the system, and again until nothing
    /// comes: so the hub knows a page that reads slowly.
    std::vector<unsigned char> next(std::size_t room, Instant now);

    [[nodiscard]] bool finished() const { return m_hub->finished(m_id); }
    [[nodiscard]] bool overdue(Instant now) const { return m_hub->overdue(m_id, now); }
    [[nodiscard]] bool follows(const Session& session) const;

 private:
    WebPeer(Hub& hub, ConnectionId id) : m_hub(&hub), m_id(id) {}

    Hub* m_hub;
    ConnectionId m_id;
};

}  // namespace huestep::server
