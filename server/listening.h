/// A TCP listener, and who is at the other end. Thread rule: the loop's thread.
#pragma once

#include <uv.h>

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

template <class Handle>
uv_handle_t* asHandle(Handle* handle) {
    return reinterpret_cast<uv_handle_t*>(handle);
}
template <class Handle>
uv_stream_t* asStream(Handle* handle) {
    return reinterpret_cast<uv_stream_t*>(handle);
}

}  // namespace huestep::server
