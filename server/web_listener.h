/// Accepts TCP connections on a libuv loop and hands their descriptors on.
///
/// libwebsockets could listen by itself, and is refused: it does not say why an address cannot be
/// bound, waits in silence for interfaces that do not exist, and counts no connections.
#pragma once

#include <uv.h>

#include <functional>
#include <memory>
#include <string>

#include "core/result.h"
#include "protocol/address.h"
#include "server/listening.h"

namespace huestep::server {

class WebListener {
 public:
    /// Takes over a connected, non-blocking socket; `peer` is HOST:PORT of its other end.
    using Take = std::function<void(int descriptor, const std::string& peer)>;

    WebListener(uv_loop_t& loop, int backlog, int sendBufferBytes, std::uint32_t acceptsAtOnce,
                Take take);
    ~WebListener();
    WebListener(const WebListener&) = delete;
    WebListener& operator=(const WebListener&) = delete;

    /// The sentence names the address and what the system says.
    Status listen(const protocol::Address& address);
    /// As bound. Requires a `listen` that succeeded.
    [[nodiscard]] const protocol::Address& bound() const { return m_bound; }
    void close();

 private:
    static void onConnection(uv_stream_t* listener, int status);
    void accept();

    uv_loop_t& m_loop;
    int m_backlog;
    int m_sendBufferBytes;
    Take m_take;
    uv_tcp_t* m_handle = nullptr;  ///< frees itself once closed
    AcceptTurns m_turns;
    protocol::Address m_bound;
};

}  // namespace huestep::server
