#include "server/web_endpoint.h"

#include <libwebsockets.h>
#include <uv.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "protocol/codec.h"
#include "protocol/keys.h"
#include "server/token_bucket.h"
#include "server/web_listener.h"
#include "server/web_peer.h"
#include "server/web_route.h"
#include "server/web_viewer.h"

namespace huestep::server {

namespace {

constexpr std::size_t chunkBytes = 16u << 10;  ///< of a page's file, a turn
constexpr std::size_t headRoom = 2048;         ///< for the head of a reply

/// To every reply. Nothing is loaded from elsewhere and no script stands in the page, so a name
/// that found its way into the HTML could still run nothing. 'wasm-unsafe-eval' lets the page's
/// scripts compile WebAssembly, and nothing else.
constexpr std::array<std::pair<const char*, std::string_view>, 5> securityHeaders{{
    {"content-security-policy:",
     "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; img-src 'self'; "
     "connect-src 'self'; "
     "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
    {"x-content-type-options:", "nosniff"},
    {"referrer-policy:", "no-referrer"},
    {"cross-origin-resource-policy:", "same-origin"},
    {"cache-control:", "no-cache"},
}};

const unsigned char* bytesOf(std::string_view text) {
    return reinterpret_cast<const unsigned char*>(text.data());
}

SharedWebFrame frameOf(const Session& session, bool withShapes) {
    const std::vector<std::byte> encoded = protocol::encode(session.view(withShapes));
    auto frame = std::make_shared<WebFrame>();
    frame->room = LWS_PRE;
    frame->bytes.resize(LWS_PRE + encoded.size());
    std::memcpy(frame->bytes.data() + LWS_PRE, encoded.data(), encoded.size());
    return frame;
}

std::string header(lws* wsi, lws_token_indexes token) {
    std::array<char, 512> text{};
    const int length = lws_hdr_copy(wsi, text.data(), static_cast<int>(text.size()), token);
    return length > 0 ? std::string(text.data(), static_cast<std::size_t>(length)) : std::string();
}

/// A value too long for any session's name is still a value, of no session.
std::optional<std::string> sessionOf(lws* wsi) {
    if (lws_hdr_total_length(wsi, WSI_TOKEN_HTTP_URI_ARGS) == 0) return std::nullopt;
    std::array<char, 4096> text{};
    const char* value = lws_get_urlarg_by_name(wsi, "session=", text.data(), sizeof text);
    if (!value) return std::nullopt;
    return std::string(value);
}

/// The sealed ticket in the query of who watches; empty: none.
std::vector<std::byte> ticketOf(lws* wsi) {
    if (lws_hdr_total_length(wsi, WSI_TOKEN_HTTP_URI_ARGS) == 0) return {};
    std::array<char, 4096> text{};
    const char* value = lws_get_urlarg_by_name(wsi, "ticket=", text.data(), sizeof text);
    return value ? protocol::fromUrlText(value).value_or(std::vector<std::byte>(1))
                 : std::vector<std::byte>();
}

std::string methodOf(lws* wsi) {
    if (lws_hdr_total_length(wsi, WSI_TOKEN_GET_URI) > 0) return "GET";
    if (lws_hdr_total_length(wsi, WSI_TOKEN_HEAD_URI) > 0) return "HEAD";
    return "OTHER";
}

}  // namespace

struct WebEndpoint::Inside {
    /// A connection: first of HTTP, then maybe a viewer's.
    struct Peer {
        std::string address;  ///< HOST:PORT
        std::string body;     ///< of the reply being sent
        std::size_t sent = 0;
        const Session* session = nullptr;  ///< set: admitted as a viewer of it
        std::optional<WebViewer> viewer;
        bool steps = false;  ///< admitted as a page that steps the world itself
        std::optional<WebPeer> client;
    };

    Inside(Host& itsHost, WebConfig given);
    ~Inside();

