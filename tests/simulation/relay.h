/// A line between a client and a server on 127.0.0.1 that may die without a word.
#pragma once

#include <atomic>
#include <thread>

#include "tests/socket_peer.h"

namespace huestep::test {

/// Takes one connection after the other and carries its bytes both ways.
class Relay {
 public:
    explicit Relay(std::uint16_t serverPort)
        : m_serverPort(serverPort), m_thread([this] { run(); }) {}
    ~Relay() {
        m_stop = true;
        m_thread.join();
    }
    Relay(const Relay&) = delete;
    Relay& operator=(const Relay&) = delete;

    [[nodiscard]] std::string address() const { return m_listening.address(); }
    [[nodiscard]] int connections() const { return m_connections; }
    /// From now on this connection carries nothing, and does not end; the next one is well.
    void fallSilent() { m_silent = m_connections.load(); }

 private:
    void run() {
        while (!m_stop) {
            if (!m_listening.ready(20)) continue;
            SocketEnd client = m_listening.accept();
            SocketEnd server = connectTo(m_serverPort);
            ++m_connections;
            bool whole = true;
            while (!m_stop && whole) {
                if (m_silent == m_connections) {
                    // What comes is taken and lost; only the client's own end ends it.
                    if (client.ready(20)) whole = !client.read().empty();
                } else {
                    whole = carry(client, server, 2) && carry(server, client, 2);
                }
            }
        }
    }
    static bool carry(SocketEnd& from, const SocketEnd& to, int milliseconds) {
        if (!from.ready(milliseconds)) return true;
        const std::span<const std::byte> bytes = from.read();
        return !bytes.empty() && to.send(bytes);
    }

    ListeningSocket m_listening;
    std::uint16_t m_serverPort;
    std::atomic<int> m_connections{0};
    std::atomic<int> m_silent{0};
    std::atomic<bool> m_stop{false};
    std::thread m_thread;
};

}  // namespace huestep::test
