// Tickets and TLS as a user meets them: keys in files, a server that asks, clients that show.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "protocol/address.h"
#include "protocol/tls.h"
#include "tests/certificates.h"
#include "tests/socket_peer.h"
#include "tests/tools/process.h"

namespace huestep::test {
namespace {

mode_t modeOf(const std::string& path) {
    struct stat about {};
    EXPECT_EQ(::stat(path.c_str(), &about), 0) << path;
    return about.st_mode & 0777;
}

/// `huestep serve` of one session, on loopback, with a page.
class Served {
 public:
    explicit Served(const std::vector<std::string>& more) : m_process(words(m_folder, more)) {}

    /// What follows a word of its output, such as "listening on ".
    [[nodiscard]] std::string said(const std::string& word) const {
        Process::until(30.0, [&] {
            const std::string out = m_process.out();
            return out.find("page ") != std::string::npos && out.back() == '\n';
        });
        return after(m_process.out(), word);
    }
    [[nodiscard]] std::string address() const { return said("listening on "); }
    [[nodiscard]] std::uint16_t pagePort(const std::string& scheme) const {
        const std::string url = said("page " + scheme + "://");
        const auto address = protocol::parseAddress(url.substr(0, url.find('/')), false);
        EXPECT_TRUE(address.ok()) << url;
        return address ? address->port : std::uint16_t{0};
    }
    /// Its exit status.
    int stop() {
        m_process.send(SIGINT);
        return m_process.wait(20.0).value_or(-1);
    }
    [[nodiscard]] std::string log() const { return m_process.err(); }

