/// A TCP listener, and who is at the other end. Thread rule: the loop's thread.
#pragma once

#include <uv.h>

#include <cstdint>
#include <functional>

#include "core/result.h"
#include "protocol/address.h"

namespace huestep::server {

/// The one number and port of a socket's address, IPv4 or IPv6.
protocol::Address addressOf(const sockaddr_storage& storage);

struct Listening {
    uv_tcp_t* handle = nullptr;  ///< `closeAndFree` ends it; `data` is the caller's
    protocol::Address bound;     ///< the port as the system gave it
};

/// Listens on the first of the numbers that the host's name has and that can be bound. Blocks on
/// the look-up of a name. The sentence says what the system says of the last one, without the
/// address.
Result<Listening> listenOn(uv_loop_t& loop, const protocol::Address& address, int backlog,
                           uv_connection_cb onConnection, void* data);

/// The memory goes once the loop has closed the handle.
void closeAndFree(uv_tcp_t* handle);

/// Has a listener accept no more than so many connections in a turn of the loop: libuv itself goes
/// on for as long as there is somebody, and a flood of them would hold up every tick.
class AcceptTurns {
 public:
    /// `accept` calls uv_accept once.
    AcceptTurns(uv_loop_t& loop, std::uint32_t most, std::function<void()> accept);
    ~AcceptTurns() { close(); }
    AcceptTurns(const AcceptTurns&) = delete;
    AcceptTurns& operator=(const AcceptTurns&) = delete;

    /// Once the listener is there.
    void start();
    /// The listener's word that somebody is there: he is accepted now or in the next turn. As long
    /// as he is not, libuv asks for no more.
    void connection();
    void close();

 private:
    uv_loop_t& m_loop;
    std::uint32_t m_most;
    std::function<void()> m_accept;
    uv_prepare_t* m_turn = nullptr;  ///< frees itself once closed
    std::uint32_t m_accepted = 0;    ///< in this turn
    bool m_waits = false;
};

template <class Handle>
uv_handle_t* asHandle(Handle* handle) {
    return reinterpret_cast<uv_handle_t*>(handle);
}
template <class Handle>
uv_stream_t* asStream(Handle* handle) {
    return reinterpret_cast<uv_stream_t*>(handle);
}

}  // namespace huestep::server