    Status start();
    Status makeContext();
    void adopt(int descriptor, const std::string& address);
    int event(lws* wsi, lws_callback_reasons reason, std::string_view in);
    int request(lws* wsi, Peer& peer, std::string_view path);
    int reply(lws* wsi, Peer& peer, const WebReply& reply, bool bodyToo);
    bool writeHead(lws* wsi, const WebReply& reply) const;
    int writeBody(lws* wsi, Peer& peer);
    int confirmUpgrade(lws* wsi, Peer& peer);
    unsigned refuseViewer(lws* wsi, const Peer& peer) const;
    int established(lws* wsi, Peer& peer);
    int writeView(lws* wsi, Peer& peer);
    int establishedClient(lws* wsi, Peer& peer);
    int receive(lws* wsi, Peer& peer, std::string_view bytes);
    int writeClient(lws* wsi, Peer& peer);
    void wakeClients(const Session* session);
    static void sayGoodbye(lws* wsi);
    void forget(lws* wsi);
    bool takeToken(const Peer& peer);
    std::vector<WebSession> sessionList() const;
    std::size_t viewerCount() const;
    struct Stream;
    Stream& streamOf(const Session& session);
    void afterTick(const Session& session);
    void heartbeat();
    void show(const Session& session);
    void beginStop();
    void endStop();

