#include "server/listening.h"

#include <netdb.h>

#include <memory>
#include <string>
#include <utility>

namespace huestep::server {

namespace {

Result<Listening> listenAt(uv_loop_t& loop, const sockaddr& number, int backlog,
                           uv_connection_cb onConnection, void* data) {
    Listening out;
    auto handle = std::make_unique<uv_tcp_t>();
    int status = uv_tcp_init(&loop, handle.get());
    if (status != 0) return Error{uv_strerror(status)};
    out.handle = handle.release();
    out.handle->data = data;
    status = uv_tcp_bind(out.handle, &number, 0);
    if (status == 0) status = uv_listen(asStream(out.handle), backlog, onConnection);
    sockaddr_storage storage{};
    int length = sizeof storage;
    if (status == 0) {
        status = uv_tcp_getsockname(out.handle, reinterpret_cast<sockaddr*>(&storage), &length);
    }
    if (status != 0) {
        closeAndFree(out.handle);
        return Error{uv_strerror(status)};
    }
    out.bound = addressOf(storage);
    return out;
}

}  // namespace

protocol::Address addressOf(const sockaddr_storage& storage) {
    char text[64] = "?";
    protocol::Address out;
    if (storage.ss_family == AF_INET6) {
        const auto* six = reinterpret_cast<const sockaddr_in6*>(&storage);
        uv_ip6_name(six, text, sizeof text);
        out.port = ntohs(six->sin6_port);
    } else {
        const auto* four = reinterpret_cast<const sockaddr_in*>(&storage);
        uv_ip4_name(four, text, sizeof text);
        out.port = ntohs(four->sin_port);
    }
    out.host = text;
    return out;
}

Result<Listening> listenOn(uv_loop_t& loop, const protocol::Address& address, int backlog,
                           uv_connection_cb onConnection, void* data) {
    // Without a callback libuv resolves at once; this is the start of the program.
    uv_getaddrinfo_t resolver{};
    addrinfo hints{};
    hints.ai_socktype = SOCK_STREAM;
    hints.ai_flags = AI_PASSIVE;
    const std::string port = std::to_string(address.port);
    const int status =
        uv_getaddrinfo(&loop, &resolver, nullptr, address.host.c_str(), port.c_str(), &hints);
    if (status != 0) return Error{uv_strerror(status)};
    const std::unique_ptr<addrinfo, void (*)(addrinfo*)> found(resolver.addrinfo, uv_freeaddrinfo);
    Result<Listening> last = Error{"the name has no number"};
    for (const addrinfo* each = found.get(); each != nullptr; each = each->ai_next) {
        last = listenAt(loop, *each->ai_addr, backlog, onConnection, data);
        if (last) return last;
    }
    return last;
}

AcceptTurns::AcceptTurns(uv_loop_t& loop, std::uint32_t most, std::function<void()> accept)
    : m_loop(loop), m_most(most), m_accept(std::move(accept)) {}

void AcceptTurns::start() {
    m_turn = new uv_prepare_t{};
    uv_prepare_init(&m_loop, m_turn);  // takes nothing of the system
    m_turn->data = this;
    uv_prepare_start(m_turn, [](uv_prepare_t* handle) {
        auto& self = *static_cast<AcceptTurns*>(handle->data);
        self.m_accepted = 0;
        if (std::exchange(self.m_waits, false)) self.connection();
    });
    uv_unref(asHandle(m_turn));  // a loop with nothing else to do may end
}

void AcceptTurns::connection() {
    m_waits = m_accepted >= m_most;
    if (m_waits) return;
    ++m_accepted;
    m_accept();
}

void AcceptTurns::close() {
    if (!m_turn) return;
    uv_close(asHandle(std::exchange(m_turn, nullptr)),
             [](uv_handle_t* handle) { delete reinterpret_cast<uv_prepare_t*>(handle); });
}

void closeAndFree(uv_tcp_t* handle) {
    uv_close(asHandle(handle),
             [](uv_handle_t* closed) { delete reinterpret_cast<uv_tcp_t*>(closed); });
}

}  // namespace huestep::server
