// The TLS layer between its own two ends: what passes, and what does not get through.
#include "protocol/tls.h"

#include <gtest/gtest.h>
#include <openssl/ssl.h>

#include <array>
#include <cstring>

#include "tests/certificates.h"

namespace huestep::protocol {
namespace {

using test::Certificates;

TlsContext serverOf(const Certificates& files) {
    Result<TlsContext> context = TlsContext::forServer(files.certificate(), files.key());
    EXPECT_TRUE(context.ok()) << (context ? "" : context.error().message);
    return std::move(context).value();
}
TlsContext clientOf(const std::string& authority) {
    Result<TlsContext> context = TlsContext::forClient(authority);
    EXPECT_TRUE(context.ok()) << (context ? "" : context.error().message);
    return std::move(context).value();
}

/// Two ends that speak with each other, in pieces of so many bytes.
struct Line {
    Line(const Certificates& files, const std::string& name, const std::string& authority)
        : serverContext(serverOf(files)),
          clientContext(clientOf(authority)),
          server(serverContext),
          client(clientContext, name) {}

    /// Carries bytes there and back until neither has more. The first sentence of a failure.
    std::string carry(std::size_t piece) {
        for (int round = 0; round < 20; ++round) {
            if (std::string why = pass(client, server, atServer, piece); !why.empty()) return why;
            if (std::string why = pass(server, client, atClient, piece); !why.empty()) return why;
        }
        return {};
    }
    static std::string pass(TlsStream& from, TlsStream& to, std::vector<std::byte>& plain,
                            std::size_t piece) {
        const std::vector<std::byte> wire = from.takeOutput();
        for (std::size_t at = 0; at < wire.size(); at += piece) {
            const auto part = std::span(wire).subspan(at, std::min(piece, wire.size() - at));
            const Status taken = to.receive(part, plain);
            if (!taken) return taken.error().message;
        }
        return {};
    }

