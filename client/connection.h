/// A TCP connection to a server, made anew when it breaks or falls silent. Thread rule: the loop's
/// thread.
///
/// libuv writes without MSG_NOSIGNAL, so the process must ignore SIGPIPE: a server that closes
/// while bytes are sent to it would end the process. `main` does it, as signals are the process's.
#pragma once

#include <uv.h>

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/lookup.h"
#include "client/pulse.h"
#include "core/result.h"
#include "protocol/address.h"
#include "protocol/frame.h"
#include "protocol/tls.h"

namespace huestep::client {

/// How long to wait before the attempt after `failures` failed ones: 50 ms, doubling, at most 2 s,
/// less up to a quarter drawn from `dice`, so that clients of one server do not come all at once.
std::uint64_t backoffMs(std::uint32_t failures, std::uint32_t dice);

/// Most bytes that may wait to be written; a server that does not read so much is given up.
inline constexpr std::size_t maxUnsentBytes = 1u << 20;
inline constexpr std::uint64_t lingerMs = 500;
/// For an address to answer before the name's next one is tried.
inline constexpr std::uint64_t answerMs = 3'000;

struct Destination {
    protocol::Address address;
    /// Without a byte from the server for so long, with Pings in between, the connection is lost.
    std::uint64_t silenceMs = 10'000;
    Resolve resolve = askSystem;
    /// What is spoken below the protocol; null: nothing. The server's certificate must bear the
    /// host of `address`.
    std::shared_ptr<const protocol::TlsContext> tls{};
};

class Connection {
 public:
    struct Events {
        std::function<void()> connected;
        std::function<void(protocol::Message)> message;
        /// All messages that had arrived have been told.
        std::function<void()> idle;
        /// The connection is gone, or an attempt failed; the sentence says why. Another attempt
        /// follows by itself unless `stop` is called.
        std::function<void(const std::string& why)> lost;
        /// Another attempt would not help: the name was never known, or what came first was no
        /// frame. The owner calls `stop`. Empty: `lost` is called, and attempts go on.
        std::function<void(const std::string& why)> hopeless = nullptr;
    };

    Connection(uv_loop_t& loop, Destination destination, Events events);
    /// After `stop`, and once the loop has run out.
    ~Connection();
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    void start();
    void send(const protocol::Message& message);
    /// Ends this connection; another attempt follows. What waits is written first, within
    /// `lingerMs`.
    void drop(const std::string& why);
    /// Ends it likewise, with no more attempts and no more events.
    void stop();

    [[nodiscard]] std::uint64_t bytesIn() const { return m_bytesIn; }
    [[nodiscard]] std::uint64_t bytesOut() const { return m_bytesOut; }

 private:
    struct Handles;
    struct Socket;
    struct Write;
    static void onTimer(uv_timer_t* timer);
    static void onBeat(uv_timer_t* timer);
    static void onFound(uv_async_t* async);
    static void onConnect(uv_connect_t* request, int status);
    static void onAlloc(uv_handle_t* handle, std::size_t suggested, uv_buf_t* buffer);
    static void onRead(uv_stream_t* stream, ssize_t count, const uv_buf_t* buffer);

    void attempt();
    void attemptLater();
    void tryNext(const std::string& why);
    void arrived(std::span<const std::byte> bytes);
    void arrivedByTls(std::span<const std::byte> bytes);
    void received(std::span<const std::byte> bytes);
    void write(std::vector<std::byte> bytes);
    void giveUp(const std::string& why);
    void letGo();

    uv_loop_t& m_loop;
    Destination m_destination;
    Events m_events;
    Handles* m_handles;          ///< free themselves when closed
    Socket* m_socket = nullptr;  ///< frees itself when closed
    std::optional<Lookup> m_lookup;
    SocketAddresses m_addresses;  ///< of this attempt
    std::size_t m_nextAddress = 0;
    Pulse m_pulse;
    std::uint64_t m_pings = 0;
    std::optional<protocol::FrameSplitter> m_splitter;
    std::optional<protocol::TlsStream> m_tls;  ///< of the socket that is connected
    bool m_framed = false;  ///< a frame has come, on this connection or one before
    std::uint32_t m_failures = 0;
    bool m_stopped = false;
    std::uint64_t m_bytesIn = 0;
    std::uint64_t m_bytesOut = 0;
    std::array<char, 65536> m_input{};
};

}  // namespace huestep::client
