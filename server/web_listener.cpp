#include "server/web_listener.h"

#include <fcntl.h>
#include <netdb.h>

#include <cstring>
#include <utility>

namespace huestep::server {

namespace {

constexpr int backlog = 64;

void closeAndFree(uv_tcp_t* tcp) {
    uv_close(reinterpret_cast<uv_handle_t*>(tcp),
             [](uv_handle_t* handle) { delete reinterpret_cast<uv_tcp_t*>(handle); });
}

std::string numberOf(const sockaddr_storage& storage) {
    char text[64] = "?";
    if (storage.ss_family == AF_INET6) {
        uv_ip6_name(reinterpret_cast<const sockaddr_in6*>(&storage), text, sizeof text);
    } else {
        uv_ip4_name(reinterpret_cast<const sockaddr_in*>(&storage), text, sizeof text);
    }
    return text;
}

std::uint16_t portOf(const sockaddr_storage& storage) {
    return storage.ss_family == AF_INET6
               ? ntohs(reinterpret_cast<const sockaddr_in6*>(&storage)->sin6_port)
               : ntohs(reinterpret_cast<const sockaddr_in*>(&storage)->sin_port);
}

std::string peerOf(uv_tcp_t* tcp) {
    sockaddr_storage storage{};
    int length = sizeof storage;
    uv_tcp_getpeername(tcp, reinterpret_cast<sockaddr*>(&storage), &length);
    return visitorOf(storage);
}

Error refused(const protocol::Address& address, int status) {
    return Error{"cannot serve the page on " + protocol::toText(address) + ": " +
                 uv_strerror(status)};
}

}  // namespace

std::string visitorOf(sockaddr_storage storage) {
    if (storage.ss_family == AF_INET6) {
        in6_addr& number = reinterpret_cast<sockaddr_in6*>(&storage)->sin6_addr;
        // An IPv4 number as a listener of both families sees it: its /64 is everybody's.
        if (!IN6_IS_ADDR_V4MAPPED(&number)) std::memset(number.s6_addr + 8, 0, 8);
    }
    return numberOf(storage);
}

WebListener::WebListener(uv_loop_t& loop, int sendBufferBytes, Take take)
    : m_loop(loop), m_sendBufferBytes(sendBufferBytes), m_take(std::move(take)) {}

WebListener::~WebListener() {
    close();
}

void WebListener::close() {
    if (m_handle) closeAndFree(std::exchange(m_handle, nullptr));
}

Status WebListener::listen(const protocol::Address& address) {
    uv_getaddrinfo_t resolver{};
    addrinfo hints{};
    hints.ai_socktype = SOCK_STREAM;
    hints.ai_flags = AI_PASSIVE;
    // Without a callback libuv resolves at once; this is the start of the program.
    int status = uv_getaddrinfo(&m_loop, &resolver, nullptr, address.host.c_str(),
                                std::to_string(address.port).c_str(), &hints);
    if (status != 0) return refused(address, status);
    const std::unique_ptr<addrinfo, void (*)(addrinfo*)> found(resolver.addrinfo, uv_freeaddrinfo);

    auto handle = std::make_unique<uv_tcp_t>();
    status = uv_tcp_init(&m_loop, handle.get());
    if (status != 0) return refused(address, status);
    m_handle = handle.release();
    m_handle->data = this;
    status = uv_tcp_bind(m_handle, found->ai_addr, 0);
    if (status == 0) {
        status = uv_listen(reinterpret_cast<uv_stream_t*>(m_handle), backlog, onConnection);
    }
    if (status != 0) {
        close();
        return refused(address, status);
    }
    sockaddr_storage storage{};
    int length = sizeof storage;
    uv_tcp_getsockname(m_handle, reinterpret_cast<sockaddr*>(&storage), &length);
    m_bound = {numberOf(storage), portOf(storage)};
    return Done{};
}

void WebListener::onConnection(uv_stream_t* listener, int status) {
    if (status == 0) static_cast<WebListener*>(listener->data)->accept();
}

/// libuv does not give a descriptor away, so the taker gets a second one of the same socket.
void WebListener::accept() {
    auto* tcp = new uv_tcp_t{};
    uv_tcp_init(&m_loop, tcp);
    if (uv_accept(reinterpret_cast<uv_stream_t*>(m_handle), reinterpret_cast<uv_stream_t*>(tcp)) ==
        0) {
        int sendBuffer = m_sendBufferBytes;
        uv_send_buffer_size(reinterpret_cast<uv_handle_t*>(tcp), &sendBuffer);
        uv_tcp_nodelay(tcp, 1);
        uv_os_fd_t shared = -1;
        uv_fileno(reinterpret_cast<uv_handle_t*>(tcp), &shared);
        const int own = fcntl(shared, F_DUPFD_CLOEXEC, 0);
        if (own >= 0) m_take(own, peerOf(tcp));
    }
    closeAndFree(tcp);
}

}  // namespace huestep::server
