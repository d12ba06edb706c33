/// TLS 1.3 as a layer (OpenSSL): bytes of the wire in, bytes of the other end out, and back. It has
/// no socket and no clock.
///
///     Result<TlsContext> context = TlsContext::forServer("cert.pem", "key.pem");
///     TlsStream stream(*context);
///     Status taken = stream.receive(fromWire, plain);   // as it comes; then, in any case,
///     write(stream.takeOutput());                       // what the layer has to say
///     if (stream.established()) stream.send(bytes);     // and again what it has to say
///
/// A client checks the server's certificate and that it bears the name it was asked for. There is
/// no session resumption and no early data, so nothing that was recorded can be played back. Thread
/// rule: a context may be shared; a stream belongs to one thread at a time.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"

namespace huestep::protocol {

class TlsContext {
 public:
    /// PEM files: the certificate with those that vouch for it, and its private key. The sentence
    /// names the file.
    static Result<TlsContext> forServer(const std::string& certificates, const std::string& key);
    /// `authorities`: a PEM file of certificates to trust; empty: those that the system trusts.
    static Result<TlsContext> forClient(const std::string& authorities);
    TlsContext(TlsContext&&) noexcept;
    TlsContext& operator=(TlsContext&&) noexcept;
    ~TlsContext();

 private:
    friend class TlsStream;
    struct Inside;
    explicit TlsContext(std::shared_ptr<Inside> inside);
    std::shared_ptr<Inside> m_inside;
};

class TlsStream {
 public:
    /// Most bytes of the wire before a server's handshake is done: a greeting takes two thousand,
    /// and no certificate of a client is asked for. A server's may be longer.
    static constexpr std::size_t clientHandshakeBytes = 8u << 10;
    static constexpr std::size_t serverHandshakeBytes = 128u << 10;

    /// A server's end.
    explicit TlsStream(const TlsContext& context);
    /// A client's, whose first words are in `takeOutput` at once. `server`: the name, or the number
    /// of an address, that the certificate must bear.
    TlsStream(const TlsContext& context, const std::string& server);
    TlsStream(TlsStream&&) noexcept;
    TlsStream& operator=(TlsStream&&) noexcept;
    ~TlsStream();

    /// Takes bytes of the wire; appends what they bring to `plain`. After an error, whose sentence
    /// says what is wrong, the connection must end.
    Status receive(std::span<const std::byte> wire, std::vector<std::byte>& plain);
    /// Whether both ends have proved themselves, and `send` may be called.
    [[nodiscard]] bool established() const;
    /// Requires `established`.
    void send(std::span<const std::byte> plain);
    /// Says that nothing more comes.
    void close();
    /// What is to be written to the wire. Takes it out.
    std::vector<std::byte> takeOutput();

 private:
    struct Inside;
    Status handshake();
    std::unique_ptr<Inside> m_inside;
};

}  // namespace huestep::protocol
