#include "server/web_listener.h"

#include <fcntl.h>

#include <cassert>
#include <utility>

#include "server/listening.h"

namespace huestep::server {

namespace {

std::string peerOf(uv_tcp_t* tcp) {
    sockaddr_storage storage{};
    int length = sizeof storage;
    uv_tcp_getpeername(tcp, reinterpret_cast<sockaddr*>(&storage), &length);
    return protocol::toText(addressOf(storage));
}

}  // namespace

WebListener::WebListener(uv_loop_t& loop, int backlog, int sendBufferBytes,
                         std::uint32_t acceptsAtOnce, Take take)
    : m_loop(loop),
      m_backlog(backlog),
      m_sendBufferBytes(sendBufferBytes),
      m_take(std::move(take)),
      m_turns(loop, acceptsAtOnce, [this] { accept(); }) {}

WebListener::~WebListener() {
    close();
}

void WebListener::close() {
    m_turns.close();
    if (m_handle) closeAndFree(std::exchange(m_handle, nullptr));
}

Status WebListener::listen(const protocol::Address& address) {
    Result<Listening> listening = listenOn(m_loop, address, m_backlog, onConnection, this);
    if (!listening) {
        return Error{"cannot serve the page on " + protocol::toText(address) + ": " +
                     listening.error().message};
    }
    m_handle = listening->handle;
    m_bound = std::move(listening->bound);
    m_turns.start();
    return Done{};
}

void WebListener::onConnection(uv_stream_t* listener, int status) {
    if (status == 0) static_cast<WebListener*>(listener->data)->m_turns.connection();
}

/// libuv does not give a descriptor away, so the taker gets a second one of the same socket.
void WebListener::accept() {
    auto* const tcp = new uv_tcp_t{};
    [[maybe_unused]] const int made = uv_tcp_init(&m_loop, tcp);
    assert(made == 0);  // it makes no socket yet, so there is nothing that could fail
    if (uv_accept(asStream(m_handle), asStream(tcp)) == 0) {
        int sendBuffer = m_sendBufferBytes;
        uv_send_buffer_size(asHandle(tcp), &sendBuffer);
        uv_tcp_nodelay(tcp, 1);
        uv_os_fd_t shared = -1;
        uv_fileno(asHandle(tcp), &shared);
        const int descriptor = fcntl(shared, F_DUPFD_CLOEXEC, 0);
        if (descriptor >= 0) m_take(descriptor, peerOf(tcp));
    }
    closeAndFree(tcp);
}

}  // namespace huestep::server
