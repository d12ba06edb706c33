#include "server/sockets.h"

#include <cassert>
#include <utility>
#include <vector>

#include "protocol/codec.h"
#include "server/listening.h"

namespace huestep::server {

struct Sockets::Socket {
    uv_tcp_t tcp{};
    Sockets* owner = nullptr;
    ConnectionId id = 0;
    std::optional<protocol::TlsStream> tls{};
    bool closing = false;
    bool shutDown = false;
    uv_shutdown_t shutdown{};
};

/// One write and the bytes it shares with other writes.
struct Sockets::Write {
    uv_write_t request{};
    Socket* socket = nullptr;
    std::vector<SharedBytes> bytes;
};

Sockets::Sockets(uv_loop_t& loop, Hub& hub, const protocol::TlsContext* tls)
    : m_loop(loop),
      m_hub(hub),
      m_tls(tls),
      m_turns(loop, hub.limits().acceptsAtOnce, [this] { accept(); }) {}

Sockets::~Sockets() {
    assert(m_sockets.empty());
    assert(!m_listener);
}

Status Sockets::listen(const protocol::Address& address) {
    Result<Listening> listening =
        listenOn(m_loop, address, m_hub.limits().backlog, onConnection, this);
    if (!listening) {
        return Error{"cannot listen on " + protocol::toText(address) + ": " +
                     listening.error().message};
    }
    m_listener = listening->handle;
    m_bound = std::move(listening->bound);
    m_turns.start();
    return Done{};
}

void Sockets::stopListening() {
    m_turns.close();
    if (m_listener) closeAndFree(std::exchange(m_listener, nullptr));
}

void Sockets::onConnection(uv_stream_t* listener, int status) {
    if (status == 0) static_cast<Sockets*>(listener->data)->m_turns.connection();
}

void Sockets::accept() {
    auto socket = std::make_unique<Socket>();
    socket->owner = this;
    [[maybe_unused]] const int made = uv_tcp_init(&m_loop, &socket->tcp);
    assert(made == 0);  // it makes no socket yet, so there is nothing that could fail
    socket->tcp.data = socket.get();
    std::optional<ConnectionId> id;
    if (uv_accept(asStream(m_listener), asStream(&socket->tcp)) == 0) {
        sockaddr_storage storage{};
        int length = sizeof storage;
        uv_tcp_getpeername(&socket->tcp, reinterpret_cast<sockaddr*>(&storage), &length);
        id = m_hub.accept(protocol::toText(addressOf(storage)), uv_hrtime());
    }
    if (!id) {
        // Over a limit: closed without a word, the cheapest answer there is.
        uv_close(asHandle(&socket.release()->tcp),
                 [](uv_handle_t* handle) { delete static_cast<Socket*>(handle->data); });
        return;
    }
    socket->id = *id;
    if (m_tls) socket->tls.emplace(*m_tls);
    start(std::move(socket));
    for (const ConnectionId displaced : m_hub.displaced()) {
        const auto found = m_sockets.find(displaced);
        if (found != m_sockets.end()) close(*found->second);
    }
}

void Sockets::start(std::unique_ptr<Socket> socket) {
    int sendBuffer = m_hub.limits().sendBufferBytes;
    uv_send_buffer_size(asHandle(&socket->tcp), &sendBuffer);
    uv_tcp_nodelay(&socket->tcp, 1);
    m_sockets.emplace(socket->id, socket.get());
    uv_read_start(asStream(&socket.release()->tcp), onAlloc, onRead);
}

void Sockets::onAlloc(uv_handle_t* handle, std::size_t, uv_buf_t* buffer) {
    Sockets& owner = *static_cast<Socket*>(handle->data)->owner;
    *buffer = uv_buf_init(owner.m_input.data(), static_cast<unsigned>(owner.m_input.size()));
}

void Sockets::onRead(uv_stream_t* stream, ssize_t count, const uv_buf_t* buffer) {
    Socket& socket = *static_cast<Socket*>(stream->data);
    Sockets& owner = *socket.owner;
    if (count < 0) return owner.close(socket);
    const std::span<const char> bytes(buffer->base, static_cast<std::size_t>(count));
    owner.received(socket, std::as_bytes(bytes));
    if (socket.closing) return;
    if (!owner.m_hub.reads(socket.id)) uv_read_stop(stream);
    owner.flush(socket);
}

void Sockets::flush() {
    // A flush may close a socket, which takes it out of the map.
    for (auto next = m_sockets.begin(); next != m_sockets.end();) flush(*(next++)->second);
}

void Sockets::flush(const Session& session) {
    for (auto next = m_sockets.begin(); next != m_sockets.end();) {
        Socket& socket = *(next++)->second;
        const Connection* connection = m_hub.connection(socket.id);
        if (connection && connection->session() == &session) flush(socket);
    }
}

void Sockets::received(Socket& socket, std::span<const std::byte> bytes) {
    if (!socket.tls) return m_hub.receive(socket.id, bytes, uv_hrtime());
    std::vector<std::byte> plain;
    const Status taken = socket.tls->receive(bytes, plain);
    if (!plain.empty()) m_hub.receive(socket.id, plain, uv_hrtime());
    if (taken) return;
    m_hub.refusedByTls(socket.id, taken.error().message, uv_hrtime());
    // Its alert goes out as far as it goes at once. Where OpenSSL has nothing to say, the other end
    // did not begin with TLS, and may be a client that was not told to.
    std::vector<std::byte> alert = socket.tls->takeOutput();
    if (alert.empty()) {
        alert = protocol::encode(protocol::Bye{
            protocol::ByeReason::BadMessage, "this server speaks TLS: join it with --tls", false});
    }
    uv_buf_t buffer =
        uv_buf_init(reinterpret_cast<char*>(alert.data()), static_cast<unsigned>(alert.size()));
    uv_try_write(asStream(&socket.tcp), &buffer, 1);
    close(socket);
}

void Sockets::flush(Socket& socket) {
    if (socket.closing) return;
    const Instant now = uv_hrtime();
    std::size_t unsent = uv_stream_get_write_queue_size(asStream(&socket.tcp));
    std::vector<SharedBytes> out;
    while (!socket.tls || socket.tls->established()) {
        SharedBytes bytes = m_hub.next(socket.id, unsent, now);
        if (!bytes) break;
        unsent += bytes->size();
        if (socket.tls) {
            socket.tls->send(*bytes);
        } else {
            out.push_back(std::move(bytes));
        }
    }
    if (socket.tls) {
        auto sealed = std::make_shared<const std::vector<std::byte>>(socket.tls->takeOutput());
        if (!sealed->empty()) out.push_back(std::move(sealed));
    }
    if (!out.empty()) write(socket, std::move(out));
    if (socket.closing) return;
    if (m_hub.overdue(socket.id, now)) return close(socket);
    if (m_hub.finished(socket.id) && !socket.shutDown) sayTheEnd(socket);
}

void Sockets::write(Socket& socket, std::vector<SharedBytes> bytes) {
    auto write = std::make_unique<Write>();
    write->socket = &socket;
    write->request.data = write.get();
    write->bytes = std::move(bytes);
    std::vector<uv_buf_t> buffers;
    for (const SharedBytes& each : write->bytes) {
        // libuv does not write through the pointer; its buffers are shared with reads.
        auto* data = const_cast<char*>(reinterpret_cast<const char*>(each->data()));
        buffers.push_back(uv_buf_init(data, static_cast<unsigned>(each->size())));
    }
    const int status = uv_write(&write->request, asStream(&socket.tcp), buffers.data(),
                                static_cast<unsigned>(buffers.size()), onWritten);
    if (status != 0) return close(socket);
    static_cast<void>(write.release());  // `onWritten` takes it back
}

/// Half closed only: closing at once could drop the Bye with whatever the client still sends.
void Sockets::sayTheEnd(Socket& socket) {
    socket.shutDown = true;
    if (socket.tls) {
        socket.tls->close();
        auto last = std::make_shared<const std::vector<std::byte>>(socket.tls->takeOutput());
        if (!last->empty()) write(socket, {std::move(last)});
    }
    if (!socket.closing) uv_shutdown(&socket.shutdown, asStream(&socket.tcp), nullptr);
}

void Sockets::onWritten(uv_write_t* request, int status) {
    const std::unique_ptr<Write> write(static_cast<Write*>(request->data));
    Socket& socket = *write->socket;
    if (status != 0) return socket.owner->close(socket);
    socket.owner->flush(socket);
}

void Sockets::close(Socket& socket) {
    if (socket.closing) return;
    socket.closing = true;
    m_sockets.erase(socket.id);
    m_hub.closed(socket.id, uv_hrtime());
    uv_close(asHandle(&socket.tcp),
             [](uv_handle_t* handle) { delete static_cast<Socket*>(handle->data); });
}

void Sockets::closeAll() {
    while (!m_sockets.empty()) close(*m_sockets.begin()->second);
}

}  // namespace huestep::server