    TlsContext serverContext;
    TlsContext clientContext;
    TlsStream server;
    TlsStream client;
    std::vector<std::byte> atServer;
    std::vector<std::byte> atClient;
};

std::vector<std::byte> sample(std::size_t size, unsigned seed) {
    std::vector<std::byte> out(size);
    for (std::size_t i = 0; i < size; ++i) out[i] = static_cast<std::byte>(i * 31 + seed + i / 251);
    return out;
}

TEST(Tls, CarriesBytesBothWaysHoweverTheyAreCut) {
    const Certificates files;
    for (const std::size_t piece : {1ul, 7ul, 1'000ul, 1'000'000ul}) {
        Line line(files, "localhost", files.authority());
        ASSERT_EQ(line.carry(piece), "") << piece;
        ASSERT_TRUE(line.client.established() && line.server.established());
        const auto there = sample(70'000, 1), back = sample(3, 2);
        line.client.send(there);
        line.server.send(back);
        ASSERT_EQ(line.carry(piece), "") << piece;
        EXPECT_EQ(line.atServer, there);
        EXPECT_EQ(line.atClient, back);
    }
}

TEST(Tls, WhatGoesOverTheWireShowsNothingOfWhatIsSaid) {
    const Certificates files;
    Line line(files, "localhost", files.authority());
    ASSERT_EQ(line.carry(1'000), "");
    const std::string secret = "the moves of this evening";
    line.client.send(std::as_bytes(std::span(secret)));
    const std::vector<std::byte> wire = line.client.takeOutput();
    const std::string text(reinterpret_cast<const char*>(wire.data()), wire.size());
    EXPECT_GT(text.size(), secret.size());
    EXPECT_EQ(text.find("moves"), std::string::npos);
}

TEST(Tls, AClientTakesOnlyACertificateOfItsAuthorityForTheNameItAskedFor) {
    const Certificates files, others;
    const Certificates old("DNS:localhost", -1);
    EXPECT_EQ(Line(files, "127.0.0.1", files.authority()).carry(1'000), "");
    EXPECT_NE(Line(files, "example.org", files.authority()).carry(1'000).find("hostname mismatch"),
              std::string::npos);
    EXPECT_NE(Line(files, "127.0.0.2", files.authority()).carry(1'000).find("IP address mismatch"),
              std::string::npos);
    EXPECT_NE(Line(files, "localhost", others.authority()).carry(1'000).find("not accepted"),
              std::string::npos);
    EXPECT_NE(Line(files, "localhost", "").carry(1'000).find("not accepted"), std::string::npos)
        << "the system does not know this authority";
    EXPECT_NE(Line(old, "localhost", old.authority()).carry(1'000).find("expired"),
              std::string::npos);
}

TEST(Tls, ABitTurnedOnTheWireEndsIt) {
    const Certificates files;
    Line line(files, "localhost", files.authority());
    ASSERT_EQ(line.carry(1'000), "");
    line.client.send(sample(100, 3));
    std::vector<std::byte> wire = line.client.takeOutput();
    wire[wire.size() / 2] ^= std::byte{1};
    EXPECT_FALSE(line.server.receive(wire, line.atServer).ok());
    EXPECT_TRUE(line.atServer.empty());
    EXPECT_FALSE(line.server.established());
}

TEST(Tls, ARecordPlayedBackEndsIt) {
    const Certificates files;
    Line line(files, "localhost", files.authority());
    ASSERT_EQ(line.carry(1'000), "");
    line.client.send(sample(100, 3));
    const std::vector<std::byte> wire = line.client.takeOutput();
    EXPECT_TRUE(line.server.receive(wire, line.atServer).ok());
    EXPECT_FALSE(line.server.receive(wire, line.atServer).ok());
    EXPECT_EQ(line.atServer, sample(100, 3)) << "once";
}

TEST(Tls, WhatIsNoTlsIsRefusedAndNoHandshakeIsEndless) {
    const Certificates files;
    const TlsContext context = serverOf(files);
    std::vector<std::byte> plain;
    TlsStream web(context);
    const std::string get = "GET / HTTP/1.1\r\nHost: localhost\r\n\r\n";
    EXPECT_FALSE(web.receive(std::as_bytes(std::span(get)), plain).ok());
    // A greeting that says it has 16 MiB, and brings them.
    TlsStream endless(context);
    const std::array<std::uint8_t, 9> head{22, 3, 1, 0x40, 0, 1, 0xff, 0xff, 0xff};
    std::vector<std::byte> record(5 + 0x4000);
    std::memcpy(record.data(), head.data(), head.size());
    std::size_t taken = 0;
    while (taken < (1u << 20) && endless.receive(record, plain).ok()) taken += record.size();
    EXPECT_LE(taken, TlsStream::clientHandshakeBytes);
    EXPECT_TRUE(plain.empty());
}

TEST(Tls, OlderVersionsAreRefused) {
    const Certificates files;
    const TlsContext context = serverOf(files);
    SSL_CTX* const old = SSL_CTX_new(TLS_client_method());
    SSL_CTX_set_max_proto_version(old, TLS1_2_VERSION);
    SSL* const ssl = SSL_new(old);
    BIO* const out = BIO_new(BIO_s_mem());
    SSL_set_bio(ssl, BIO_new(BIO_s_mem()), out);
    SSL_set_connect_state(ssl);
    EXPECT_LT(SSL_do_handshake(ssl), 1);
    std::vector<std::byte> hello(BIO_ctrl_pending(out)), plain;
    ASSERT_GT(BIO_read(out, hello.data(), static_cast<int>(hello.size())), 0);
    SSL_free(ssl);
    SSL_CTX_free(old);
    TlsStream server(context);
    const Status taken = server.receive(hello, plain);
    ASSERT_FALSE(taken.ok());
    EXPECT_NE(taken.error().message.find("unsupported protocol"), std::string::npos)
        << taken.error().message;
}

TEST(TlsFiles, WhatCannotBeUsedIsNamed) {
    const Certificates files, others;
    const auto refusal = [](const std::string& certificates, const std::string& key) {
        const auto context = TlsContext::forServer(certificates, key);
        return context ? std::string("taken") : context.error().message;
    };
    EXPECT_EQ(refusal("/nowhere.pem", files.key()), "/nowhere.pem: No such file or directory");
    EXPECT_EQ(refusal(files.key(), files.key()).find(files.key() + ": holds no certificate"), 0u);
    EXPECT_EQ(refusal(files.certificate(), others.key())
                  .find(others.key() + ": is not the private key of " + files.certificate()),
              0u);
    EXPECT_FALSE(TlsContext::forClient(files.key()).ok());
}

}  // namespace
}  // namespace huestep::protocol