 private:
    static std::vector<std::string> words(const TemporaryFolder& folder,
                                          const std::vector<std::string>& more) {
        std::vector<std::string> out = {huestepProgram, "serve",       "--listen", "127.0.0.1:0",
                                        "--web",        "127.0.0.1:0", "--data",   folder / "data",
                                        "--session",    "play=small"};
        out.insert(out.end(), more.begin(), more.end());
        return out;
    }
    TemporaryFolder m_folder;
    Process m_process;
};

Ended join(const std::string& address, const std::vector<std::string>& more) {
    std::vector<std::string> words = {"join",  address,  "--session", "play",
                                      "--bot", "wander", "--ticks",   "30"};
    words.insert(words.end(), more.begin(), more.end());
    return huestep(words);
}

TEST(TicketKeys, AreFilesOfTheirOwnerAloneAndAreNotOverwritten) {
    const TemporaryFolder folder;
    ASSERT_EQ(huestep({"ticket", "key", folder / "club"}).status, 0);
    EXPECT_EQ(modeOf(folder / "club.issuer.key"), 0600u);
    EXPECT_EQ(modeOf(folder / "club.host.key"), 0600u);
    const std::string before = textOf(folder / "club.issuer.key");
    const Ended again = huestep({"ticket", "key", folder / "club"});
    EXPECT_EQ(again.status, 2);
    EXPECT_NE(again.err.find("a key is not overwritten"), std::string::npos) << again.err;
    EXPECT_EQ(textOf(folder / "club.issuer.key"), before);

    ASSERT_EQ(huestep({"key", folder / "referee"}).status, 0);
    EXPECT_EQ(modeOf(folder / "referee.secret.key"), 0600u);
    EXPECT_EQ(modeOf(folder / "referee.public.key"), 0644u);
    EXPECT_EQ(textOf(folder / "referee.public.key").find("signing"), std::string::npos);
}

TEST(TicketKeys, ThatOthersMayReadAreRefused) {
    const TemporaryFolder folder;
    ASSERT_EQ(huestep({"ticket", "key", folder / "club"}).status, 0);
    ASSERT_EQ(::chmod((folder / "club.issuer.key").c_str(), 0640), 0);
    const Ended ended =
        huestep({"ticket", "issue", "--key", folder / "club.issuer.key", "--session", "play"});
    EXPECT_EQ(ended.status, 2);
    EXPECT_NE(ended.err.find("chmod 600"), std::string::npos) << ended.err;
    EXPECT_EQ(ended.out, "");
}

TEST(TicketKeys, OfAnIssuerDoNotBelongOnAHost) {
    const TemporaryFolder folder;
    ASSERT_EQ(huestep({"ticket", "key", folder / "club"}).status, 0);
    const auto refusal = [&](const std::string& key) {
        const Ended ended = huestep({"serve", "--listen", "127.0.0.1:0", "--data", folder / "data",
                                     "--session", "play=small", "--tickets", key});
        EXPECT_EQ(ended.status, 2);
        return ended.err;
    };
    EXPECT_NE(refusal(folder / "club.issuer.key").find("a host must not hold it"),
              std::string::npos);
    ASSERT_EQ(huestep({"key", folder / "referee"}).status, 0);
    EXPECT_NE(refusal(folder / "referee.public.key").find("one of them is missing"),
              std::string::npos);
    std::ofstream(folder / "noise.key") << "hello\n";
    EXPECT_NE(refusal(folder / "noise.key").find("noise.key: line 1: "), std::string::npos);
}

TEST(TicketFile, IsShownForWhatItIsAndSaysWhenItHasExpired) {
    const TemporaryFolder folder;
    ASSERT_EQ(huestep({"ticket", "key", folder / "club"}).status, 0);
    const auto issue = [&](const char* seconds) {
        const Ended issued =
            huestep({"ticket", "issue", "--key", folder / "club.issuer.key", "--session", "play",
                     "--player", "ann", "--role", "spectator", "--expires", seconds});
        EXPECT_EQ(issued.status, 0) << issued.err;
        std::ofstream(folder / "ticket") << issued.out;
    };
    const auto show = [&] {
        return huestep(
            {"ticket", "show", folder / "ticket", "--key", folder / "club.host.key", "--json"});
    };
    issue("600");
    const Ended good = show();
    EXPECT_EQ(good.status, 0) << good.err;
    const auto document = nlohmann::json::parse(good.out, nullptr, false);
    ASSERT_TRUE(document.is_object()) << good.out;
    EXPECT_EQ(document["session"], "play");
    EXPECT_EQ(document["player"], "ann");
    EXPECT_EQ(document["role"], "spectator");
    EXPECT_GT(document["seconds_left"].get<double>(), 500.0);
    issue("1");
    ASSERT_TRUE(Process::until(10.0, [&] { return show().status == 1; }));

    std::ofstream(folder / "ticket") << "no ticket!\n";
    EXPECT_NE(show().err.find("not a ticket as huestep ticket issue prints it"), std::string::npos);
    for (const auto& [words, what] : std::vector<std::pair<std::vector<std::string>, std::string>>{
             {{"ticket", "issue"}, "--key FILE is missing"},
             {{"ticket", "issue", "--key", folder / "club.issuer.key"},
              "--session NAME is missing"},
             {{"ticket", "issue", "--key", folder / "club.host.key", "--session", "play"},
              "these keys lack one"},
             {{"ticket", "sell"}, "'sell' is none of key, issue and show"}}) {
        const Ended ended = huestep(words);
        EXPECT_EQ(ended.status, 2);
        EXPECT_NE(ended.err.find(what), std::string::npos) << ended.err;
    }
}

TEST(TicketDoor, LetsInOnceAndSaysWhyItDoesNot) {
    const TemporaryFolder folder;
    ASSERT_EQ(huestep({"ticket", "key", folder / "club"}).status, 0);
    Served server({"--tickets", folder / "club.host.key"});
    const std::string address = server.address();
    const Ended issued = huestep({"ticket", "issue", "--key", folder / "club.issuer.key",
                                  "--session", "play", "--player", "ann"});
    ASSERT_EQ(issued.status, 0) << issued.err;
    std::ofstream(folder / "ticket") << issued.out;

    const Ended without = join(address, {});
    EXPECT_EQ(without.status, 2);
    EXPECT_NE(without.err.find("asks for a ticket"), std::string::npos) << without.err;
    const Ended with = join(address, {"--ticket", folder / "ticket"});
    EXPECT_EQ(with.status, 0) << with.err;
    EXPECT_NE(with.out.find("mismatches: 0"), std::string::npos) << with.out;
    const Ended again = join(address, {"--ticket", folder / "ticket"});
    EXPECT_EQ(again.status, 2);
    EXPECT_NE(again.err.find("this ticket was used already"), std::string::npos) << again.err;

    // Whoever watches the page needs one too.
    SocketEnd page = connectTo(server.pagePort("http"));
    const std::string ask =
        "GET /view?session=play HTTP/1.1\r\nHost: x\r\nConnection: Upgrade\r\n"
        "Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
        "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n";
    ASSERT_TRUE(page.send(std::as_bytes(std::span(ask))));
    ASSERT_TRUE(page.ready(10'000));
    const auto reply = page.read();
    const std::string head(reinterpret_cast<const char*>(reply.data()), reply.size());
    EXPECT_EQ(head.substr(8, 5), " 401 ") << head;
    EXPECT_EQ(server.stop(), 0) << server.log();
    EXPECT_EQ(textOf(folder / "ticket"), issued.out);
    EXPECT_EQ(server.log().find(issued.out.substr(0, 40)), std::string::npos) << "in the log";
}

TEST(Door, ThatOthersReachIsNotOpenByMistake) {
    const TemporaryFolder folder;
    const auto served = [&](std::vector<std::string> more) {
        std::vector<std::string> words = {"serve", "--data", folder / "data", "--session",
                                          "play=small"};
        words.insert(words.end(), more.begin(), more.end());
        return huestep(words);
    };
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"--listen", "0.0.0.0:0"},
          std::vector<std::string>{"--listen", "127.0.0.1:0", "--web", "0.0.0.0:0"}}) {
        const Ended ended = served(words);
        EXPECT_EQ(ended.status, 2);
        EXPECT_NE(ended.err.find("can be reached from other machines"), std::string::npos)
            << ended.err;
        EXPECT_EQ(ended.out, "");
    }
}

TEST(TlsDoor, SpeaksTlsWithThoseWhoTrustItAndWithNobodyElse) {
    const Certificates files, others;
    Served server({"--tls-cert", files.certificate(), "--tls-key", files.key()});
    const std::string address = server.address();
    const Ended good = join(address, {"--tls", "--tls-ca", files.authority()});
    EXPECT_EQ(good.status, 0) << good.err;
    EXPECT_NE(good.out.find("mismatches: 0"), std::string::npos) << good.out;
    const Ended stranger = join(address, {"--tls", "--tls-ca", others.authority()});
    EXPECT_EQ(stranger.status, 2);
    EXPECT_NE(stranger.err.find("the server's certificate is not accepted"), std::string::npos)
        << stranger.err;
    const Ended plain = join(address, {});
    EXPECT_EQ(plain.status, 2);
    EXPECT_NE(plain.err.find("this server speaks TLS: join it with --tls"), std::string::npos)
        << plain.err;

    // The page too.
    const auto context = protocol::TlsContext::forClient(files.authority());
    ASSERT_TRUE(context.ok());
    SocketEnd socket = connectTo(server.pagePort("https"));
    protocol::TlsStream stream(*context, "127.0.0.1");
    std::vector<std::byte> heard;
    bool asked = false;
    while (heard.empty()) {
        const std::vector<std::byte> out = stream.takeOutput();
        ASSERT_TRUE(out.empty() || socket.send(out));
        if (stream.established() && !std::exchange(asked, true)) {
            const std::string get = "GET / HTTP/1.1\r\nHost: x\r\n\r\n";
            stream.send(std::as_bytes(std::span(get)));
            continue;
        }
        ASSERT_TRUE(socket.ready(10'000));
        const auto bytes = socket.read();
        ASSERT_FALSE(bytes.empty());
        const Status taken = stream.receive(bytes, heard);
        ASSERT_TRUE(taken.ok()) << taken.error().message;
    }
    const std::string head(reinterpret_cast<const char*>(heard.data()), heard.size());
    EXPECT_EQ(head.substr(8, 5), " 302 ") << head;
    socket.close();
    EXPECT_EQ(server.stop(), 0) << server.log();
}

TEST(TlsDoor, OfAServerThatSpeaksNoneIsToldInASentence) {
    const Certificates files;
    Served server({});
    const Ended ended = join(server.address(), {"--tls", "--tls-ca", files.authority()});
    EXPECT_EQ(ended.status, 2);
    EXPECT_NE(ended.err.find("this is not TLS 1.3"), std::string::npos) << ended.err;
    EXPECT_EQ(server.stop(), 0) << server.log();
    EXPECT_NE(server.log().find("no --tickets: whoever uses this machine may play"),
              std::string::npos);
    const Ended half = huestep({"serve", "--session", "play=small", "--tls-key", files.key()});
    EXPECT_EQ(half.status, 2);
    EXPECT_NE(half.err.find("one is nothing without the other"), std::string::npos) << half.err;
}

}  // namespace
}  // namespace huestep::test
