#include "protocol/tls.h"

#include <openssl/err.h>
#include <openssl/ssl.h>
#include <openssl/x509v3.h>

#include <cassert>
#include <cerrno>
#include <cstring>
#include <fstream>

namespace huestep::protocol {

namespace {

/// What OpenSSL has to say of the last failure; its queue is empty then.
std::string reason() {
    const unsigned long code = ERR_peek_last_error();
    const char* text = code == 0 ? nullptr : ERR_reason_error_string(code);
    std::string out = text ? text : "no reason is given";
    ERR_clear_error();
    return out;
}

Status readable(const std::string& path) {
    errno = 0;
    if (std::ifstream(path).good()) return Done{};
    return Error{path + ": " + std::strerror(errno == 0 ? EIO : errno)};
}

struct FreeContext {
    void operator()(SSL_CTX* context) const { SSL_CTX_free(context); }
};
struct FreeSession {
    void operator()(SSL* ssl) const { SSL_free(ssl); }
};
using Context = std::unique_ptr<SSL_CTX, FreeContext>;

Context newContext(const SSL_METHOD* method) {
    ERR_clear_error();
    Context context(SSL_CTX_new(method));
    assert(context);  // fails only without memory
    SSL_CTX_set_min_proto_version(context.get(), TLS1_3_VERSION);
    SSL_CTX_set_options(context.get(), SSL_OP_NO_TICKET | SSL_OP_NO_RENEGOTIATION);
    SSL_CTX_set_num_tickets(context.get(), 0);
    SSL_CTX_set_session_cache_mode(context.get(), SSL_SESS_CACHE_OFF);
    SSL_CTX_set_mode(context.get(), SSL_MODE_RELEASE_BUFFERS);
    return context;
}

/// Whether the text is the number of an address, and not a name.
bool isNumber(const std::string& server) {
    ASN1_OCTET_STRING* number = a2i_IPADDRESS(server.c_str());
    ERR_clear_error();
    if (!number) return false;
    ASN1_OCTET_STRING_free(number);
    return true;
}

}  // namespace

struct TlsContext::Inside {
    Context context;
};

TlsContext::TlsContext(std::shared_ptr<Inside> inside) : m_inside(std::move(inside)) {}
TlsContext::TlsContext(TlsContext&&) noexcept = default;
TlsContext& TlsContext::operator=(TlsContext&&) noexcept = default;
TlsContext::~TlsContext() = default;

Result<TlsContext> TlsContext::forServer(const std::string& certificates, const std::string& key) {
    for (const std::string& file : {certificates, key}) {
        if (const Status there = readable(file); !there) return there.error();
    }
    Context context = newContext(TLS_server_method());
    if (SSL_CTX_use_certificate_chain_file(context.get(), certificates.c_str()) != 1)
        return Error{certificates + ": holds no certificate in PEM form (" + reason() + ")"};
    if (SSL_CTX_use_PrivateKey_file(context.get(), key.c_str(), SSL_FILETYPE_PEM) != 1)
        return Error{key + ": is not the private key of " + certificates + " in PEM form (" +
                     reason() + ")"};
    return TlsContext(std::make_shared<Inside>(Inside{std::move(context)}));
}

Result<TlsContext> TlsContext::forClient(const std::string& authorities) {
    Context context = newContext(TLS_client_method());
    if (authorities.empty()) {
        SSL_CTX_set_default_verify_paths(context.get());
    } else {
        if (const Status there = readable(authorities); !there) return there.error();
        if (SSL_CTX_load_verify_file(context.get(), authorities.c_str()) != 1)
            return Error{authorities + ": holds no certificate in PEM form (" + reason() + ")"};
    }
    SSL_CTX_set_verify(context.get(), SSL_VERIFY_PEER, nullptr);
    return TlsContext(std::make_shared<Inside>(Inside{std::move(context)}));
}

struct TlsStream::Inside {
    std::shared_ptr<TlsContext::Inside> context;
    std::unique_ptr<SSL, FreeSession> ssl;
    BIO* in = nullptr;   ///< the wire's bytes; `ssl` owns it
    BIO* out = nullptr;  ///< for the wire; likewise
    std::size_t mostHandshake = 0;
    std::size_t received = 0;  ///< before the handshake was done
    bool failed = false;

    explicit Inside(std::shared_ptr<TlsContext::Inside> its)
        : context(std::move(its)), ssl(SSL_new(context->context.get())) {
        in = BIO_new(BIO_s_mem());
        out = BIO_new(BIO_s_mem());
        assert(ssl && in && out);  // fails only without memory
        BIO_ctrl(in, BIO_C_SET_BUF_MEM_EOF_RETURN, -1, nullptr);
        SSL_set_bio(ssl.get(), in, out);
    }

