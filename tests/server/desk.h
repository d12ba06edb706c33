/// A hub on a desk: one session, a journal that commits when told, and raw clients that say what a
/// test makes them say.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "protocol/frame.h"
#include "server/hub.h"
#include "tests/play_scene.h"

namespace huestep::server::test {

inline const protocol::Fingerprint deskPrint{11, 22, 33};

inline Scene deskScene() {
    return huestep::test::playScene();
}

inline SessionStart startOf(const Scene& scene, const std::string& name = "play") {
    Result<World> world = World::create(scene);
    EXPECT_TRUE(world.ok());
    SessionStart start{name, 1, ResumeKey{5, 6, 7}, nullptr, {}, std::move(*world)};
    start.base = takeSnapshot(start.world);
    return start;
}

/// Keeps what it is given; `Desk` commits it.
struct DeskJournal : JournalSink {
    std::vector<ClosedTick> closed;
    void write(const std::string&, ClosedTick tick) override { closed.push_back(std::move(tick)); }
};

class Desk {
 public:
    explicit Desk(Limits limits = {}, const Scene& scene = deskScene(),
                  std::optional<TicketRules> tickets = std::nullopt)
        : hub({limits,
               deskPrint,
               [this](Severity, const std::string& line) { log.push_back(line); },
               {},
               std::move(tickets)},
              journal) {
        Result<Session*> added = hub.add(startOf(scene), now);
        EXPECT_TRUE(added.ok());
        session = *added;
    }

    std::vector<std::string> log;
    DeskJournal journal;
    Instant now = 100 * second;
    Hub hub;
    Session* session = nullptr;
    bool committing = true;

    /// Closes ticks, 1/60 s apart.
    void tick(int count = 1) {
        for (int i = 0; i < count; ++i) {
            now += second / 60;
            hub.closeTick(*session, now);
            hub.work(*session);
            if (committing) hub.committed("play", session->tick());
        }
    }
    void wait(Instant time) {
        now += time;
        hub.advance(now);
    }
    [[nodiscard]] bool logged(const std::string& part) const {
        for (const std::string& line : log) {
            if (line.find(part) != std::string::npos) return true;
        }
        return false;
    }
};

/// One raw client.
class Peer {
 public:
    explicit Peer(Desk& desk, const std::string& from = "test")
        : m_desk(desk), m_id(desk.hub.accept(from, desk.now)) {}

    [[nodiscard]] bool accepted() const { return m_id.has_value(); }
    [[nodiscard]] ConnectionId id() const { return *m_id; }
    [[nodiscard]] const Connection* connection() const { return m_desk.hub.connection(*m_id); }

    void say(const protocol::Message& message) { bytes(protocol::encode(message)); }
    void bytes(std::span<const std::byte> raw) { m_desk.hub.receive(*m_id, raw, m_desk.now); }

    protocol::Hello hello() const {
        protocol::Hello hello;
        hello.fingerprint = deskPrint;
        hello.session = "play";
        return hello;
    }
    /// Says hello and is let in.
    protocol::Welcome join(std::optional<protocol::ResumeToken> resume = std::nullopt) {
        protocol::Hello greeting = hello();
        greeting.resume = resume;
        say(greeting);
        m_desk.tick(3);
        read();
        const auto* welcome = last<protocol::Welcome>();
        EXPECT_NE(welcome, nullptr);
        return welcome ? *welcome : protocol::Welcome{};
    }
    protocol::Welcome watch() {
        protocol::Hello greeting = hello();
        greeting.role = protocol::Role::Spectator;
        say(greeting);
        read();
        const auto* welcome = last<protocol::Welcome>();
        EXPECT_NE(welcome, nullptr);
        return welcome ? *welcome : protocol::Welcome{};
    }

    /// Takes everything the hub hands out; returns the bytes.
    std::size_t read() {
        std::size_t total = 0;
        while (SharedBytes bytes = m_desk.hub.next(*m_id, 0, m_desk.now)) {
            total += bytes->size();
            EXPECT_TRUE(m_splitter.feed(*bytes, heard).ok());
        }
        return total;
    }
    /// Takes what the hub hands out, and leaves it unsent: the transport of a reader that does not.
    std::size_t stall() {
        while (SharedBytes bytes = m_desk.hub.next(*m_id, m_stalled, m_desk.now)) {
            m_stalled += bytes->size();
            EXPECT_TRUE(m_splitter.feed(*bytes, heard).ok());
        }
        return m_stalled;
    }
    void unstall() { m_stalled = 0; }

    std::vector<protocol::Message> heard;
    template <class M>
    const M* last() const {
        for (auto it = heard.rbegin(); it != heard.rend(); ++it) {
            if (const auto* found = std::get_if<M>(&*it)) return found;
        }
        return nullptr;
    }
    template <class M>
    std::size_t count() const {
        std::size_t out = 0;
        for (const protocol::Message& message : heard) out += std::holds_alternative<M>(message);
        return out;
    }
    /// The reason of the Bye it heard; none: it heard none.
    std::optional<protocol::ByeReason> bye() {
        read();
        const auto* bye = last<protocol::Bye>();
        return bye ? std::optional(bye->reason) : std::nullopt;
    }

 private:
    Desk& m_desk;
    std::optional<ConnectionId> m_id;
    protocol::FrameSplitter m_splitter;
    std::size_t m_stalled = 0;
};

}  // namespace huestep::server::test