    Host& host;
    WebConfig config;
    WebListener listener;
    lws_context* context = nullptr;
    lws_vhost* vhost = nullptr;
    std::array<lws_protocols, 3> protocols{};
    lws_retry_bo_t liveness{};
    uv_timer_t* timer = nullptr;  ///< heartbeats, then the farewell; frees itself once closed
    std::map<lws*, Peer> peers;
    struct Stream {
        TokenBucket pace;
        Instant shown = 0;  ///< when its viewers were last offered a frame
    };
    std::map<const Session*, Stream> streams;
    std::vector<TokenBucket> rates;  ///< by a hash of the address: bounded, whoever comes
    WebCounters counters;
    std::string address;
    bool stopping = false;
};

WebEndpoint::Inside::Inside(Host& itsHost, WebConfig given)
    : host(itsHost),
      config(std::move(given)),
      listener(*host.loop(), config.limits.backlog, config.limits.sendBufferBytes,
               host.hub().limits().acceptsAtOnce,
               [this](int descriptor, const std::string& peer) { adopt(descriptor, peer); }),
      rates(config.limits.rateBuckets,
            TokenBucket(config.limits.requestsPerSecond, config.limits.requestBurst, uv_hrtime())) {
}

/// On a loop that is not its own, libwebsockets starts to close at the first `lws_context_destroy`
/// and frees at a second one, once the loop has closed its handles; the context is null then.
WebEndpoint::Inside::~Inside() {
    if (context) lws_context_destroy(context);
}

Status WebEndpoint::Inside::start() {
    Result<protocol::Address> wanted = protocol::parseAddress(config.listen, true);
    if (!wanted) return wanted.error();
    if (Status listening = listener.listen(*wanted); !listening) return listening;
    address = protocol::toText(listener.bound());
    if (Status may = host.mayListenOn(listener.bound()); !may) {
        listener.close();
        return may;
    }
    if (Status made = makeContext(); !made) {
        listener.close();
        return made;
    }
    timer = new uv_timer_t{};
    uv_timer_init(host.loop(), timer);
    timer->data = this;
    const std::uint64_t every = config.limits.heartbeatMs / 2;
    uv_timer_start(
        timer, [](uv_timer_t* each) { static_cast<Inside*>(each->data)->heartbeat(); }, every,
        every);
    LogLine("web_listening").with("address", address).to(config.log);
    return Done{};
}

Status WebEndpoint::Inside::makeContext() {
    // Its log is one of the whole process and knows no sink of ours; what matters is in replies.
    lws_set_log_level(0, nullptr);
    protocols[0].name = "huestep-view";
    protocols[0].callback = [](lws* wsi, lws_callback_reasons reason, void*, void* in,
                               std::size_t length) {
        auto* inside = static_cast<Inside*>(lws_context_user(lws_get_context(wsi)));
        // The name of an upgrade comes with its terminator and without its length.
        if (reason == LWS_CALLBACK_HTTP_CONFIRM_UPGRADE && in) {
            length = std::strlen(static_cast<const char*>(in));
        }
        return inside->event(wsi, reason, {static_cast<const char*>(in), in ? length : 0});
    };
    protocols[0].rx_buffer_size = 128;       // whatever a viewer sends is not read anyway
    protocols[0].tx_packet_size = 1u << 20;  // 0: sends are cut to the size above
    protocols[1] = protocols[0];
    protocols[1].name = "huestep-peer";
    protocols[1].rx_buffer_size = 16u << 10;
    liveness.secs_since_valid_ping = config.limits.pingSeconds;
    liveness.secs_since_valid_hangup = config.limits.silenceSeconds;

    void* loops[1] = {host.loop()};
    lws_context_creation_info info;
    std::memset(&info, 0, sizeof info);
    info.port = CONTEXT_PORT_NO_LISTEN_SERVER;
    info.protocols = protocols.data();
    info.vhost_name = "web";
    info.server_string = "huestep";
    info.options = LWS_SERVER_OPTION_LIBUV | LWS_SERVER_OPTION_VALIDATE_UTF8;
    info.foreign_loops = loops;
    info.pcontext = &context;
    info.user = this;
    info.fd_limit_per_thread = static_cast<unsigned>(config.limits.connections + 16);
    info.max_http_header_data = config.limits.headerBytes;
    info.max_http_header_pool = static_cast<std::uint16_t>(config.limits.connections);
    info.timeout_secs = config.limits.idleSeconds;
    info.timeout_secs_ah_idle = config.limits.idleSeconds;
    info.keepalive_timeout = config.limits.idleSeconds;
    info.retry_and_idle_policy = &liveness;
    if (const std::optional<TlsFiles>& tls = host.tls()) {
        info.options |= LWS_SERVER_OPTION_DO_SSL_GLOBAL_INIT;
        info.ssl_cert_filepath = tls->certificates.c_str();
        info.ssl_private_key_filepath = tls->key.c_str();
        info.ssl_options_set = SSL_OP_NO_TLSv1 | SSL_OP_NO_TLSv1_1 | SSL_OP_NO_TLSv1_2;
    }
    context = lws_create_context(&info);
    if (!context) {
        return Error{
            "libwebsockets does not start; is its part for libuv installed "
            "(libwebsockets-evlib-uv on Debian)?"};
    }
    vhost = lws_get_vhost_by_name(context, "web");
    return Done{};
}

void WebEndpoint::Inside::adopt(int descriptor, const std::string& from) {
    if (stopping || peers.size() >= config.limits.connections) {
        ++counters.refusedConnections;
        uv_fs_t closing;
        uv_fs_close(nullptr, &closing, descriptor, nullptr);
        uv_fs_req_cleanup(&closing);
        return;
    }
    lws* wsi = lws_adopt_socket_vhost(vhost, descriptor);
    if (wsi) peers[wsi].address = from;
}

int WebEndpoint::Inside::event(lws* wsi, lws_callback_reasons reason, std::string_view in) {
    const auto at = peers.find(wsi);
    if (at == peers.end()) return 0;  // about the context, or a connection not yet ours
    Peer& peer = at->second;
    switch (reason) {
        case LWS_CALLBACK_HTTP:
            return request(wsi, peer, in);
        case LWS_CALLBACK_HTTP_WRITEABLE:
            return writeBody(wsi, peer);
        case LWS_CALLBACK_HTTP_CONFIRM_UPGRADE:
            return in == "websocket" ? confirmUpgrade(wsi, peer) : -1;
        case LWS_CALLBACK_ESTABLISHED:
            return established(wsi, peer);
        case LWS_CALLBACK_SERVER_WRITEABLE:
            return peer.client ? writeClient(wsi, peer) : writeView(wsi, peer);
        case LWS_CALLBACK_RECEIVE:
            return receive(wsi, peer, in);
        case LWS_CALLBACK_WSI_DESTROY:
            forget(wsi);
            return 0;
        default:
            return 0;
    }
}

bool WebEndpoint::Inside::takeToken(const Peer& peer) {
    ++counters.requests;
    const std::size_t bucket = std::hash<std::string>{}(visitorOf(peer.address)) % rates.size();
    if (rates[bucket].take(uv_hrtime())) return true;
    ++counters.tooManyRequests;
    return false;
}

std::vector<WebSession> WebEndpoint::Inside::sessionList() const {
    std::vector<WebSession> list;
    for (const Session* session : host.hub().sessions()) {
        list.push_back({session->name(), session->tick(), session->world().bodies().size(),
                        session->seats().connected()});
    }
    return list;
}

int WebEndpoint::Inside::request(lws* wsi, Peer& peer, std::string_view path) {
    const WebRequest asked{methodOf(wsi), std::string(path), sessionOf(wsi)};
    if (!takeToken(peer)) return reply(wsi, peer, refusal(429), asked.method != "HEAD");
    return reply(wsi, peer, answer(asked, sessionList()), asked.method != "HEAD");
}

bool WebEndpoint::Inside::writeHead(lws* wsi, const WebReply& reply) const {
    std::array<unsigned char, LWS_PRE + headRoom> buffer{};
    unsigned char* const start = buffer.data() + LWS_PRE;
    unsigned char* const end = buffer.data() + buffer.size();
    unsigned char* p = start;
    const std::string type(reply.type);
    if (lws_add_http_common_headers(wsi, reply.status, type.c_str(), reply.body.size(), &p, end)) {
        return false;
    }
    const auto add = [&](const char* name, std::string_view value) {
        return lws_add_http_header_by_name(wsi, reinterpret_cast<const unsigned char*>(name),
                                           bytesOf(value), static_cast<int>(value.size()), &p,
                                           end) == 0;
    };
    for (const auto& [name, value] : securityHeaders) {
        if (!add(name, value)) return false;
    }
    if (!reply.location.empty() && !add("location:", reply.location)) return false;
    if (!reply.encoding.empty() && !add("content-encoding:", reply.encoding)) return false;
    // A WebSocket that is refused does not tell a page why; this does.
    if (host.hub().asksForTickets() && !add("x-huestep-tickets:", "asked")) return false;
    if (reply.status == 429 && !add("retry-after:", "1")) return false;
    return lws_finalize_write_http_header(wsi, start, &p, end) == 0;
}

int WebEndpoint::Inside::reply(lws* wsi, Peer& peer, const WebReply& reply, bool bodyToo) {
    if (!writeHead(wsi, reply)) return -1;
    if (!bodyToo || reply.body.empty()) return lws_http_transaction_completed(wsi) ? -1 : 0;
    peer.body = reply.body;
    peer.sent = 0;
    lws_callback_on_writable(wsi);
    return 0;
}

int WebEndpoint::Inside::writeBody(lws* wsi, Peer& peer) {
    if (peer.sent >= peer.body.size()) return 0;
    const std::size_t bytes = std::min(chunkBytes, peer.body.size() - peer.sent);
    const bool last = peer.sent + bytes == peer.body.size();
    std::vector<unsigned char> chunk(LWS_PRE + bytes);
    std::memcpy(chunk.data() + LWS_PRE, peer.body.data() + peer.sent, bytes);
    if (lws_write(wsi, chunk.data() + LWS_PRE, bytes,
                  last ? LWS_WRITE_HTTP_FINAL : LWS_WRITE_HTTP) < 0) {
        return -1;
    }
    peer.sent += bytes;
    if (!last) {
        lws_callback_on_writable(wsi);
        return 0;
    }
    peer.body.clear();
    return lws_http_transaction_completed(wsi) ? -1 : 0;
}

std::size_t WebEndpoint::Inside::viewerCount() const {
    return static_cast<std::size_t>(std::count_if(peers.begin(), peers.end(), [](const auto& each) {
        return each.second.session || each.second.steps;
    }));
}

/// The status of a refusal, or 0.
unsigned WebEndpoint::Inside::refuseViewer(lws* wsi, const Peer& peer) const {
    const std::string path = header(wsi, WSI_TOKEN_GET_URI);
    if (path != viewPath && path != peerPath) return 404;
    if (!sameOrigin(header(wsi, WSI_TOKEN_ORIGIN), header(wsi, WSI_TOKEN_HOST))) return 403;
    const std::optional<std::string> name = sessionOf(wsi);  // a client names it in its Hello
    if (path == viewPath && (!name || !host.hub().find(*name))) return 404;
    if (!peer.session && !peer.steps && viewerCount() >= config.limits.viewers) return 503;
    return 0;
}

int WebEndpoint::Inside::confirmUpgrade(lws* wsi, Peer& peer) {
    unsigned status = takeToken(peer) ? refuseViewer(wsi, peer) : 429;
    const bool watches = header(wsi, WSI_TOKEN_GET_URI) == viewPath;
    if (status == 0 && watches && !peer.session &&
        !host.hub().admit(ticketOf(wsi), *sessionOf(wsi), protocol::Role::Spectator)) {
        status = 401;
    }
    if (status == 0) {
        peer.steps = header(wsi, WSI_TOKEN_GET_URI) == peerPath;
        if (!peer.steps) peer.session = host.hub().find(*sessionOf(wsi));
        return 0;
    }
    ++counters.refusedViewers;
    // The transaction ends here, so there is no turn for a body; a browser shows none anyway.
    return writeHead(wsi, {status, "text/plain; charset=utf-8", {}, {}}) ? 1 : -1;
}

int WebEndpoint::Inside::established(lws* wsi, Peer& peer) {
    if (peer.steps) return establishedClient(wsi, peer);
    if (!peer.session) return -1;
    ++counters.viewersTotal;
    LogLine("viewer_came")
        .with("session", peer.session->name())
        .with("address", peer.address)
        .to(config.log);
    // At once, and not with the next tick: a session may stand still.
    peer.viewer.emplace();
    peer.viewer->offer(frameOf(*peer.session, true), peer.session->definitions());
    lws_callback_on_writable(wsi);
    return 0;
}

/// From outside the writable turn, in which `lws_close_reason` is not heeded. The viewer closes
/// when it has read the reason, or `endStop` does.
void WebEndpoint::Inside::sayGoodbye(lws* wsi) {
    std::string why = "the server stops";
    lws_close_reason(wsi, LWS_CLOSE_STATUS_GOINGAWAY, reinterpret_cast<unsigned char*>(why.data()),
                     why.size());
    lws_set_timeout(wsi, PENDING_TIMEOUT_USER_REASON_BASE, LWS_TO_KILL_SYNC);
}

int WebEndpoint::Inside::writeView(lws* wsi, Peer& peer) {
    if (stopping) return 0;
    const SharedWebFrame frame = peer.viewer ? peer.viewer->take() : nullptr;
    if (!frame) return 0;
    const std::size_t bytes = frame->bytes.size() - frame->room;
    // What the kernel does not take, libwebsockets keeps, and asks for no more until it is gone.
    if (lws_write(wsi, frame->bytes.data() + frame->room, bytes, LWS_WRITE_BINARY) < 0) return -1;
    ++counters.viewsSent;
    counters.bytesOut += bytes;
    return 0;
}

// Pages that step the world themselves -----------------------------------------------------------

int WebEndpoint::Inside::establishedClient(lws* wsi, Peer& peer) {
    std::optional<WebPeer> client = WebPeer::accept(host.hub(), peer.address, uv_hrtime());
    if (!client) {
        ++counters.refusedViewers;
        return -1;
    }
    ++counters.peersTotal;
    peer.client.emplace(std::move(*client));
    lws_callback_on_writable(wsi);
    return 0;
}

int WebEndpoint::Inside::receive(lws* wsi, Peer& peer, std::string_view bytes) {
    if (peer.client) {
        peer.client->receive(std::as_bytes(std::span(bytes)), uv_hrtime());
        lws_callback_on_writable(wsi);
        return 0;
    }
    std::string why = "viewers only watch";
    lws_close_reason(wsi, LWS_CLOSE_STATUS_POLICY_VIOLATION,
                     reinterpret_cast<unsigned char*>(why.data()), why.size());
    return -1;
}

/// Called when the system has taken all that was written before.
int WebEndpoint::Inside::writeClient(lws* wsi, Peer& peer) {
    std::vector<unsigned char> message = peer.client->next(LWS_PRE, uv_hrtime());
    if (message.size() > LWS_PRE) {
        const std::size_t bytes = message.size() - LWS_PRE;
        if (lws_write(wsi, message.data() + LWS_PRE, bytes, LWS_WRITE_BINARY) < 0) return -1;
        lws_callback_on_writable(wsi);
        return 0;
    }
    if (!peer.client->finished()) return 0;
    std::string why = stopping ? "the server stops" : "";
    lws_close_reason(wsi, stopping ? LWS_CLOSE_STATUS_GOINGAWAY : LWS_CLOSE_STATUS_NORMAL,
                     reinterpret_cast<unsigned char*>(why.data()), why.size());
    return -1;
}

/// Lets those of a session, or all, be asked to write, and ends those whose time is over.
void WebEndpoint::Inside::wakeClients(const Session* session) {
    const Instant now = uv_hrtime();
    for (auto& [wsi, peer] : peers) {
        if (!peer.client || (session && !peer.client->follows(*session))) continue;
        lws_callback_on_writable(wsi);
        if (peer.client->overdue(now)) {
            lws_set_timeout(wsi, PENDING_TIMEOUT_USER_REASON_BASE, LWS_TO_KILL_ASYNC);
        }
    }
}

void WebEndpoint::Inside::forget(lws* wsi) {
    const auto at = peers.find(wsi);
    if (at == peers.end()) return;
    if (at->second.viewer) {
        counters.viewsDropped += at->second.viewer->dropped();
        LogLine("viewer_left")
            .with("session", at->second.session->name())
            .with("address", at->second.address)
            .with("dropped", at->second.viewer->dropped())
            .to(config.log);
    }
    peers.erase(at);
}

WebEndpoint::Inside::Stream& WebEndpoint::Inside::streamOf(const Session& session) {
    const TokenBucket pace(config.limits.viewsPerSecond, 4.0, uv_hrtime());
    return streams.try_emplace(&session, Stream{pace, uv_hrtime()}).first->second;
}

void WebEndpoint::Inside::afterTick(const Session& session) {
    if (!stopping) wakeClients(&session);
    if (!stopping && streamOf(session).pace.take(uv_hrtime())) show(session);
}

/// A page tells a server that is gone from a session that stands still by what it hears.
void WebEndpoint::Inside::heartbeat() {
    wakeClients(nullptr);
    const Instant since = uv_hrtime() - config.limits.heartbeatMs * millisecond;
    for (const Session* session : host.hub().sessions()) {
        if (streamOf(*session).shown < since) show(*session);
    }
}

void WebEndpoint::Inside::show(const Session& session) {
    streamOf(session).shown = uv_hrtime();
    // Made when the first viewer needs it, and shared by all.
    std::array<SharedWebFrame, 2> frames;
    for (auto& [wsi, peer] : peers) {
        if (!peer.viewer || peer.session != &session) continue;
        const bool withShapes = peer.viewer->needsShapes(session.definitions());
        SharedWebFrame& frame = frames[withShapes ? 1 : 0];
        if (!frame) frame = frameOf(session, withShapes);
        peer.viewer->offer(frame, session.definitions());
        lws_callback_on_writable(wsi);
    }
}

void WebEndpoint::Inside::beginStop() {
    if (stopping) return;
    stopping = true;
    listener.close();
    if (viewerCount() == 0) return endStop();
    // A copy, as a connection that is closed may be forgotten at once.
    std::vector<lws*> watching;
    for (auto& [wsi, peer] : peers) {
        if (peer.viewer) watching.push_back(wsi);
    }
    for (lws* wsi : watching) sayGoodbye(wsi);
    wakeClients(nullptr);  // the hub has said Bye to them
    uv_timer_start(
        timer, [](uv_timer_t* each) { static_cast<Inside*>(each->data)->endStop(); },
        config.limits.farewellMs, 0);
}

void WebEndpoint::Inside::endStop() {
    lws_context_destroy(context);
    uv_close(reinterpret_cast<uv_handle_t*>(std::exchange(timer, nullptr)),
             [](uv_handle_t* handle) { delete reinterpret_cast<uv_timer_t*>(handle); });
}

WebEndpoint::WebEndpoint(std::unique_ptr<Inside> inside) : m_inside(std::move(inside)) {}
WebEndpoint::~WebEndpoint() = default;

Result<std::shared_ptr<WebEndpoint>> WebEndpoint::open(Host& host, WebConfig config) {
    if (!config.log) config.log = [](Severity, const std::string&) {};
    auto inside = std::make_unique<Inside>(host, std::move(config));
    if (Status started = inside->start(); !started) return started.error();
    std::shared_ptr<WebEndpoint> endpoint(new WebEndpoint(std::move(inside)));
    host.add(endpoint);
    return endpoint;
}

const std::string& WebEndpoint::address() const {
    return m_inside->address;
}
std::size_t WebEndpoint::viewers() const {
    return m_inside->viewerCount();
}
const WebCounters& WebEndpoint::counters() const {
    return m_inside->counters;
}
void WebEndpoint::afterTick(const Session& session) {
    m_inside->afterTick(session);
}
void WebEndpoint::stopping() {
    m_inside->beginStop();
}

}  // namespace huestep::server