    Status fail() {
        failed = true;
        const long verified = SSL_get_verify_result(ssl.get());
        const bool client = !SSL_is_server(ssl.get());
        const std::string why = reason();
        if (client && verified != X509_V_OK)
            return Error{std::string("the server's certificate is not accepted: ") +
                         X509_verify_cert_error_string(verified)};
        return Error{"this is not TLS 1.3 as it should be (" + why + ")"};
    }
};

TlsStream::TlsStream(const TlsContext& context)
    : m_inside(std::make_unique<Inside>(context.m_inside)) {
    m_inside->mostHandshake = clientHandshakeBytes;
    SSL_set_accept_state(m_inside->ssl.get());
}

TlsStream::TlsStream(const TlsContext& context, const std::string& server)
    : m_inside(std::make_unique<Inside>(context.m_inside)) {
    m_inside->mostHandshake = serverHandshakeBytes;
    SSL* const ssl = m_inside->ssl.get();
    if (isNumber(server)) {
        X509_VERIFY_PARAM_set1_ip_asc(SSL_get0_param(ssl), server.c_str());
    } else {
        SSL_set_hostflags(ssl, X509_CHECK_FLAG_NO_PARTIAL_WILDCARDS);
        SSL_set1_host(ssl, server.c_str());
        // The macro for this casts as C does.
        SSL_ctrl(ssl, SSL_CTRL_SET_TLSEXT_HOSTNAME, TLSEXT_NAMETYPE_host_name,
                 const_cast<char*>(server.c_str()));
    }
    SSL_set_connect_state(ssl);
    static_cast<void>(handshake());
}

TlsStream::TlsStream(TlsStream&&) noexcept = default;
TlsStream& TlsStream::operator=(TlsStream&&) noexcept = default;
TlsStream::~TlsStream() = default;

bool TlsStream::established() const {
    return !m_inside->failed && SSL_is_init_finished(m_inside->ssl.get()) != 0;
}

Status TlsStream::handshake() {
    ERR_clear_error();
    SSL* const ssl = m_inside->ssl.get();
    const int status = SSL_do_handshake(ssl);
    if (status == 1 || SSL_get_error(ssl, status) == SSL_ERROR_WANT_READ) return Done{};
    return m_inside->fail();
}

Status TlsStream::receive(std::span<const std::byte> wire, std::vector<std::byte>& plain) {
    if (m_inside->failed) return Error{"this connection has failed before"};
    SSL* const ssl = m_inside->ssl.get();
    if (!established()) {
        m_inside->received += wire.size();
        if (m_inside->received > m_inside->mostHandshake) {
            m_inside->failed = true;
            return Error{"a TLS handshake of more than " + std::to_string(m_inside->mostHandshake) +
                         " bytes"};
        }
    }
    // A memory of bytes takes all that there is memory for.
    assert(wire.size() < (1u << 30));
    BIO_write(m_inside->in, wire.data(), static_cast<int>(wire.size()));
    if (!established()) {
        if (const Status shaken = handshake(); !shaken || !established()) return shaken;
    }
    std::byte piece[16 << 10];
    for (;;) {
        ERR_clear_error();
        const int count = SSL_read(ssl, piece, static_cast<int>(sizeof piece));
        if (count > 0) {
            plain.insert(plain.end(), piece, piece + count);
            continue;
        }
        const int error = SSL_get_error(ssl, count);
        // The other end's last word: the transport's end follows.
        if (error == SSL_ERROR_WANT_READ || error == SSL_ERROR_ZERO_RETURN) return Done{};
        return m_inside->fail();
    }
}

void TlsStream::send(std::span<const std::byte> plain) {
    assert(established());
    if (plain.empty()) return;
    std::size_t written = 0;
    ERR_clear_error();
    // Into memory all of it goes at once.
    if (SSL_write_ex(m_inside->ssl.get(), plain.data(), plain.size(), &written) != 1 ||
        written != plain.size()) {
        m_inside->failed = true;
    }
}

void TlsStream::close() {
    if (!established()) return;
    ERR_clear_error();
    SSL_shutdown(m_inside->ssl.get());
}

std::vector<std::byte> TlsStream::takeOutput() {
    std::vector<std::byte> bytes(BIO_ctrl_pending(m_inside->out));
    if (!bytes.empty()) {
        [[maybe_unused]] const int count =
            BIO_read(m_inside->out, bytes.data(), static_cast<int>(bytes.size()));
        assert(count == static_cast<int>(bytes.size()));
    }
    return bytes;
}

}  // namespace huestep::protocol
