/// The handshake and what follows as a state machine: a hub with a session that asks for no
/// tickets, one client that plays by the rules, and up to four whose every move the input decides.
///
/// The input is a list of moves, each a byte and what it needs. Frames get their checksum here, as
/// it would keep a fuzzer out. What is promised whatever they do: the session closes every tick,
/// the good client gets every frame, the server says nothing that is not a message, and all that
/// was refused is gone in the end.
#include <array>
#include <cstring>
#include <optional>

#include "protocol/frame.h"
#include "server/hub.h"
#include "tests/fuzz/target.h"
#include "tests/play_scene.h"

namespace {

using namespace huestep;
using namespace huestep::server;
using fuzz::require;

const protocol::Fingerprint print{1, 2, 3};

struct Nowhere : JournalSink {
    void write(const std::string&, ClosedTick) override {}
};

SessionStart start() {
    auto world = World::create(test::playScene());
    require(world.ok(), "the scene is a world");
    SessionStart out{"play", 1, ResumeKey{1}, nullptr, {}, std::move(*world)};
    out.base = takeSnapshot(out.world);
    return out;
}

Limits tight() {
    Limits limits;
    limits.connections = 6;
    limits.halfOpen = 3;
    limits.recentFrames = 40;
    limits.keyframeTicks = 10;
    limits.lowWater = 4'096;
    limits.clientBytes = 16'384;
    return limits;
}

class Play {
 public:
    Play() : m_hub({tight(), print, nullptr, {}}, m_journal) {
        require(m_hub.add(start(), m_now).ok(), "a session opens");
        m_session = m_hub.sessions().front();
        m_good.id = m_hub.accept("192.0.2.1:1", m_now);
        hello(m_good, 0);
        tick();
        tick();
    }

    void run(std::span<const std::byte> input) {
        m_input = input;
        for (int moves = 0; !m_input.empty() && moves < 400; ++moves) move();
        for (int i = 0; i < 60 * 30; i += 1) {
            if (i % 60 == 0) say(m_good, protocol::Ping{1, true});
            tick();
        }
        require(m_hub.connections().size() == 1, "who says nothing more is gone in the end");
    }

 private:
    struct Client {
        std::optional<ConnectionId> id;
        protocol::FrameSplitter splitter{nullptr, nullptr};
        std::size_t unsent = 0;
        std::uint64_t frames = 0;
        std::optional<protocol::ResumeToken> token;
    };

    std::uint8_t byte() {
        if (m_input.empty()) return 0;
        const auto value = std::to_integer<std::uint8_t>(m_input.front());
        m_input = m_input.subspan(1);
        return value;
    }

    void move() {
        const std::uint8_t what = byte();
        Client& client = m_clients[what % 4];
        switch (what / 4 % 8) {
            case 0:
                if (client.id) m_hub.closed(*client.id, m_now);
                client = Client{};
                client.id = m_hub.accept("198.51.100." + std::to_string(what % 4) + ":1", m_now);
                return;
            case 1:
                return hello(client, byte());
            case 2:
                return frame(client);
            case 3:
                return raw(client);
            case 4:
                for (int i = byte() % 64; i >= 0; --i) tick();
                return;
            case 5:
                client.unsent = byte() * 256u;
                return read(client);
            case 6:
                m_now += byte() % 50 * 100 * millisecond;
                say(m_good, protocol::Ping{1, true});
                return m_hub.advance(m_now);
            default:
                say(client, protocol::HashQuery{m_session->tick() - byte() % 8});
                return say(client, protocol::SnapshotRequest{m_session->tick() - byte() % 8});
        }
    }

    void hello(Client& client, std::uint8_t how) {
        protocol::Hello hello;
        hello.fingerprint = print;
        hello.session = "play";
        hello.role = (how & 1) != 0 ? protocol::Role::Spectator : protocol::Role::Player;
        if ((how & 2) != 0) hello.resume = m_clients[how / 4 % 4].token;
        if ((how & 16) != 0) hello.haveTick = m_session->tick() - how / 32;
        say(client, hello);
    }
    void say(Client& client, const protocol::Message& message) {
        if (client.id) m_hub.receive(*client.id, protocol::encode(message), m_now);
    }
    /// A frame with a type and a payload of the input's.
    void frame(Client& client) {
        const std::size_t size = std::min<std::size_t>(byte() * 8u, m_input.size() / 8 * 8);
        const auto type = static_cast<protocol::MessageType>(byte() % 16);
        std::vector<std::byte> out(protocol::headerBytes + std::min(size, m_input.size() / 8 * 8));
        std::memcpy(out.data() + protocol::headerBytes, m_input.data(),
                    out.size() - protocol::headerBytes);
        m_input = m_input.subspan(out.size() - protocol::headerBytes);
        protocol::writeHeader(type, out);
        if (client.id) m_hub.receive(*client.id, out, m_now);
    }
    void raw(Client& client) {
        const std::size_t size = std::min<std::size_t>(byte(), m_input.size());
        if (client.id) m_hub.receive(*client.id, m_input.first(size), m_now);
        m_input = m_input.subspan(size);
    }

    void read(Client& client) {
        if (!client.id) return;
        while (const SharedBytes bytes = m_hub.next(*client.id, client.unsent, m_now)) {
            if (client.unsent > 0) client.unsent += bytes->size();
            std::vector<protocol::Message> messages;
            require(client.splitter.feed(*bytes, messages).ok(), "a server speaks the protocol");
            for (const protocol::Message& message : messages) {
                if (const auto* welcome = std::get_if<protocol::Welcome>(&message)) {
                    client.token = welcome->resume;
                }
                client.frames += std::holds_alternative<protocol::Frame>(message) ? 1u : 0u;
            }
        }
    }

    void tick() {
        m_now += second / 60;
        const std::uint64_t before = m_session->tick();
        require(m_hub.closeTick(*m_session, m_now), "a tick closes");
        require(m_session->tick() == before + 1, "by one");
        m_hub.work(*m_session);
        m_hub.committed("play", m_session->tick());
        m_hub.advance(m_now);
        const std::uint64_t frames = m_good.frames;
        read(m_good);
        require(before < 4 || m_good.frames == frames + 1, "the good client has its frame");
        if (m_session->tick() % 30 == 0) say(m_good, protocol::Ping{1, true});
        for (const ConnectionId id : m_hub.displaced()) m_hub.closed(id, m_now);
        for (const ConnectionId id : m_hub.connections()) {
            if (m_hub.overdue(id, m_now)) m_hub.closed(id, m_now);
        }
        require(m_hub.connections().size() <= tight().connections, "connections have a limit");
    }

    Nowhere m_journal;
    Hub m_hub;
    Session* m_session = nullptr;
    Instant m_now = 100 * second;
    Client m_good;
    std::array<Client, 4> m_clients;
    std::span<const std::byte> m_input;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Play play;
    play.run(fuzz::bytesOf(data, size));
    return 0;
}
