/// A server made by hand out of plain sockets on 127.0.0.1: it says and withholds what a test
/// wants. Every wait is bounded.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

namespace huestep::test {

/// Programs of tests that send over sockets ignore SIGPIPE as `main` does.
inline const bool sigpipeIsIgnored = std::signal(SIGPIPE, SIG_IGN) != SIG_ERR;

inline sockaddr_in loopback(std::uint16_t port) {
    sockaddr_in out{};
    out.sin_family = AF_INET;
    out.sin_port = htons(port);
    out.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return out;
}

/// A socket that closes itself.
class SocketEnd {
 public:
    SocketEnd() = default;
    explicit SocketEnd(int handle) : m_handle(handle) {}
    ~SocketEnd() { close(); }
    SocketEnd(SocketEnd&& from) noexcept : m_handle(std::exchange(from.m_handle, -1)) {}
    SocketEnd& operator=(SocketEnd&& from) noexcept {
        std::swap(m_handle, from.m_handle);
        return *this;
    }

    [[nodiscard]] bool open() const { return m_handle >= 0; }
    [[nodiscard]] int handle() const { return m_handle; }
    void close() {
        if (open()) ::close(std::exchange(m_handle, -1));
    }
    /// Whether there is something to read, an end included, or somebody to accept.
    [[nodiscard]] bool ready(int milliseconds) const {
        pollfd asked{m_handle, POLLIN, 0};
        return ::poll(&asked, 1, milliseconds) > 0;
    }
    /// What has arrived; empty: the other side closed.
    [[nodiscard]] std::span<const std::byte> read() {
        const ssize_t count = ::recv(m_handle, m_input.data(), m_input.size(), 0);
        return {m_input.data(), count > 0 ? static_cast<std::size_t>(count) : 0};
    }
    bool send(std::span<const std::byte> bytes) const {
        const ssize_t sent = ::send(m_handle, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        return sent == static_cast<ssize_t>(bytes.size());
    }

 private:
    int m_handle = -1;
    std::array<std::byte, 65536> m_input{};
};

/// Connects to a port of this machine.
inline SocketEnd connectTo(std::uint16_t port) {
    SocketEnd end(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    const sockaddr_in to = loopback(port);
    const auto* address = reinterpret_cast<const sockaddr*>(&to);
    if (::connect(end.handle(), address, sizeof to) != 0) end.close();
    return end;
}

/// Listens on a free port.
class ListeningSocket {
 public:
    ListeningSocket() : m_end(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        sockaddr_in at = loopback(0);
        socklen_t size = sizeof at;
        auto* address = reinterpret_cast<sockaddr*>(&at);
        const bool listens = ::bind(m_end.handle(), address, size) == 0 &&
                             ::listen(m_end.handle(), 16) == 0 &&
                             ::getsockname(m_end.handle(), address, &size) == 0;
        if (listens) m_port = ntohs(at.sin_port);
    }
    [[nodiscard]] std::uint16_t port() const { return m_port; }  ///< 0: it does not listen
    [[nodiscard]] std::string address() const { return "127.0.0.1:" + std::to_string(m_port); }
    [[nodiscard]] bool ready(int milliseconds) const { return m_end.ready(milliseconds); }
    [[nodiscard]] SocketEnd accept() const {
        return SocketEnd(::accept4(m_end.handle(), nullptr, nullptr, SOCK_CLOEXEC));
    }
    void close() { m_end.close(); }

 private:
    SocketEnd m_end;
    std::uint16_t m_port = 0;
};

}  // namespace huestep::test
