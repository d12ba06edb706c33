#include "client/connection.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace huestep::client {

/// What lasts as long as the connection, whatever becomes of its sockets.
struct Connection::Handles {
    uv_timer_t timer{};  ///< of the next attempt, or of an address that is to answer
    uv_timer_t beat{};
    uv_async_t found{};  ///< the lookup's thread wakes the loop by it
    int open = 3;        ///< the last to close frees this

    Handles(uv_loop_t& loop, Connection* owner) {
        uv_timer_init(&loop, &timer);
        uv_timer_init(&loop, &beat);
        // Cannot fail: what it needs of the system, the loop's own start has opened.
        uv_async_init(&loop, &found, onFound);
        timer.data = beat.data = found.data = owner;
    }
    void close() {
        for (uv_handle_t* handle :
             {reinterpret_cast<uv_handle_t*>(&timer), reinterpret_cast<uv_handle_t*>(&beat),
              reinterpret_cast<uv_handle_t*>(&found)}) {
            handle->data = this;
            uv_close(handle, [](uv_handle_t* closed) {
                auto* handles = static_cast<Handles*>(closed->data);
                if (--handles->open == 0) delete handles;
            });
        }
    }
};

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
uv_stream_t* asStream(Handle* handle) {
    return reinterpret_cast<uv_stream_t*>(handle);
}

}  // namespace

