/// TCP for the hub: a listener, and a socket a connection. Thread rule: the loop's thread.
#pragma once

#include <uv.h>

#include <array>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "protocol/address.h"
#include "protocol/tls.h"
#include "server/hub.h"
#include "server/listening.h"

namespace huestep::server {

class Sockets {
 public:
    /// `tls`: what is spoken below the protocol; null: nothing. Outlives this.
    Sockets(uv_loop_t& loop, Hub& hub, const protocol::TlsContext* tls = nullptr);
    ~Sockets();
    Sockets(const Sockets&) = delete;
    Sockets& operator=(const Sockets&) = delete;

    /// Binds and listens. The sentence names the address and what the system says.
    Status listen(const protocol::Address& address);
    /// As bound. Requires a `listen` that succeeded.
    [[nodiscard]] const protocol::Address& bound() const { return m_bound; }

    /// Writes what the hub has for each client, closes what is finished.
    void flush();
    /// The same for the clients of one session: what its tick has to say.
    void flush(const Session& session);
    void stopListening();
    /// Closes every socket, whatever it still holds.
    void closeAll();
    [[nodiscard]] bool none() const { return m_sockets.empty(); }

 private:
    struct Socket;
    struct Write;
    static void onConnection(uv_stream_t* listener, int status);
    static void onAlloc(uv_handle_t* handle, std::size_t suggested, uv_buf_t* buffer);
    static void onRead(uv_stream_t* stream, ssize_t count, const uv_buf_t* buffer);
    static void onWritten(uv_write_t* request, int status);

    void accept();
    void start(std::unique_ptr<Socket> socket);
    void received(Socket& socket, std::span<const std::byte> bytes);
    void flush(Socket& socket);
    void write(Socket& socket, std::vector<SharedBytes> bytes);
    void sayTheEnd(Socket& socket);
    void close(Socket& socket);

    uv_loop_t& m_loop;
    Hub& m_hub;
    const protocol::TlsContext* m_tls;
    uv_tcp_t* m_listener = nullptr;  ///< frees itself once closed
    AcceptTurns m_turns;
    protocol::Address m_bound;
    std::map<ConnectionId, Socket*> m_sockets;  ///< open ones; each frees itself once closed
    /// One buffer for all reads: libuv hands it back before it asks again. Small, as libuv fills it
    /// up to 32 times for one socket before another has its turn.
    std::array<char, 8192> m_input{};
};

}  // namespace huestep::server
