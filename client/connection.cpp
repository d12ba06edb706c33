#include "client/connection.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace huestep::client {

/// A socket that its connection has let go of stays until the server has closed too, or for
/// `lingerMs`: closing at once could drop a Bye with whatever the server still sends.
struct Connection::Socket {
    uv_tcp_t tcp{};
    uv_timer_t linger{};
    uv_connect_t request{};
    uv_shutdown_t shutdown{};
    Connection* owner = nullptr;  ///< null once let go
    bool connected = false;
    int open = 2;  ///< handles; the last to close frees this
    std::array<char, 4096> waste{};

    static void onClosed(uv_handle_t* handle) {
        auto* socket = static_cast<Socket*>(handle->data);
        if (--socket->open == 0) delete socket;
    }
    void close() {
        for (uv_handle_t* handle :
             {reinterpret_cast<uv_handle_t*>(&tcp), reinterpret_cast<uv_handle_t*>(&linger)}) {
            if (!uv_is_closing(handle)) uv_close(handle, onClosed);
        }
    }
};

struct Connection::Write {
    uv_write_t request{};
    std::vector<std::byte> bytes;
};

namespace {

template <class Handle>
uv_handle_t* asHandle(Handle* handle) {
    return reinterpret_cast<uv_handle_t*>(handle);
}
template <class Handle>
uv_stream_t* asStream(Handle* handle) {
    return reinterpret_cast<uv_stream_t*>(handle);
}

}  // namespace

std::uint64_t backoffMs(std::uint32_t failures, std::uint32_t dice) {
    const std::uint64_t full =
        failures == 0 ? 0 : std::min<std::uint64_t>(2'000, 50u << std::min(failures - 1, 10u));
    return full - full / 4 * (dice % 1'024) / 1'024;
}

Connection::Connection(uv_loop_t& loop, protocol::Address address, Events events)
    : m_loop(loop),
      m_address(std::move(address)),
      m_events(std::move(events)),
      m_timer(new uv_timer_t) {
    uv_timer_init(&m_loop, m_timer);
    m_timer->data = this;
}

Connection::~Connection() {
    assert(m_stopped && !m_socket && !m_timer);
}

void Connection::start() {
    attempt();
}

void Connection::attempt() {
    uv_getaddrinfo_t resolver{};
    addrinfo hints{};
    hints.ai_socktype = SOCK_STREAM;
    const std::string port = std::to_string(m_address.port);
    // Without a callback libuv resolves at once: this loop has nothing else to do meanwhile.
    int status =
        uv_getaddrinfo(&m_loop, &resolver, nullptr, m_address.host.c_str(), port.c_str(), &hints);
    if (status != 0) return drop(uv_strerror(status));
    const std::unique_ptr<addrinfo, void (*)(addrinfo*)> found(resolver.addrinfo, uv_freeaddrinfo);
    m_socket = new Socket;
    m_socket->owner = this;
    m_socket->tcp.data = m_socket->linger.data = m_socket;
    m_socket->request.data = m_socket;
    uv_tcp_init(&m_loop, &m_socket->tcp);
    uv_timer_init(&m_loop, &m_socket->linger);
    status = uv_tcp_connect(&m_socket->request, &m_socket->tcp, found->ai_addr, onConnect);
    if (status != 0) drop(uv_strerror(status));
}

void Connection::onConnect(uv_connect_t* request, int status) {
    auto& socket = *static_cast<Socket*>(request->data);
    if (!socket.owner) return;
    Connection& self = *socket.owner;
    if (status != 0) return self.drop(uv_strerror(status));
    socket.connected = true;
    self.m_splitter.emplace();
    uv_tcp_nodelay(&socket.tcp, 1);
    uv_read_start(asStream(&socket.tcp), onAlloc, onRead);
    self.m_events.connected();
}

void Connection::onAlloc(uv_handle_t* handle, std::size_t, uv_buf_t* buffer) {
    auto& socket = *static_cast<Socket*>(handle->data);
    const std::span<char> input =
        socket.owner ? std::span<char>(socket.owner->m_input) : std::span<char>(socket.waste);
    *buffer = uv_buf_init(input.data(), static_cast<unsigned>(input.size()));
}

void Connection::onRead(uv_stream_t* stream, ssize_t count, const uv_buf_t* buffer) {
    auto& socket = *static_cast<Socket*>(stream->data);
    if (!socket.owner) {
        if (count < 0) socket.close();
        return;
    }
    if (count < 0) {
        const bool ended = count == UV_EOF;
        return socket.owner->drop(ended ? "the server closed the connection"
                                        : uv_strerror(static_cast<int>(count)));
    }
    const std::span<const char> bytes(buffer->base, static_cast<std::size_t>(count));
    socket.owner->received(std::as_bytes(bytes));
}

void Connection::received(std::span<const std::byte> bytes) {
    m_bytesIn += bytes.size();
    m_failures = 0;
    std::vector<protocol::Message> messages;
    const Status fed = m_splitter->feed(bytes, messages);
    const Socket* before = m_socket;
    for (protocol::Message& message : messages) {
        m_events.message(std::move(message));
        if (m_socket != before) return;  // the message ended this connection
    }
    if (!fed) return drop(fed.error().message);
    m_events.idle();
}

void Connection::send(const protocol::Message& message) {
    if (!m_socket || !m_socket->connected) return;
    uv_stream_t* stream = asStream(&m_socket->tcp);
    auto write = std::make_unique<Write>();
    write->bytes = protocol::encode(message);
    if (uv_stream_get_write_queue_size(stream) + write->bytes.size() > maxUnsentBytes) {
        return drop("the server does not read what is sent");
    }
    m_bytesOut += write->bytes.size();
    uv_buf_t buffer = uv_buf_init(reinterpret_cast<char*>(write->bytes.data()),
                                  static_cast<unsigned>(write->bytes.size()));
    write->request.data = write.get();
    const int status = uv_write(&write->request, stream, &buffer, 1, [](uv_write_t* request, int) {
        delete static_cast<Write*>(request->data);
    });
    // A failure shows at the next read as well, which ends the connection.
    if (status == 0) static_cast<void>(write.release());
}

void Connection::drop(const std::string& why) {
    letGo();
    ++m_failures;
    m_events.lost(why);
    if (!m_stopped) attemptLater();
}

void Connection::letGo() {
    if (!m_socket) return;
    Socket* socket = std::exchange(m_socket, nullptr);
    socket->owner = nullptr;
    if (!socket->connected ||
        uv_shutdown(&socket->shutdown, asStream(&socket->tcp), nullptr) != 0) {
        return socket->close();
    }
    uv_timer_start(
        &socket->linger, [](uv_timer_t* timer) { static_cast<Socket*>(timer->data)->close(); },
        lingerMs, 0);
}

void Connection::attemptLater() {
    const auto dice = static_cast<std::uint32_t>(uv_hrtime() >> 8);
    uv_timer_start(
        m_timer, [](uv_timer_t* timer) { static_cast<Connection*>(timer->data)->attempt(); },
        backoffMs(m_failures, dice), 0);
}

void Connection::stop() {
    if (m_stopped) return;
    m_stopped = true;
    letGo();
    uv_timer_t* timer = std::exchange(m_timer, nullptr);
    uv_close(asHandle(timer),
             [](uv_handle_t* handle) { delete reinterpret_cast<uv_timer_t*>(handle); });
}

}  // namespace huestep::client