std::uint64_t backoffMs(std::uint32_t failures, std::uint32_t dice) {
    const std::uint64_t full =
        failures == 0 ? 0 : std::min<std::uint64_t>(2'000, 50u << std::min(failures - 1, 10u));
    return full - full / 4 * (dice % 1'024) / 1'024;
}

Connection::Connection(uv_loop_t& loop, Destination destination, Events events)
    : m_loop(loop),
      m_destination(std::move(destination)),
      m_events(std::move(events)),
      m_handles(new Handles(loop, this)) {}

Connection::~Connection() {
    assert(m_stopped && !m_socket && !m_handles);
}

void Connection::start() {
    attempt();
}

void Connection::attempt() {
    m_lookup.emplace(m_destination.resolve, m_destination.address,
                     [found = &m_handles->found] { uv_async_send(found); });
}

void Connection::onFound(uv_async_t* async) {
    Connection& self = *static_cast<Connection*>(async->data);
    if (!self.m_lookup) return;
    std::optional<Result<SocketAddresses>> found = self.m_lookup->take();
    if (!found) return;
    self.m_lookup.reset();
    if (!*found && self.m_addresses.empty()) return self.giveUp(found->error().message);
    if (!*found) return self.drop(found->error().message);
    self.m_addresses = std::move(**found);
    self.m_nextAddress = 0;
    self.tryNext("the name has no address");
}

/// A name may have addresses at which nobody listens, such as ::1 beside 127.0.0.1: each has its
/// turn before the attempt has failed.
void Connection::tryNext(const std::string& why) {
    letGo();
    if (m_nextAddress == m_addresses.size()) return drop(why);
    const sockaddr_storage& address = m_addresses[m_nextAddress++];
    m_socket = new Socket;
    m_socket->owner = this;
    m_socket->tcp.data = m_socket->linger.data = m_socket;
    m_socket->request.data = m_socket;
    uv_tcp_init(&m_loop, &m_socket->tcp);
    uv_timer_init(&m_loop, &m_socket->linger);
    const int status = uv_tcp_connect(&m_socket->request, &m_socket->tcp,
                                      reinterpret_cast<const sockaddr*>(&address), onConnect);
    if (status != 0) return tryNext(uv_strerror(status));
    uv_timer_start(&m_handles->timer, onTimer, answerMs, 0);
}

void Connection::onTimer(uv_timer_t* timer) {
    Connection& self = *static_cast<Connection*>(timer->data);
    if (self.m_socket) return self.tryNext("no answer");
    self.attempt();
}

void Connection::onBeat(uv_timer_t* timer) {
    Connection& self = *static_cast<Connection*>(timer->data);
    switch (self.m_pulse.beat()) {
        case Pulse::Beat::Quiet:
            return;
        case Pulse::Beat::Ask:
            return self.send(protocol::Ping{++self.m_pings, false});
        case Pulse::Beat::Silent:
            return self.drop("the server is silent");
    }
}

void Connection::onConnect(uv_connect_t* request, int status) {
    auto& socket = *static_cast<Socket*>(request->data);
    if (!socket.owner) return;
    Connection& self = *socket.owner;
    if (status != 0) return self.tryNext(uv_strerror(status));
    socket.connected = true;
    uv_timer_stop(&self.m_handles->timer);
    const std::uint64_t beat = std::max<std::uint64_t>(
        1, self.m_destination.silenceMs / static_cast<std::uint64_t>(Pulse::silentAfter));
    self.m_pulse = Pulse{};
    uv_timer_start(&self.m_handles->beat, onBeat, beat, beat);
    self.m_splitter.emplace();
    uv_tcp_nodelay(&socket.tcp, 1);
    uv_read_start(asStream(&socket.tcp), onAlloc, onRead);
    self.m_tls.reset();
    if (!self.m_destination.tls) return self.m_events.connected();
    self.m_tls.emplace(*self.m_destination.tls, self.m_destination.address.host);
    self.write(self.m_tls->takeOutput());
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
    socket.owner->arrived(std::as_bytes(bytes));
}

void Connection::arrived(std::span<const std::byte> bytes) {
    m_bytesIn += bytes.size();
    m_pulse.heard();
    if (m_tls) return arrivedByTls(bytes);
    received(bytes);
}

void Connection::arrivedByTls(std::span<const std::byte> bytes) {
    const Socket* before = m_socket;
    const bool first = !m_tls->established();
    std::vector<std::byte> plain;
    const Status taken = m_tls->receive(bytes, plain);
    write(m_tls->takeOutput());
    if (m_socket == before && first && m_tls->established()) m_events.connected();
    if (m_socket == before && !plain.empty()) received(plain);
    if (taken || m_socket != before) return;
    // A certificate that is not accepted will not be at the next attempt.
    if (first) return giveUp(taken.error().message);
    drop(taken.error().message);
}

void Connection::received(std::span<const std::byte> bytes) {
    m_failures = 0;
    std::vector<protocol::Message> messages;
    const Status fed = m_splitter->feed(bytes, messages);
    m_framed = m_framed || !messages.empty();
    const Socket* before = m_socket;
    for (protocol::Message& message : messages) {
        m_events.message(std::move(message));
        if (m_socket != before) return;  // the message ended this connection
    }
    if (!fed && !m_framed)
        return giveUp("this is not a Huestep server (" + fed.error().message + ")");
    if (!fed) return drop(fed.error().message);
    m_events.idle();
}

void Connection::send(const protocol::Message& message) {
    if (!m_socket || !m_socket->connected) return;
    if (!m_tls) return write(protocol::encode(message));
    if (!m_tls->established()) return;
    m_tls->send(protocol::encode(message));
    write(m_tls->takeOutput());
}

void Connection::write(std::vector<std::byte> bytes) {
    if (bytes.empty()) return;
    uv_stream_t* stream = asStream(&m_socket->tcp);
    auto write = std::make_unique<Write>();
    write->bytes = std::move(bytes);
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
    m_lookup.reset();
    letGo();
    ++m_failures;
    m_events.lost(why);
    if (!m_stopped) attemptLater();
}

void Connection::giveUp(const std::string& why) {
    if (!m_events.hopeless) return drop(why);
    m_lookup.reset();
    letGo();
    m_events.hopeless(why);
}

void Connection::letGo() {
    if (!m_socket) return;
    uv_timer_stop(&m_handles->timer);
    uv_timer_stop(&m_handles->beat);
    if (m_tls && m_socket->connected) {
        m_tls->close();
        const std::vector<std::byte> last = m_tls->takeOutput();
        uv_buf_t buffer = uv_buf_init(const_cast<char*>(reinterpret_cast<const char*>(last.data())),
                                      static_cast<unsigned>(last.size()));
        if (!last.empty()) uv_try_write(asStream(&m_socket->tcp), &buffer, 1);
    }
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
    uv_timer_start(&m_handles->timer, onTimer, backoffMs(m_failures, dice), 0);
}

void Connection::stop() {
    if (m_stopped) return;
    m_stopped = true;
    m_lookup.reset();
    letGo();
    std::exchange(m_handles, nullptr)->close();
}

}  // namespace huestep::client
