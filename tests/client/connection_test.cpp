// The client's connection and life on real sockets, against a server made by hand.
#include "client/connection.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstring>
#include <future>
#include <thread>

#include "client/player.h"
#include "protocol/frame.h"
#include "tests/socket_peer.h"

namespace huestep::client {
namespace {

using test::ListeningSocket;
using test::SocketEnd;

TEST(Backoff, DoublesUpToTwoSecondsAndIsSpread) {
    EXPECT_EQ(backoffMs(0, 0), 0u);
    EXPECT_EQ(backoffMs(1, 0), 50u);
    EXPECT_EQ(backoffMs(2, 0), 100u);
    EXPECT_EQ(backoffMs(4, 0), 400u);
    for (const std::uint32_t failures : {7u, 11u, 1'000u, 4'000'000'000u}) {
        EXPECT_EQ(backoffMs(failures, 0), 2'000u);
        EXPECT_GE(backoffMs(failures, 1'023), 1'500u);
        EXPECT_LT(backoffMs(failures, 1'023), 1'510u);
    }
}

TEST(Pulse, AsksSeveralTimesBeforeItGivesUpAndBytesStartItAnew) {
    Pulse pulse;
    const auto asksUntilSilent = [&pulse] {
        int asked = 0;
        for (int beats = 1;; ++beats) {
            const Pulse::Beat beat = pulse.beat();
            if (beat == Pulse::Beat::Silent) return std::pair(asked, beats);
            asked += beat == Pulse::Beat::Ask;
        }
    };
    EXPECT_EQ(asksUntilSilent(), std::pair(4, 20));
    pulse.heard();
    EXPECT_EQ(asksUntilSilent(), std::pair(4, 20));
    for (int i = 0; i < 1'000; ++i) {
        pulse.heard();
        for (int quiet = 0; quiet < 19; ++quiet) EXPECT_NE(pulse.beat(), Pulse::Beat::Silent);
    }
}

SocketAddresses addressesOf(const std::vector<std::uint16_t>& ports) {
    SocketAddresses out;
    for (const std::uint16_t port : ports) {
        const sockaddr_in address = test::loopback(port);
        std::memcpy(&out.emplace_back(), &address, sizeof address);
    }
    return out;
}

/// A port at which nobody listens.
std::uint16_t deadPort() {
    ListeningSocket socket;
    const std::uint16_t port = socket.port();
    socket.close();
    return port;
}

PlayerConfig playerFor(const std::string& address) {
    PlayerConfig config;
    config.address = address;
    config.session = "play";
    config.handleSignals = false;
    config.silenceSeconds = 0.4;
    config.connectSeconds = 60.0;
    return config;
}

/// A client on a thread of its own.
class Playing {
 public:
    explicit Playing(PlayerConfig config) {
        config.stop = &m_stop;
        m_result = std::async(std::launch::async, [config = std::move(config)]() mutable {
            return play(std::move(config));
        });
    }
    ~Playing() { m_stop = true; }
    Result<Statistics> stop() {
        m_stop = true;
        return result();
    }
    Result<Statistics> result() { return m_result.get(); }
    [[nodiscard]] bool ends(int seconds) const {
        return m_result.wait_for(std::chrono::seconds(seconds)) == std::future_status::ready;
    }

 private:
    std::atomic<bool> m_stop{false};
    std::future<Result<Statistics>> m_result;
};

/// Reads messages from a client until `wanted` has come; false: it does not come, or the client
/// goes.
template <class Wanted>
bool readUntil(SocketEnd& peer, Wanted wanted) {
    protocol::FrameSplitter splitter;
    while (peer.ready(20'000)) {
        const std::span<const std::byte> bytes = peer.read();
        if (bytes.empty()) return false;
        std::vector<protocol::Message> messages;
        if (!splitter.feed(bytes, messages)) return false;
        for (const protocol::Message& message : messages) {
            if (wanted(message)) return true;
        }
    }
    return false;
}

TEST(Silence, AServerThatTakesTheConnectionAndSaysNothingIsGivenUpAndTriedAnew) {
    const ListeningSocket listening;
    Playing playing(playerFor(listening.address()));
    SocketEnd first, second;
    ASSERT_TRUE(listening.ready(20'000));
    first = listening.accept();
    ASSERT_TRUE(listening.ready(20'000)) << "it waits for ever";
    second = listening.accept();
    bool greeted = false, asked = false;
    readUntil(first, [&](const protocol::Message& message) {
        greeted = greeted || std::holds_alternative<protocol::Hello>(message);
        asked = asked || message == protocol::Message(protocol::Ping{1, false});
        return false;
    });
    EXPECT_TRUE(greeted);
    EXPECT_TRUE(asked) << "given up without having been asked";
    EXPECT_FALSE(playing.stop().ok()) << "it never got in";
}

TEST(Silence, WhoNeverGetsAnAnswerIsToldThatTheServerIsSilent) {
    const ListeningSocket listening;
    PlayerConfig config = playerFor(listening.address());
    config.silenceSeconds = 0.1;
    config.connectSeconds = 1.0;
    const Result<Statistics> result = play(std::move(config));
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().message,
              "no connection to " + listening.address() + ": the server is silent");
}

TEST(Silence, AServerThatAnswersPingsButSendsNoStateIsGivenUpToo) {
    const ListeningSocket listening;
    Playing playing(playerFor(listening.address()));
    ASSERT_TRUE(listening.ready(20'000));
    SocketEnd peer = listening.accept();
    protocol::Welcome welcome;
    welcome.session = "play";
    welcome.player = 1;
    bool welcomed = false, answered = false;
    readUntil(peer, [&](const protocol::Message& message) {
        if (std::holds_alternative<protocol::Hello>(message)) {
            welcomed = peer.send(protocol::encode(welcome));
        }
        const auto* ping = std::get_if<protocol::Ping>(&message);
        if (ping && !ping->reply) {
            answered = peer.send(protocol::encode(protocol::Ping{ping->nonce, true}));
        }
        return false;
    });
    EXPECT_TRUE(welcomed);
    EXPECT_TRUE(answered);
    EXPECT_TRUE(listening.ready(20'000)) << "it waits for ever";
    EXPECT_TRUE(playing.stop().ok());
}

TEST(Attempts, APeerWhoseFirstBytesAreNoFrameIsNotTriedAgain) {
    const ListeningSocket listening;
    Playing playing(playerFor(listening.address()));
    ASSERT_TRUE(listening.ready(20'000));
    const SocketEnd peer = listening.accept();
    const std::string banner = "SSH-2.0-OpenSSH_9.2p1 Debian\r\n";
    ASSERT_TRUE(peer.send(std::as_bytes(std::span(banner))));
    ASSERT_TRUE(playing.ends(20)) << "of the 60 s it may try";
    const Result<Statistics> result = playing.result();
    ASSERT_FALSE(result.ok());
    EXPECT_NE(result.error().message.find(listening.address() + ": this is not a Huestep server"),
              std::string::npos)
        << result.error().message;
    EXPECT_FALSE(listening.ready(0)) << "it came again";
}

TEST(Attempts, TheFirstFailureIsToldWithTheTimeThatIsLeft) {
    PlayerConfig config = playerFor("127.0.0.1:" + std::to_string(deadPort()));
    config.connectSeconds = 1.0;
    std::vector<std::string> notices;
    config.onNotice = [&notices](const std::string& sentence) { notices.push_back(sentence); };
    const std::string address = config.address;
    const Result<Statistics> result = play(std::move(config));
    ASSERT_FALSE(result.ok());
    ASSERT_EQ(notices.size(), 1u) << "once, however many attempts follow";
    EXPECT_EQ(notices.front(),
              "no connection to " + address + ": connection refused; trying again for 1 s");
}

TEST(Lookup, EveryAddressOfANameIsTriedInTurnWithinOneAttempt) {
    const ListeningSocket listening;
    PlayerConfig config = playerFor("somewhere:7777");
    std::atomic<int> asked{0};
    config.resolve = [&asked, found = addressesOf({deadPort(), deadPort(), listening.port()})](
                         const protocol::Address& address) -> Result<SocketAddresses> {
        EXPECT_EQ(address, (protocol::Address{"somewhere", 7777}));
        ++asked;
        return found;
    };
    Playing playing(std::move(config));
    ASSERT_TRUE(listening.ready(20'000)) << "only the first address is tried";
    SocketEnd peer = listening.accept();
    EXPECT_TRUE(readUntil(peer, [](const protocol::Message& message) {
        return std::holds_alternative<protocol::Hello>(message);
    }));
    EXPECT_EQ(asked, 1);
    EXPECT_FALSE(playing.stop().ok()) << "it never got in";
}

TEST(Lookup, ANameThatNobodyKnowsIsNotAskedForAgain) {
    PlayerConfig config = playerFor("somewhere:7777");
    int asked = 0;
    config.resolve = [&asked](const protocol::Address&) -> Result<SocketAddresses> {
        ++asked;
        return Error{"nobody knows this name"};
    };
    const Result<Statistics> result = play(std::move(config));
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().message, "no connection to somewhere:7777: nobody knows this name");
    EXPECT_EQ(asked, 1);
}

TEST(Lookup, TheSystemKnowsNumbersAndTheirPort) {
    const Result<SocketAddresses> found = askSystem({"127.0.0.1", 7777});
    ASSERT_TRUE(found.ok()) << found.error().message;
    ASSERT_EQ(found->size(), 1u);
    const sockaddr_in wanted = test::loopback(7777);
    EXPECT_EQ(std::memcmp(&found->front(), &wanted, sizeof wanted), 0);
    EXPECT_TRUE(askSystem({"::1", 1}).ok());
}

/// A resolver that does not come back before it is let go, as a name server that is down.
struct Stuck {
    std::shared_ptr<std::promise<void>> entered = std::make_shared<std::promise<void>>();
    std::shared_ptr<std::promise<void>> letGo = std::make_shared<std::promise<void>>();
    Resolve resolve() const {
        return [entered = entered, wait = letGo->get_future().share()](
                   const protocol::Address&) -> Result<SocketAddresses> {
            entered->set_value();
            wait.wait();
            return Error{"too late"};
        };
    }
};

TEST(Lookup, AClientThatIsToldToStopDoesNotWaitForTheResolver) {
    const Stuck stuck;
    PlayerConfig config = playerFor("somewhere:7777");
    config.resolve = stuck.resolve();
    Playing playing(std::move(config));
    stuck.entered->get_future().wait();
    auto stopped = std::async(std::launch::async, [&] { return playing.stop(); });
    EXPECT_EQ(stopped.wait_for(std::chrono::seconds(20)), std::future_status::ready);
    stuck.letGo->set_value();
    EXPECT_FALSE(stopped.get().ok()) << "it never got in";
}

TEST(Lookup, CtrlCDoesNotWaitForTheResolver) {
    const Stuck stuck;
    PlayerConfig config = playerFor("somewhere:7777");
    config.resolve = stuck.resolve();
    config.handleSignals = true;
    Playing playing(std::move(config));
    stuck.entered->get_future().wait();
    ASSERT_EQ(::raise(SIGINT), 0);
    EXPECT_TRUE(playing.ends(20));
    stuck.letGo->set_value();
    EXPECT_FALSE(playing.result().ok()) << "it never got in";
}

TEST(Sigpipe, SendingToAServerThatIsGoneEndsTheConnectionAndNotTheProcess) {
    ASSERT_TRUE(test::sigpipeIsIgnored);
    const ListeningSocket listening;
    uv_loop_t loop;
    ASSERT_EQ(uv_loop_init(&loop), 0);
    Destination to;
    to.address = {"127.0.0.1", listening.port()};
    bool connected = false;
    std::string why;
    Connection* self = nullptr;
    Connection connection(loop, std::move(to),
                          {[&] { connected = true; }, [](const protocol::Message&) {}, [] {},
                           [&](const std::string& sentence) {
                               why = sentence;
                               self->stop();
                           }});
    self = &connection;
    connection.start();
    while (!connected && why.empty()) uv_run(&loop, UV_RUN_ONCE);
    ASSERT_TRUE(connected) << why;
    {
        SocketEnd peer = listening.accept();
        connection.send(protocol::Ping{1, false});
        EXPECT_TRUE(peer.ready(20'000));
    }  // closed with bytes unread: a reset comes back
    for (std::uint64_t i = 2; i < 100 && why.empty(); ++i) {
        connection.send(protocol::Ping{i, false});
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    uv_run(&loop, UV_RUN_DEFAULT);
    EXPECT_NE(why, "");
    EXPECT_EQ(uv_loop_close(&loop), 0);
}

}  // namespace
}  // namespace huestep::client
