/// The web endpoint: a page, a WebSocket that sends what the page draws, and one for pages that
/// step the world themselves.
///
///     Result<std::shared_ptr<WebEndpoint>> web = WebEndpoint::open(*host, {"127.0.0.1:0"});
///     if (!web) -> print web.error().message, exit 2
///     std::cout << "page http://" << (*web)->address() << "/" << std::endl;   // then host->run()
///
/// HTTP and WebSockets are libwebsockets', on the host's libuv loop. `/` and the page's files are
/// answered by server/web_route.h. `/view?session=NAME` is the WebSocket: every binary message is
/// one frame of the protocol (protocol/frame.h) with a View; the viewer sends nothing, and is let
/// go if it does. `/peer` is the WebSocket of a page that is a client like those over TCP: see
/// server/web_peer.h.
///
/// Limits: see `WebLimits`; beyond them a request is answered 429 or 503, a connection closed.
/// Thread rule: the host's thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "core/result.h"
#include "server/host.h"

namespace huestep::server {

struct WebLimits {
    std::size_t connections = 256;
    int backlog = 64;               ///< connections that the system holds for us to accept
    std::size_t viewers = 64;       ///< WebSockets among them, of either kind, over all sessions
    double requestsPerSecond = 20;  ///< token bucket an address (IPv6: a /64)
    double requestBurst = 240;
    std::size_t rateBuckets = 256;      ///< that addresses share by their hash
    double viewsPerSecond = 60;         ///< to each viewer; ticks beyond are left out
    std::uint16_t headerBytes = 4096;   ///< of a request's head
    std::uint16_t idleSeconds = 10;     ///< for a request's head, and between requests
    std::uint64_t heartbeatMs = 2000;   ///< a session that stands still is shown so often
    std::uint16_t pingSeconds = 10;     ///< a viewer is pinged so often,
    std::uint16_t silenceSeconds = 25;  ///< and let go after so long without an answer
    int sendBufferBytes = 256 << 10;    ///< the kernel's share of a slow viewer's lag
    std::uint64_t farewellMs = 200;     ///< for viewers to take their close when the host stops
};

struct WebConfig {
    std::string listen = "127.0.0.1:0";  ///< HOST:PORT; port 0: any free one
    WebLimits limits;
    LogSink log;  ///< none: silent
};

/// What happened since the start, for the log and for tests.
struct WebCounters {
    std::uint64_t requests = 0;
    std::uint64_t refusedConnections = 0;
    std::uint64_t tooManyRequests = 0;
    std::uint64_t viewersTotal = 0;
    std::uint64_t refusedViewers = 0;
    std::uint64_t viewsSent = 0;
    std::uint64_t viewsDropped = 0;  ///< a newer one took their place
    std::uint64_t bytesOut = 0;      ///< of views
    std::uint64_t peersTotal = 0;    ///< pages that step the world themselves
};

class WebEndpoint : public HostPart {
 public:
    /// Binds the address and adds itself to the host, which must not go before it. The sentence of
    /// a failure names the address.
    static Result<std::shared_ptr<WebEndpoint>> open(Host& host, WebConfig config);
    ~WebEndpoint() override;
    WebEndpoint(const WebEndpoint&) = delete;
    WebEndpoint& operator=(const WebEndpoint&) = delete;

    /// HOST:PORT, the port as bound.
    [[nodiscard]] const std::string& address() const;
    [[nodiscard]] std::size_t viewers() const;
    [[nodiscard]] const WebCounters& counters() const;

    void afterTick(const Session& session) override;
    void stopping() override;

 private:
    struct Inside;
    explicit WebEndpoint(std::unique_ptr<Inside> inside);
    std::unique_ptr<Inside> m_inside;
};

}  // namespace huestep::server
